# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a run leaves for Foxglove and `ros2 bag`; test/test_lab.py reads that of a real drive."""

from collections.abc import Callable
import math
from pathlib import Path
from typing import Any

from husky_course.record import Collision, read_run, Record
from husky_course.route import plan_route
from husky_course.waypoints import parse_course
from husky_grader.report.bag import write_bag
from husky_grader.scoring.report import judge
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import pytest

ROUTE = plan_route(parse_course('waypoints: [[0, 0], [2, 0]]'))
TOUCH = Collision(
    robot='husky',
    obstacle='cone_1',
    part='bumper',
    time_sec=0.61,
    force_n=12.0,
    position=(1.0, 0.5, 0.1),
)


@pytest.fixture
def record(make_record: Callable[..., Record]) -> Record:
    """Return a run to the north: half a second of waiting, then 1 m/s, from a start of its own."""
    places = [(0.5, 2.0)] * 25 + [(0.5, 2.0 + k / 50) for k in range(50)]
    return make_record(
        places,
        start=[0.5, 2.0, math.pi / 2],
        odom_x=[max(k - 24, 0) / 50 for k in range(75)],
        odom_y=[0.0] * 75,
        collisions=[TOUCH],
    )


def write(folder: Path, record: Record) -> str:
    return write_bag(folder, record, 0, ROUTE, judge(read_run(record), ROUTE))


def read(folder: Path, topic: str) -> list[tuple[float, Any]]:
    """Return times and messages of a topic, read by the definitions that stand in the file."""
    with (folder / 'run.mcap').open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        found = reader.iter_decoded_messages([topic])
        return [(message.log_time / 1e9, decoded) for _, _, message, decoded in found]


def test_a_collision_stands_at_its_time(record: Record, tmp_path: Path) -> None:
    assert write(tmp_path, record) == ''
    ((time_sec, collision),) = read(tmp_path, '/collisions')
    assert time_sec == 0.61
    assert collision.name == 'cone_1'
    assert {each.key: each.value for each in collision.values}['position'] == '1.000 0.500 0.100'


def test_the_twist_of_the_odometry_is_how_its_pose_moves(record: Record, tmp_path: Path) -> None:
    write(tmp_path, record)
    speeds = [message.twist.twist.linear.x for _, message in read(tmp_path, '/odometry/filtered')]
    assert speeds == pytest.approx([0.0] * 25 + [1.0] * 50)


def test_the_static_transforms_tell_where_odom_began(record: Record, tmp_path: Path) -> None:
    write(tmp_path, record)
    ((_, message),) = read(tmp_path, '/tf_static')
    frames = {each.child_frame_id: each for each in message.transforms}
    assert {'base_footprint', 'front_laser', 'odom'} <= set(frames)
    odom = frames['odom']
    assert odom.header.frame_id == 'world'
    assert (odom.transform.translation.x, odom.transform.translation.y) == (0.5, 2.0)
    assert odom.transform.rotation.z == pytest.approx(math.sqrt(0.5))


def test_commands_begin_with_the_first(record: Record, tmp_path: Path) -> None:
    write(tmp_path, record)
    commands = read(tmp_path, '/husky_velocity_controller/cmd_vel')
    times, speeds = [time for time, _ in commands], [each.linear.x for _, each in commands]
    assert times[0] == record.time_sec[record.begin(0)]
    assert speeds == record.column(0, 'command_speed_m_s')[record.begin(0) + 1 :].tolist()


def test_a_full_disk_costs_one_line(record: Record, tmp_path: Path) -> None:
    (tmp_path / '.run.part.mcap').symlink_to('/dev/full')
    assert write(tmp_path, record) == (
        f'{tmp_path}/run.mcap: cannot be written: No space left on device; the report is there'
    )
    assert list(tmp_path.iterdir()) == []


def test_what_cannot_be_replaced_costs_one_line(record: Record, tmp_path: Path) -> None:
    (tmp_path / 'run.mcap').mkdir()
    assert 'run.mcap: cannot be written: Is a directory' in write(tmp_path, record)
    assert [path.name for path in tmp_path.iterdir()] == ['run.mcap']
