# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a run leaves for Foxglove and `ros2 bag`; test/test_lab.py reads that of a real drive."""

from collections.abc import Callable
from dataclasses import replace
import json
import math
from pathlib import Path
import re
from typing import Any

from husky_course.outline import Outline
from husky_course.record import Collision, read_run, Record
from husky_course.route import plan_route
from husky_course.waypoints import parse_course
from husky_grader.playpen import config_folder
from husky_grader.report.bag import write_bag
from husky_grader.scoring.report import judge
from husky_sim.world import default_worlds, load_world
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import pytest
from rosidl_runtime_py.utilities import get_message
from visualization_msgs.msg import Marker

# What of these Lichtblick 1.10 draws in a scene; it draws no nav_msgs/msg/Odometry.
DRAWN = {
    'nav_msgs/msg/Path',
    'sensor_msgs/msg/LaserScan',
    'visualization_msgs/msg/MarkerArray',
}
PANELS = {'3D', 'Plot', 'StateTransitions'}

ROUTE = plan_route(parse_course('waypoints: [[0, 0], [2, 0]]'))
TOUCH = Collision(
    robot='husky',
    obstacle='cone_1',
    part='bumper',
    time_sec=0.61,
    force_n=12.0,
    position=(1.0, 0.5, 0.1),
)
OBSTACLES = (
    Outline(name='cone_1', x=1.0, y=0.6, yaw=0.0, size=(0.2,)),
    Outline(name='barrier', x=5.0, y=0.0, yaw=1.0, size=(4.0, 0.8)),
)


def in_playpen(run: Record) -> Record:
    """Return a run as if it had been driven there."""
    world = str(default_worlds() / 'playpen.xml')
    return replace(run, world=world, obstacles=load_world(world, run.robots).obstacles)


@pytest.fixture
def record(make_record: Callable[..., Record]) -> Record:
    """Return a run to the north: half a second of waiting, then 1 m/s, from a start of its own."""
    places = [(0.5, 2.0)] * 25 + [(0.5, 2.0 + k / 50) for k in range(50)]
    run = make_record(
        places,
        start=[0.5, 2.0, math.pi / 2],
        yaw=[math.pi / 2] * 75,
        odom_x=[max(k - 24, 0) / 50 for k in range(75)],
        odom_y=[0.0] * 75,
        collisions=[TOUCH],
    )
    return in_playpen(run)


def write(folder: Path, record: Record) -> str:
    return write_bag(folder, record, 0, ROUTE, judge(read_run(record), ROUTE))


def read(folder: Path, topic: str) -> list[tuple[float, Any]]:
    """Return times and messages of a topic, read by the definitions that stand in the file."""
    with (folder / 'run.mcap').open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        found = reader.iter_decoded_messages([topic])
        return [(message.log_time / 1e9, decoded) for _, _, message, decoded in found]


def types_in(folder: Path) -> dict[str, str]:
    """Return the types of the topics in the file."""
    with (folder / 'run.mcap').open('rb') as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    schemas = summary.schemas
    return {each.topic: schemas[each.schema_id].name for each in summary.channels.values()}


def values_of(content: object) -> list[str]:
    """Return the message paths of a layout: each `value` that begins as a topic does."""
    if isinstance(content, dict):
        own = content.get('value')
        paths = [own] if isinstance(own, str) and own.startswith('/') else []
        return paths + [path for each in content.values() for path in values_of(each)]
    if isinstance(content, list):
        return [path for each in content for path in values_of(each)]
    return []


def test_the_layout_asks_for_what_the_file_has(record: Record, tmp_path: Path) -> None:
    write(tmp_path, record)
    layout = json.loads((config_folder() / 'foxglove_layout.json').read_text())
    types = types_in(tmp_path)
    paths = values_of(layout)
    assert len(paths) > 6
    for path in paths:
        topic, *names = re.sub(r'\[[^]]*\]|\{[^}]*\}', '', path).split('.')
        field = types[topic]
        for name in names:
            fields = get_message(field).get_fields_and_field_types()
            assert name in fields, path
            field = fields[name].removeprefix('sequence<').removesuffix('>')
            field = re.sub(r'^(\w+)/(\w+)$', r'\1/msg/\2', field)
        assert '/' not in field, f'{path}: a message, not a value'


def test_all_that_the_layout_shows_can_be_drawn(record: Record, tmp_path: Path) -> None:
    write(tmp_path, record)
    panels = json.loads((config_folder() / 'foxglove_layout.json').read_text())['configById']
    assert {name.partition('!')[0] for name in panels} == PANELS
    scene = panels['3D!scene']
    types = types_in(tmp_path)
    assert {topic: types[topic] for topic in scene['topics'] if types[topic] not in DRAWN} == {}
    ((_, fixed),) = read(tmp_path, '/tf_static')
    frames = {'world', 'base_link', *(each.child_frame_id for each in fixed.transforms)}
    named = {name.removeprefix('frame:') for name in scene['transforms']}
    assert {scene['followTf'], *named} <= frames


def test_the_whole_ways_are_there_from_the_beginning(record: Record, tmp_path: Path) -> None:
    write(tmp_path, record)
    for topic, frame, last in (
        ('/path', 'odom', (2.0, 0.0)),
        ('/odometry/path', 'odom', (1.0, 0.0)),
        ('/ground_truth/path', 'world', (0.5, 2.98)),
    ):
        ((time_sec, path),) = read(tmp_path, topic)
        assert time_sec == record.time_sec[0]
        assert path.header.frame_id == path.poses[0].header.frame_id == frame
        end = path.poses[-1].pose.position
        assert (end.x, end.y) == pytest.approx(last), topic


def test_the_laser_sees_the_barrier_come_nearer(
    make_record: Callable[..., Record], tmp_path: Path
) -> None:
    run = make_record([(k / 50, 0.0) for k in range(50)], yaw=[0.0] * 50)
    record = in_playpen(run)
    assert write(tmp_path, record) == ''
    scans = read(tmp_path, '/front/scan')
    assert [time for time, _ in scans] == pytest.approx(record.time_sec[::5].tolist())
    first, last = scans[0][1], scans[-1][1]
    assert first.header.frame_id == 'front_laser'
    assert len(first.ranges) == 720
    ahead_m = [each.ranges[len(each.ranges) // 2] for each in (first, last)]
    assert ahead_m[0] < 2.0
    driven_m = record.column(0, 'x')[45] - record.column(0, 'x')[0]
    assert ahead_m[0] - ahead_m[1] == pytest.approx(driven_m, abs=0.01)


def test_a_world_that_is_gone_costs_the_scans_alone(record: Record, tmp_path: Path) -> None:
    gone = replace(record, world='/nowhere/playpen.xml')
    wrong = write(tmp_path, gone)
    assert wrong.startswith(f'{tmp_path}/run.mcap: without front/scan: ')
    assert '/nowhere/playpen.xml' in wrong
    assert '\n' not in wrong
    assert read(tmp_path, '/front/scan') == []
    assert len(read(tmp_path, '/ground_truth/odom')) == len(record.rows)


def test_a_world_that_has_changed_costs_the_scans_alone(record: Record, tmp_path: Path) -> None:
    first, *rest = record.obstacles
    for others in (tuple(rest), (replace(first, x=first.x + 0.01), *rest)):
        wrong = write(tmp_path, replace(record, obstacles=others))
        assert 'without front/scan: test: the obstacles of ' in wrong
        assert read(tmp_path, '/front/scan') == []


def test_the_robot_is_drawn_where_it_was(record: Record, tmp_path: Path) -> None:
    write(tmp_path, record)
    robots = read(tmp_path, '/ground_truth/robot')
    assert [time for time, _ in robots] == pytest.approx(record.time_sec.tolist())
    back, front = robots[-1][1].markers
    assert back.header.frame_id == front.header.frame_id == 'world'
    assert (back.id, front.id) == (0, 1)
    seam_m = back.pose.position.y + back.scale.x / 2
    assert seam_m == pytest.approx(front.pose.position.y - front.scale.x / 2)
    middle_m = (back.pose.position.y - back.scale.x / 2 + seam_m + front.scale.x) / 2
    y = record.column(0, 'y')[-1]
    assert (back.pose.position.x, middle_m) == pytest.approx((0.5, y))


def test_obstacles_waypoints_and_collisions_are_marked(record: Record, tmp_path: Path) -> None:
    write(tmp_path, replace(record, obstacles=OBSTACLES))
    ((_, around),) = read(tmp_path, '/surroundings')
    assert len({each.id for each in around.markers}) == len(around.markers)
    touched, free = [each for each in around.markers if each.ns == 'obstacles']
    assert (touched.type, touched.scale.x, touched.scale.y) == (Marker.CYLINDER, 0.4, 0.4)
    assert (free.type, free.scale.x, free.scale.y) == (Marker.CUBE, 4.0, 0.8)
    assert touched.color.r > 2 * touched.color.g
    assert free.color.r == pytest.approx(free.color.g, abs=0.05)
    numbers = [each for each in around.markers if each.ns == 'waypoints']
    assert [(each.text, each.pose.position.x) for each in numbers] == [('1', 0.0), ('2', 2.0)]
    pin, text = [each for each in around.markers if each.ns == 'collisions']
    assert (pin.pose.position.x, pin.pose.position.y) == TOUCH.position[:2]
    assert text.text == 'cone_1, 0.6 s'


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
