# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The finished programs of the tutorials on tf2: who follows whom, and where a carrot hangs."""

from __future__ import annotations

from collections.abc import Iterator
import math
from typing import Any

from geometry_msgs.msg import PointStamped
from playpen_testing.here import run_here
from playpen_testing.processes import Process, Processes
from playpen_testing.turtles import TurtleClient
import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

STATIC = ('run', 'turtle_tf2_py', 'static_turtle_tf2_broadcaster')


@pytest.fixture
def student(own_domain: None) -> Iterator[TurtleClient]:
    del own_domain
    with TurtleClient() as client:
        yield client


def ros2(processes: Processes, *words: str) -> Process:
    return processes.start('ros2', *words, environment={'QT_QPA_PLATFORM': 'offscreen'})


def frame_of(student: TurtleClient, child: str) -> Any:
    """Return the next transform of a frame."""
    while True:
        for each in student.hears(TFMessage, '/tf').transforms:
            if each.child_frame_id == child:
                return each


def test_a_turtle_goes_to_a_carrot_that_hangs_at_another(
    student: TurtleClient, processes: Processes
) -> None:
    launch = ros2(processes, 'launch', 'turtle_tf2_py', 'turtle_tf2_fixed_frame_demo.launch.py')
    first = student.pose('turtle1')  # it looks along x
    student.wait_for_pose(
        lambda pose: math.dist((pose.x, pose.y), (first.x, first.y + 2.0)) < 0.5,
        'turtle2 at the carrot',
        'turtle2',
    )
    assert launch.output.count('Successfully spawned turtle2') == 1, launch.output
    carrot = frame_of(student, 'carrot1')
    assert carrot.header.frame_id == 'turtle1'
    assert frame_of(student, 'turtle2').header.frame_id == 'world'


def test_a_carrot_is_on_either_side_in_turn(student: TurtleClient, processes: Processes) -> None:
    ros2(processes, 'run', 'turtle_tf2_py', 'dynamic_frame_tf2_broadcaster')
    sides = set()

    def is_on_both_sides() -> bool:
        carrot = frame_of(student, 'carrot1')
        assert carrot.header.frame_id == 'turtle1'
        place, seconds = carrot.transform.translation, carrot.header.stamp.sec
        assert (place.x, place.y) == pytest.approx((0.0, -10.0 if seconds % 2 else 10.0), abs=1e-4)
        sides.add(place.y > 0.0)
        return len(sides) == 2

    student.wait_for(is_on_both_sides, 'the other side')


def test_a_third_turtle_circles_and_tells_its_points(
    student: TurtleClient, processes: Processes
) -> None:
    ros2(processes, 'launch', 'turtle_tf2_py', 'turtle_tf2_sensor_message.launch.py')
    student.wait_for_pose(
        lambda pose: (pose.linear_velocity, pose.angular_velocity) == (1.0, 1.0),
        'turtle3 driving',
        'turtle3',
    )
    told = student.hears(PointStamped, 'turtle3/turtle_point_stamped')
    assert told.header.frame_id == 'world'
    # It turns about a point 1 m at the left of where it was spawned.
    assert math.dist((told.point.x, told.point.y), (4.0, 3.0)) == pytest.approx(1.0, abs=0.1)
    assert frame_of(student, 'turtle3').header.frame_id == 'world'


def test_a_frame_stands_in_the_world(student: TurtleClient, processes: Processes) -> None:
    heard: list[TFMessage] = []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    ros2(processes, *STATIC, 'tree', '1', '2', '3', '0', '0', str(math.pi))
    student.node.create_subscription(TFMessage, '/tf_static', heard.append, latched)
    student.wait_for(lambda: bool(heard), 'the frame of the tree')
    (tree,) = heard[0].transforms
    assert (tree.header.frame_id, tree.child_frame_id) == ('world', 'tree')
    place, turn = tree.transform.translation, tree.transform.rotation
    assert (place.x, place.y, place.z) == (1.0, 2.0, 3.0)
    assert (turn.x, turn.y, turn.z, turn.w) == pytest.approx((0.0, 0.0, 1.0, 0.0))


def test_what_cannot_be_placed_is_refused(
    own_domain: None, processes: Processes, capfd: pytest.CaptureFixture[str]
) -> None:
    del own_domain
    refused = {
        'tree 1 2 3': (1, '4 words are given, and 7 are needed: static_turtle_tf2_broadcaster '),
        'world 1 2 3 0 0 0': (2, "the frame 'world' is the one that it is placed in"),
        'tree 1 2 z 0 0 0': (2, "could not convert string to float: 'z'"),
        'tree 1 2 inf 0 0 0': (2, '1 2 inf 0 0 0: they must be finite numbers'),
    }
    for words, (status, told) in refused.items():
        ended = run_here(capfd, 'turtle_tf2_py.static_turtle_tf2_broadcaster', *words.split())
        assert ended.status == status, words
        assert ended.err.startswith(told)
        assert ended.err.count('\n') == 1, words
    started = ros2(processes, *STATIC, 'tree', '1', '2', '3')
    assert started.wait() == 1
    line, _ = started.lines  # the second one is of `ros2 run`
    assert line.startswith(refused['tree 1 2 3'][1])
