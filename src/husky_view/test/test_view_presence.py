# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whether what is shown is what is simulated."""

from pathlib import Path

from husky_course.robot import RobotStart
from husky_sim.scene_topic import world_key
from husky_sim.world import default_worlds, load_world
from husky_view.live.presence import FIRST_SEC, GONE_SEC, Presence, State


def test_a_silent_simulator_is_gone_and_its_next_run_is_shown() -> None:
    presence = Presence('playpen', now_sec=0.0)
    assert presence.state(now_sec=FIRST_SEC) is State.HERE, 'discovery takes its time'
    assert presence.hear('playpen', 'first', now_sec=4.0)
    assert presence.state(now_sec=4.0 + GONE_SEC) is State.HERE
    assert presence.state(now_sec=4.1 + GONE_SEC) is State.GONE
    assert presence.hear('playpen', 'second', now_sec=9.0)
    assert presence.state(now_sec=9.1) is State.HERE


def test_of_two_simulators_the_first_is_shown_and_the_other_is_told_of() -> None:
    presence = Presence('playpen', now_sec=0.0)
    for frame in range(30):
        assert presence.hear('playpen', 'first', now_sec=frame / 30.0)
        assert not presence.hear('playpen', 'second', now_sec=frame / 30.0)
    assert presence.state(now_sec=1.0) is State.TWO
    assert not presence.hear('', '', now_sec=1.0), 'no scene at all'


def test_scenes_of_another_world_are_not_drawn_in_this_one() -> None:
    presence = Presence('playpen', now_sec=0.0)
    assert presence.hear('playpen', 'first', now_sec=0.0)
    for frame in range(90):
        assert not presence.hear('field', 'second', now_sec=frame / 30.0)
    assert presence.state(now_sec=3.0) is State.ANOTHER_WORLD


def test_a_world_is_told_from_another_by_what_is_in_it_not_by_its_path(tmp_path: Path) -> None:
    worlds = default_worlds()
    copy = tmp_path / 'mine.xml'
    copy.write_text((worlds / 'empty.xml').read_text())
    start = (RobotStart(),)
    key = world_key(load_world(str(worlds / 'empty.xml'), start))
    assert world_key(load_world(str(copy), start)) == key
    others = [
        load_world(str(worlds / 'playpen.xml'), start),
        load_world(str(copy), (RobotStart(x=1.0),)),
        load_world(str(copy), (RobotStart(name='alpha'), RobotStart(name='beta', x=3.0))),
    ]
    assert len({key, *map(world_key, others)}) == 4
