# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The buffer of transforms: times, trees, and the words of refusals."""

from __future__ import annotations

import math
import random
import threading
from typing import Any

from geometry_msgs.msg import TransformStamped
from hypothesis import given, strategies
from playpen_testing.transforms import buffer_of, LATEST, seconds, transform
import pytest
from rclpy.duration import Duration
from rclpy.time import Time
from tf2_py import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)
import yaml


def x_of(buffer: BufferCore, target: str, source: str, time: Any = LATEST) -> float:
    return float(buffer.lookup_transform_core(target, source, time).transform.translation.x)


# ---- times ------------------------------------------------------------------------------------


@given(strategies.lists(strategies.integers(0, 40), min_size=2, max_size=30))
def test_samples_in_any_order_give_the_same(times: list[int]) -> None:
    samples = [transform('a', 'b', 0.1 * t, (0.1 * t, 0.0, 0.0)) for t in times]
    buffer = buffer_of(*samples)
    oldest, latest = min(times), max(times)
    assert x_of(buffer, 'a', 'b') == pytest.approx(0.1 * latest)
    assert x_of(buffer, 'a', 'b', seconds(0.05 * (oldest + latest))) == pytest.approx(
        0.05 * (oldest + latest) if oldest + latest else 0.1 * latest
    )


def test_a_message_of_a_time_and_any_time_of_rclpy_are_taken() -> None:
    buffer = buffer_of(transform('a', 'b', 1.0), transform('a', 'b', 3.0, (2.0, 0.0, 0.0)))
    for time in (seconds(2.0), seconds(2.0).to_msg()):
        assert x_of(buffer, 'a', 'b', time) == pytest.approx(1.0)
    with pytest.raises(TypeError, match=r'^time must have sec and nanosec, or nanoseconds'):
        x_of(buffer, 'a', 'b', 2.0)
    with pytest.raises(TypeError, match=r'^duration must have sec and nanosec, or nanosec'):
        BufferCore(10.0)
    nothing: Any = None
    for call, *arguments in (
        (buffer.lookup_transform_core, LATEST),
        (buffer.can_transform_core, LATEST),
        (buffer.get_latest_common_time,),
    ):
        with pytest.raises(TypeError, match=r'^argument 2 must be str, not NoneType$'):
            call('a', nothing, *arguments)
    for full in (buffer.lookup_transform_full_core, buffer.can_transform_full_core):
        with pytest.raises(TypeError, match=r'^argument 3 must be str, not NoneType$'):
            full('a', LATEST, 'b', LATEST, nothing)


def test_the_latest_is_the_newest_time_that_all_have() -> None:
    buffer = buffer_of(
        transform('root', 'a', 1.0),
        transform('root', 'a', 5.0, (4.0, 0.0, 0.0)),
        transform('a', 'b', 1.0),
        transform('a', 'b', 3.0),
    )
    buffer.set_transform_static(transform('b', 'c'), 'test')
    found = buffer.lookup_transform_core('root', 'c', LATEST)
    assert (found.header.stamp.sec, found.transform.translation.x) == (3, pytest.approx(2.0))
    assert (found.header.frame_id, found.child_frame_id) == ('root', 'c')
    assert buffer.get_latest_common_time('root', 'c') == Time(seconds=3)
    assert buffer.lookup_transform_core('b', 'c', LATEST).header.stamp.sec == 0


def test_between_two_parents_the_older_one_holds() -> None:
    buffer = buffer_of(
        transform('a', 'b', 1.0, (1.0, 0.0, 0.0)), transform('c', 'b', 3.0, (9.0, 0.0, 0.0))
    )
    assert x_of(buffer, 'a', 'b', seconds(2.5)) == 1.0


def test_a_frame_in_itself_is_nowhere_else_at_its_latest_time() -> None:
    buffer = buffer_of(transform('a', 'b', 4.0, (1.0, 0.0, 0.0)))
    found = buffer.lookup_transform_core('b', 'b', LATEST)
    assert found.transform == transform('b', 'b').transform
    assert found.header.stamp.sec == 4
    assert buffer.lookup_transform_core('nowhere', 'nowhere', seconds(2.0)).header.stamp.sec == 2
    assert buffer.can_transform_core('nowhere', 'nowhere', LATEST) == (1, '')


@pytest.mark.parametrize(
    ('times', 'asked', 'said'),
    [
        (
            (1.0, 3.0),
            3.5,
            'Lookup would require extrapolation into the future.  Requested time 3.500000 but '
            'the latest data is at time 3.000000',
        ),
        (
            (1.0, 3.0),
            0.25,
            'Lookup would require extrapolation into the past.  Requested time 0.250000 but '
            'the earliest data is at time 1.000000',
        ),
        (
            (1.0,),
            1.5,
            'Lookup would require extrapolation at time 1.500000, but only time 1.000000 is '
            'in the buffer',
        ),
    ],
)
def test_other_times_are_refused_in_the_words_of_tf2(
    times: tuple[float, ...], asked: float, said: str
) -> None:
    buffer = buffer_of(*(transform('a', 'b', time) for time in times))
    for target, source in (('a', 'b'), ('b', 'a')):
        said_of_both = (
            f'{said}, when looking up transform from frame [{source}] to frame [{target}]'
        )
        with pytest.raises(ExtrapolationException) as caught:
            buffer.lookup_transform_core(target, source, seconds(asked))
        assert str(caught.value) == said_of_both
        assert buffer.can_transform_core(target, source, seconds(asked)) == (0, said_of_both)


def test_the_words_have_the_digits_of_tf2_at_the_time_of_today() -> None:
    buffer = buffer_of(transform('a', 'b', 1.0))
    asked = Time(seconds=1_795_412_828, nanoseconds=729_785_475)
    with pytest.raises(ExtrapolationException, match=r'at time 1795412828\.729785, but only'):
        buffer.lookup_transform_core('a', 'b', asked)


def test_samples_are_kept_for_ten_seconds_or_as_long_as_is_said(
    capfd: pytest.CaptureFixture[str],
) -> None:
    samples = [transform('a', 'b', time) for time in (1.0, 2.0, 11.0, 11.5, 12.5, 13.0)]
    for buffer, oldest in (
        (BufferCore(), 2.5),
        (BufferCore(Duration(seconds=60)), 1.0),
    ):
        for sample in samples:
            buffer.set_transform(sample, 'test')
        assert buffer.can_transform_core('a', 'b', seconds(max(oldest, 11.0)))[0] == 1
        assert buffer.can_transform_core('a', 'b', seconds(1.5))[0] == int(oldest < 1.5)
    assert capfd.readouterr().err == ''
    buffer = buffer_of(*samples)
    buffer.set_transform(transform('a', 'b', 2.75), 'the past')
    assert (
        'TF_OLD_DATA ignoring data from the past for frame b at time 2.750000 according to '
        'authority the past\nPossible reasons are listed at '
        'http://wiki.ros.org/tf/Errors%20explained\n'
    ) in capfd.readouterr().err


def test_two_senders_of_one_frame_are_both_kept_silently(
    capfd: pytest.CaptureFixture[str],
) -> None:
    here, there = (transform('a', 'b', 1.0, (x, 0.0, 0.0)) for x in (0.0, 8.0))
    buffer = buffer_of(here, here, there, there, here)
    assert x_of(buffer, 'a', 'b') == 8.0
    assert 'rate: 20000.000' in buffer.all_frames_as_yaml()  # two samples: none is there twice
    assert capfd.readouterr().err == ''


def test_a_frame_moves_from_one_parent_to_another() -> None:
    buffer = buffer_of(
        transform('map', 'hand', 1.0, (1.0, 0.0, 0.0)),
        transform('map', 'hand', 5.0, (1.0, 0.0, 0.0)),
        transform('table', 'cup', 1.0),
        transform('hand', 'cup', 5.0),
    )
    buffer.set_transform_static(transform('map', 'table'), 'test')
    assert x_of(buffer, 'map', 'cup', seconds(1.5)) == 0.0  # it leaves the table at 5
    assert x_of(buffer, 'map', 'cup', seconds(5.0)) == 1.0
    assert 'Frame cup exists with parent hand.' in buffer.all_frames_as_string()


def test_a_frame_becomes_static_and_moves_again() -> None:
    buffer = buffer_of(transform('a', 'b', 1.0, (1.0, 0.0, 0.0)))
    buffer.set_transform_static(transform('a', 'b', 9.0, (2.0, 0.0, 0.0)), 'test')
    assert x_of(buffer, 'a', 'b', seconds(500.0)) == 2.0
    buffer.set_transform_static(transform('a', 'b', 1.0, (2.5, 0.0, 0.0)), 'test')
    assert x_of(buffer, 'a', 'b', seconds(500.0)) == 2.5
    buffer.set_transform(transform('a', 'b', 3.0, (3.0, 0.0, 0.0)), 'test')
    assert x_of(buffer, 'a', 'b', seconds(3.0)) == 3.0
    assert buffer.can_transform_core('a', 'b', seconds(500.0))[0] == 0


def test_travel_in_time_goes_by_a_fixed_frame() -> None:
    buffer = buffer_of(
        *(transform('world', 'robot', time, (time, 0.0, 0.0)) for time in (1.0, 5.0)),
        *(transform('world', 'ball', time, (0.0, time, 0.0)) for time in (1.0, 5.0)),
    )
    asked = ('robot', seconds(4.0), 'ball', seconds(2.0), 'world')
    found = buffer.lookup_transform_full_core(*asked)
    assert (found.transform.translation.x, found.transform.translation.y) == (-4.0, 2.0)
    header = found.header
    assert (header.stamp.sec, header.frame_id, found.child_frame_id) == (4, 'robot', 'ball')
    assert buffer.can_transform_full_core(*asked) == (1, '')
    late = ('robot', seconds(4.0), 'ball', seconds(9.0), 'world')
    possible, why = buffer.can_transform_full_core(*late)
    assert (possible, 'into the future' in why) == (0, True)
    early = ('robot', seconds(9.0), 'ball', seconds(2.0), 'world')
    assert buffer.can_transform_full_core(*early)[0] == 0
    for place, role in ((0, 'target'), (2, 'source'), (4, 'fixed')):
        wrong = [*asked]
        wrong[place] = 'w'
        said = f'"w" passed to lookupTransform argument {role}_frame does not exist'
        with pytest.raises(LookupException, match=said):
            buffer.lookup_transform_full_core(*wrong)
        why = f'Invalid frame ID "w" passed to canTransform argument {role}_frame - frame does '
        assert buffer.can_transform_full_core(*wrong) == (0, f'{why}not exist')


# ---- trees ------------------------------------------------------------------------------------


def test_two_trees_have_no_connection() -> None:
    buffer = buffer_of(transform('a', 'b', 1.0), transform('c', 'd', 1.0))
    said = (
        "Could not find a connection between 'b' and 'd' because they are not part of the same "
        'tree.Tf has two or more unconnected trees.'
    )
    for time in (LATEST, seconds(1.0)):
        with pytest.raises(ConnectivityException) as caught:
            buffer.lookup_transform_core('b', 'd', time)
        assert str(caught.value) == said
    with pytest.raises(TransformException) as general:
        buffer.get_latest_common_time('b', 'd')
    assert str(general.value) == said
    for frames in (('b', 'nowhere'), ('nowhere', 'd')):
        with pytest.raises(LookupException, match='"nowhere" passed to get_latest_common_time '):
            buffer.get_latest_common_time(*frames)


@pytest.mark.timeout(20)
def test_a_loop_is_said() -> None:
    buffer = buffer_of(
        transform('c', 'a', 1.0), transform('a', 'b', 1.0), transform('b', 'c', 1.0)
    )
    buffer.set_transform_static(transform('root', 'd'), 'test')
    for time in (LATEST, seconds(1.0)):
        with pytest.raises(LookupException) as caught:
            buffer.lookup_transform_core('d', 'a', time)
        assert str(caught.value).splitlines() == [
            'The tf tree is invalid because it contains a loop.',
            'Frame a exists with parent c.',
            'Frame c exists with parent b.',
            'Frame b exists with parent a.',
            'Frame d exists with parent root.',
            '',
        ]


@pytest.mark.parametrize(
    ('frame', 'error', 'said', 'debug'),
    [
        (
            'nix',
            LookupException,
            '"nix" passed to {} does not exist. ',
            'Invalid frame ID "nix" passed to {} - frame does not exist',
        ),
        (
            '',
            InvalidArgumentException,
            'Invalid argument "" passed to {} - in tf2 frame_ids cannot be empty',
            'Invalid frame ID "" passed to {} - in tf2 frame_ids cannot be empty',
        ),
        (
            '/b',
            InvalidArgumentException,
            'Invalid argument "/b" passed to {} - in tf2 frame_ids cannot start with a \'/\'',
            'Invalid frame ID "/b" passed to {} - in tf2 frame_ids cannot start with a \'/\'',
        ),
    ],
)
def test_a_name_that_is_no_frame_is_refused(
    frame: str, error: type[TransformException], said: str, debug: str
) -> None:
    buffer = buffer_of(transform('a', 'b', 1.0))
    for argument, frames in (('target_frame', (frame, 'a')), ('source_frame', ('a', frame))):
        with pytest.raises(error) as caught:
            buffer.lookup_transform_core(*frames, LATEST)
        assert str(caught.value) == said.format(f'lookupTransform argument {argument}')
        why = debug.format(f'canTransform argument {argument}')
        assert buffer.can_transform_core(*frames, LATEST) == (0, why)


def test_names_are_set_with_a_slash_and_looked_up_without() -> None:
    buffer = buffer_of(transform('/a', '/b', 1.0, (7.0, 0.0, 0.0)))
    assert x_of(buffer, 'a', 'b') == 7.0


NAN = math.nan
IGNORED = 'Ignoring transform'


@pytest.mark.parametrize(
    ('wrong', 'said'),
    [
        (
            transform('/a', 'a'),
            f'TF_SELF_TRANSFORM: {IGNORED} from authority "me" with frame_id and  child_frame_id '
            '"a" because they are the same',
        ),
        (
            transform('a', ''),
            f'TF_NO_CHILD_FRAME_ID: {IGNORED} from authority "me" because child_frame_id not set ',
        ),
        (
            transform('', 'b'),
            f'TF_NO_FRAME_ID: {IGNORED} with child_frame_id "b"  from authority "me" because '
            'frame_id not set',
        ),
        (
            transform('a', 'b', translation=(0.5, NAN, 0.0)),
            f'TF_NAN_INPUT: {IGNORED} for child_frame_id "b" from authority "me" because of a nan '
            'value in the transform (0.500000 nan 0.000000) (0.000000 0.000000 0.000000 1.000000)',
        ),
        (
            transform('a', 'b', rotation=(0.0, 0.0, 0.0, 0.0)),
            f'TF_DENORMALIZED_QUATERNION: {IGNORED} for child_frame_id "b" from authority "me" '
            'because of an invalid quaternion in the transform (nan nan nan nan)',
        ),
    ],
)
def test_a_wrong_transform_is_logged_and_left_out(
    wrong: TransformStamped, said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    buffer = BufferCore()
    buffer.set_transform(wrong, 'me')
    assert f']: {said}\n' in capfd.readouterr().err
    assert (buffer.all_frames_as_string(), buffer.all_frames_as_yaml()) == ('', '[]')


# ---- the whole --------------------------------------------------------------------------------


def test_the_list_of_frames_is_that_of_tf2() -> None:
    buffer = buffer_of(*(transform('a', 'b', 2.0 + 0.5 * i) for i in range(5)))
    buffer.set_transform_static(transform('b', 'c'), 'someone')
    assert buffer.all_frames_as_yaml() == (
        "b: \n  parent: 'a'\n  broadcaster: 'test'\n  rate: 2.500\n"
        '  most_recent_transform: 4.000000\n  oldest_transform: 2.000000\n'
        '  buffer_length: 2.000\n'
        "c: \n  parent: 'b'\n  broadcaster: 'someone'\n  rate: 10000.000\n"
        '  most_recent_transform: 0.000000\n  oldest_transform: 0.000000\n'
        '  buffer_length: 0.000\n'
    )
    assert buffer.all_frames_as_string() == (
        'Frame b exists with parent a.\nFrame c exists with parent b.\n'
    )


def test_a_name_that_yaml_would_take_for_more_is_quoted() -> None:
    buffer = buffer_of(transform("o'\tx", 'x: y', 1.0), transform('base link', 'tag36h11:0', 1.0))
    for parent in ("o'x", 'o\tx'):
        buffer.set_transform(transform(parent, parent.upper(), 1.0), 'test')
    lines = buffer.all_frames_as_yaml().splitlines()
    assert lines[:2] == ["'x: y': ", '  parent: "o\'\\U00000009x"']
    assert lines[7:9] == ['tag36h11:0: ', "  parent: 'base link'"]
    assert yaml.safe_load('\n'.join(lines))["O'X"]['parent'] == "o'x"
    assert yaml.safe_load('\n'.join(lines))['O\tX']['parent'] == 'o\tx'


def test_to_clear_forgets_what_moves_and_keeps_what_is_static() -> None:
    buffer = buffer_of(transform('a', 'b', 1.0))
    buffer.set_transform_static(transform('b', 'c', 0.0, (1.0, 0.0, 0.0)), 'test')
    buffer.clear()
    assert x_of(buffer, 'b', 'c', seconds(3.0)) == 1.0
    assert buffer.can_transform_core('a', 'b', LATEST)[0] == 0
    assert buffer.all_frames_as_string().startswith('Frame b exists with parent NO_PARENT.\n')
    with pytest.raises(ConnectivityException):
        buffer.lookup_transform_core('a', 'c', LATEST)
    buffer.set_transform(transform('a', 'b', 0.5), 'test')  # older than what was forgotten
    assert x_of(buffer, 'a', 'c', seconds(0.5)) == x_of(buffer, 'a', 'c') == 1.0


def test_a_chain_goes_by_the_nearest_common_parent() -> None:
    tree = (('root', 'base'), ('base', 'arm'), ('arm', 'hand'), ('base', 'leg'))
    buffer = buffer_of(*(transform(*edge) for edge in tree), static=True)
    asked = (LATEST, 'hand', LATEST, 'base')
    assert buffer._chain('leg', *asked) == ['hand', 'arm', 'base', 'leg']
    assert buffer._chain('base', *asked) == ['hand', 'arm', 'base']
    to_leg = buffer._chain('arm', LATEST, 'leg', LATEST, 'arm')
    assert to_leg == ['leg', 'base', 'arm']


@pytest.mark.timeout(60)
def test_threads_may_set_and_look_up_at_once() -> None:
    buffer = BufferCore(Duration(seconds=1))
    buffer.set_transform(transform('a', 'b', 0.001, (0.001, 0.0, 0.0)), 'test')
    failures: list[BaseException] = []
    done = threading.Event()

    def look_up() -> None:
        try:
            while not done.is_set():
                found = buffer.lookup_transform_core('a', 'b', LATEST)
                stamp = found.header.stamp
                time = stamp.sec + 1e-9 * stamp.nanosec
                assert found.transform.translation.x == pytest.approx(time)
        except BaseException as error:
            failures.append(error)

    threads = [threading.Thread(target=look_up) for _ in range(2)]
    for thread in threads:
        thread.start()
    numbers = random.Random(1)
    for step in range(2000):
        time = 0.01 * (step + numbers.randrange(20) + 1)
        buffer.set_transform(transform('a', 'b', time, (time, 0.0, 0.0)), 'test')
    done.set()
    for thread in threads:
        thread.join()
    assert failures == []
