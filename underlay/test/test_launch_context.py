# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a launch context keeps for its actions."""

import asyncio
import os
import re

from launch import Event, EventHandler, LaunchContext
from launch.substitutions import TextSubstitution
import pytest

pytestmark = pytest.mark.usefixtures('launch_environment')


def test_locals_hide_globals_until_they_are_popped() -> None:
    context = LaunchContext()
    context.extend_globals({'file': 'global', 'robot': 'husky'})
    context._push_locals()
    context.extend_locals({'file': 'local'})
    assert (context.locals.file, context.locals.robot) == ('local', 'husky')
    context._pop_locals()
    assert context.get_locals_as_dict() == {'file': 'global', 'robot': 'husky'}


def test_locals_say_what_they_have_and_cannot_be_set() -> None:
    context = LaunchContext()
    context.extend_locals({'event': 1, 'action': 2})
    unknown = "does not contain attribute 'evnt', it contains: [event, action]"
    with pytest.raises(AttributeError, match=re.escape(unknown)):
        _ = context.locals.evnt
    with pytest.raises(AttributeError, match="can't set attribute 'event'"):
        context.locals.event = 3


def test_the_environment_goes_back_to_what_was_pushed_or_to_the_start(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv('SHAPE', 'round')
    context = LaunchContext()
    for go_back in (context._pop_environment, context._reset_environment):
        context._push_environment()
        context.environment.update(SHAPE='flat', COLOUR='red')
        del os.environ['HOME']
        go_back()
        found = {name: os.environ.get(name) for name in ('SHAPE', 'COLOUR')}
        assert found == {'SHAPE': 'round', 'COLOUR': None}
        assert 'HOME' in os.environ


def test_what_was_not_pushed_cannot_be_popped() -> None:
    context = LaunchContext()
    for pop in (
        context._pop_locals,
        context._pop_environment,
        context._pop_launch_configurations,
    ):
        with pytest.raises(RuntimeError, match='stack unexpectedly empty'):
            pop()


def test_handlers_come_before_the_others_unless_appended() -> None:
    context = LaunchContext(argv=('a',))
    assert (context.argv, context.noninteractive, context.is_shutdown) == (['a'], False, False)
    first, second, last = (EventHandler(matcher=lambda _: True) for _ in range(3))
    context.register_event_handler(second)
    context.register_event_handler(last, append=True)
    context.register_event_handler(first)
    assert list(context._event_handlers) == [first, second, last]
    assert context.would_handle_event(Event())
    for handler in (first, second, last):
        context.unregister_event_handler(handler)
    assert not context.would_handle_event(Event())
    with pytest.raises(ValueError, match='is not in'):
        context.unregister_event_handler(first)


def test_events_wait_in_their_order() -> None:
    context = LaunchContext()
    events = [Event(), Event()]
    asyncio.run(context.emit_event(events[0]))
    context.emit_event_sync(events[1])
    assert [context._event_queue.get_nowait() for _ in events] == events
    assert context.perform_substitution(TextSubstitution(text='x')) == 'x'
