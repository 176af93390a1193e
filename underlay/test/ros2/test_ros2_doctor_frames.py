# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Frames of another time, or that several nodes send: a listener is told nothing of it."""

from __future__ import annotations

from collections.abc import Callable
import math
import re
import sys
from typing import Any

from geometry_msgs.msg import TransformStamped
import pytest
from ros2_doctor_checks import transforms
from tf2_msgs.msg import TFMessage
from tf2_py import BufferCore


def test_frames_of_another_time_and_a_simulator_that_is_paused(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.start(sys.executable, '-m', 'husky_sim.ros.node', ready='x real time')
    answer = ros2_here('doctor')
    assert ' (clock): ' not in answer.out, answer
    assert ' (frames): ' not in answer.out, answer

    odd = [processes.node('broadcaster', 'lights'), processes.node('odd_laser', 'scanner')]
    told = [line for line in ros2_here('doctor').lines if ' (frames): ' in line]
    assert told[0] == (
        'problem (frames): frame base_link: has several parents, map and odom, so that it jumps '
        'between them; let one node alone publish it, below one parent; on /tf publish '
        '/husky_sim, /lights'
    )
    another_time = r'problem \(frames\): frame base_link, camera, lamp: stamped by /lights with '
    assert told[1].startswith(
        'problem (frames): frame camera: is on /tf_static, below base_link, and on /tf, below base'
    )
    assert told[2].startswith(
        "note (frames): /scan: /scanner names the frame 'laser', of which there is no transform, "
        "so that nobody can say where that is; set header.frame_id to 'front_laser'"
    )
    assert re.match(another_time + r'\d{10} s, while /clock tells \d+ s, so that lookups', told[3])
    assert told[4].startswith('problem (frames): /scan: stamped by /scanner with ')
    for name, line in zip(('lights', 'scanner'), told[3:], strict=True):
        assert line.endswith(
            f'; start /{name} with `--ros-args -p use_sim_time:=true`, and set header.stamp to '
            '`get_clock().now().to_msg()`'
        )
    for node in odd:
        processes.end_one(node)
    pause = ('service', 'call', '/husky_sim/pause', 'std_srvs/srv/SetBool')
    ros2_here(*pause, '{data: true}')
    line = ros2_here('doctor').of_check('clock')
    go_on = f'`ros2 {" ".join(pause)} "{{data: false}}"` lets it go on'
    assert '/clock: stands still: /husky_sim is paused' in line
    assert line.endswith(go_on)


def test_a_frame_that_several_nodes_send(processes: Any, ros2_here: Callable[..., Any]) -> None:
    def told() -> list[str]:
        return [line for line in ros2_here('doctor').lines if ' (frames): ' in line]

    one = 'problem (frames): frame base_link: '
    below = (
        f'{one}has several parents on /tf_static, map and world, of which the last that comes is '
        'taken; let one node alone publish it, below one parent; on /tf_static publish /map, '
        '/world'
    )
    processes.node('fixer', 'map')
    assert told() == []
    processes.node('fixer', 'world')
    assert told() == [below]
    processes.node('mover', 'first')
    scanner = processes.node('lost_laser', 'scanner')
    both = (
        f'{one}is on /tf_static, below map and world, and on /tf, below odom, so that the one '
        'takes the place of the other; let one node alone publish it; on /tf_static publish '
        '/map, /world; on /tf '
    )
    assert told() == [
        f'{both}/first',
        below,
        'note (frames): /scan: /scanner leaves header.frame_id empty, so that nobody can say '
        'where that is; set it to the frame that it is told in',
    ]
    processes.end_one(scanner)
    processes.node('mover', 'second')
    jumps = (
        f'{one}is sent by several publishers, so that it jumps between what they say; let one '
        'node alone publish it, below one parent; on /tf publish /first, /second'
    )
    assert told() == [jumps, f'{both}/first, /second', below]
    frames = ('--frame-id', 'base_lnk', '--child-frame-id', 'camera')
    processes.start(
        *(sys.executable, '-m', 'tf2_ros.static_transform_publisher', *frames), ready='Spinning'
    )
    processes.node('torn', 'arm')
    first, *_, last = told()
    assert first.startswith(
        'problem (frames): frame arm: every listener ignores it, because it has a NaN; mend what '
        'its node fills in; publishing are /arm, /first, /second, /map, '
    )
    assert last.startswith(
        'note (frames): frame base_lnk: is a tree of its own, with camera below it, while another '
        'tree has base_link, so that lookups between the two fail'
    )


@pytest.mark.parametrize(
    ('numbers', 'several'),
    [
        ([7, 8, 10, 11], False),
        ([50, 50, 51], True),  # begun at one time
        ([1000, 3, 1001], True),
        ([40, 41, 1, 2, 3], False),  # started anew
        ([], False),
    ],
)
def test_numbers_of_messages_tell_of_several_publishers(numbers: list[int], several: bool) -> None:
    heard = transforms.Heard(
        links={'base_link': [('odom', 1.0)]},
        numbers={'base_link': numbers},
        places={'base_link': {'here', 'there'}},
    )
    assert bool([*transforms.check_senders(heard, '/a, /b', '')]) == several
    heard.places['base_link'] = {'here'}  # two say the same of a robot that stands
    assert not [*transforms.check_senders(heard, '/a, /b', '')]


@pytest.mark.parametrize(
    ('child', 'parent', 'values', 'why'),
    [
        ('', 'odom', {}, 'its child_frame_id is empty'),
        ('base_link', '', {}, 'its header.frame_id is empty'),
        ('/odom', 'odom', {}, 'it is below itself'),
        ('base_link', 'odom', {'x': math.nan}, 'it has a NaN'),
        ('base_link', 'odom', {'w': math.nan}, 'it has a NaN'),
        ('base_link', 'odom', {'w': 0.0}, 'its rotation is all 0, and w of no rotation 1'),
        ('base_link', 'odom', {'w': 0.5}, ''),  # of another length it is the same rotation
        ('/base_link', '/odom', {}, ''),
    ],
)
def test_what_no_listener_takes_is_told(
    child: str, parent: str, values: dict[str, float], why: str
) -> None:
    sent = TransformStamped(child_frame_id=child)
    sent.header.frame_id = parent
    sent.transform.translation.x = values.get('x', 0.0)
    sent.transform.rotation.w = values.get('w', 1.0)
    heard = transforms.Heard()
    heard.on_transforms(TFMessage(transforms=[sent]), {'publication_sequence_number': 1})
    heard.on_fixed(TFMessage(transforms=[sent]))
    told = [str(each) for each in transforms.check_refused(heard, '/a')]
    assert len(told) == bool(why)
    assert heard.frames() == (set() if why else {'base_link', 'odom'})
    buffer = BufferCore()
    buffer.set_transform(sent, '/a')
    assert (buffer.all_frames_as_yaml() == '[]') == bool(why), 'tf2 says so, too'
    if why:
        assert f': every listener ignores it, because {why}' in told[0]


def test_a_tree_that_was_to_hang_in_another_is_told() -> None:
    robots = {
        f'{robot}/{child}': [(f'{robot}/{parent}', 1.0)]
        for robot in ('a', 'b')
        for child, parent in (('base_link', 'odom'), ('odom2', 'base_link'))
    }
    heard = transforms.Heard(links=robots, fixed={'a/lamp': {'a/base_link'}})
    assert not [*transforms.check_roots(heard)]
    heard.fixed |= {'a/camera': {'a/base_lnk'}, 'a/lens': {'a/camera'}, 'a/plan': {'a/map'}}
    (found,) = transforms.check_roots(heard)
    assert not found.serious
    assert str(found) == (
        'frame a/base_lnk: is a tree of its own, with a/camera below it, while another tree has '
        'a/base_link, so that lookups between the two fail; name the parent a/base_link, or '
        'publish where a/base_lnk is'
    )
