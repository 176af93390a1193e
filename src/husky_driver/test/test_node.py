# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node as a process of its own, over DDS, against the plant as a node in lockstep."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import math
import os
from pathlib import Path
import signal
import subprocess
import sys
import time
from types import SimpleNamespace
from typing import Any

from geometry_msgs.msg import Twist
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_driver.drive.drive import Drive
from husky_driver.motion import Command, STOP
from husky_driver.ros.node import FollowPath
from nav_msgs.msg import Odometry
from playpen_testing.forks import Ended, run_forked
from playpen_testing.services import ask
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import Imu
from std_srvs.srv import SetBool

# The lark of the rclpy wheels imports modules that Python is about to drop.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

NO_SLIP = ('--ros-args', '-p', 'slip:=false')  # the plant of these tests does not slide
COURSE = 'speed: 0.8\nwaypoints: [[0, 0], [2, 0.5], [4, 0]]\n'
WORLD = """<mujoco><option timestep="0.004"/><worldbody>
<geom name="ground" type="plane" size="9 9 1"/>
<body name="crate" pos="0 -3 0.2"><geom type="box" size="0.2 0.2 0.2"/></body>
</worldbody></mujoco>"""


class PlantNode(Node):
    """Publishes odometry in lockstep: the next one after each command."""

    def __init__(self, plant: Any, **ros: Any) -> None:
        super().__init__('plant', **ros)
        self.plant = plant
        self.received: list[Command] = []
        self.answered = math.inf  # after so many commands it falls silent
        self.spoil: Callable[[Odometry], None] = lambda _: None  # falsifies a message
        self._sent_sec = 0.0
        self._odometry = self.create_publisher(Odometry, 'odometry/filtered', 10)
        topic = 'husky_velocity_controller/cmd_vel'
        self.commands = self.create_subscription(Twist, topic, self._on_command, 10)
        self.create_timer(0.02, self._on_tick, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _on_tick(self) -> None:
        matched = self._odometry.get_subscription_count() and self.commands.get_publisher_count()
        if matched and not self.received and time.monotonic() - self._sent_sec > 0.5:
            self._sent_sec = time.monotonic()
            self.publish()

    def _on_command(self, msg: Twist) -> None:
        self.received.append(Command(msg.linear.x, msg.angular.z))
        self.plant.advance(self.received[-1])
        if len(self.received) < self.answered:
            self.publish()

    def go_on(self) -> None:
        """Answer again."""
        self.answered = math.inf
        self.publish()

    def publish(self) -> None:
        now, msg = self.plant.now, Odometry()
        nanoseconds = round(now.time_sec * 1e9)
        msg.header.stamp.sec, msg.header.stamp.nanosec = divmod(nanoseconds, 10**9)
        msg.pose.pose.position.x, msg.pose.pose.position.y = now.x_m, now.y_m
        msg.pose.pose.orientation.z = math.sin(now.yaw_rad / 2)
        msg.pose.pose.orientation.w = math.cos(now.yaw_rad / 2)
        msg.twist.twist.linear.x, msg.twist.twist.angular.z = now.speed_m_s, now.yaw_rate_rad_s
        self.spoil(msg)
        self._odometry.publish(msg)


@pytest.fixture
def plant_node(
    domain: int, make_plant: Any, monkeypatch: pytest.MonkeyPatch
) -> Iterator[PlantNode]:
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    with SpunNodes(domain) as nodes:
        yield nodes.start(PlantNode, make_plant())


@pytest.fixture
def follow_path(domain: int) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start the node as a process; what is still running at the end of the test is killed."""
    running: list[subprocess.Popen[str]] = []

    def start(*arguments: str | Path, check: str = 'off', **more: str) -> subprocess.Popen[str]:
        environment = dict(os.environ, ROS_DOMAIN_ID=str(domain), PYTHONWARNINGS='default')
        environment |= {'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST', **more}
        environment['PYTHONPATH'] = os.pathsep.join([str(Path(__file__).parents[1]), *sys.path])
        words = *map(str, arguments), *NO_SLIP, '-p', f'check:={check}'  # which loads MuJoCo
        process = subprocess.Popen(
            [sys.executable, '-m', 'husky_driver.follow_path', *words],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        running.append(process)
        return process

    yield start
    for process in running:
        process.kill()
        process.communicate()


@pytest.fixture
def course(tmp_path: Path) -> Path:
    path = tmp_path / 'course.yaml'
    path.write_text(COURSE)
    return path


def test_each_odometry_of_a_whole_course_gets_one_command(
    plant_node: PlantNode, follow_path: Any, course: Path
) -> None:
    process = follow_path('--waypoints', course, check='warn')
    output, _ = process.communicate(timeout=20)
    assert process.returncode == 0, output
    assert 'done: 3 of 3 waypoints' in output
    end = plant_node.plant.now
    assert (end.x_m, end.y_m) == pytest.approx((4.0, 0.0), abs=0.02)
    assert end.is_standing
    assert len(plant_node.received) == round(end.time_sec / 0.02)


def test_it_drives_without_mujoco(
    plant_node: PlantNode,
    follow_path: Any,
    course: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (tmp_path / 'mujoco.py').write_text("raise ImportError('mujoco is not installed')\n")
    monkeypatch.syspath_prepend(tmp_path)
    process = follow_path('--waypoints', course)
    output, _ = process.communicate(timeout=20)
    assert process.returncode == 0, output
    assert plant_node.plant.now.x_m == pytest.approx(4.0, abs=0.02)


def test_the_answered_distance_is_driven(plant_node: PlantNode, follow_path: Any) -> None:
    process = follow_path()
    output, _ = process.communicate('fast\n0.6\n1.5\n0\n', timeout=20)
    assert process.returncode == 0, output
    assert "'fast' is not a number; allowed is 0.05 to 1 m/s" in output
    assert output.index('Input your speed:') < output.index('Type your distance:')
    assert output.index('Type your distance:') < output.index('Forward?:')
    assert plant_node.plant.now.x_m == pytest.approx(-1.5, abs=0.02)
    assert plant_node.plant.now.is_standing


def on_its_way(
    plant_node: PlantNode,
    follow_path: Any,
    course: Path,
    *parameters: str,
    timeout_sec: float = 10.0,
    check: str = 'off',
) -> Any:
    """Return a driver that has driven for some time, and waits for odometry."""
    plant_node.answered = 80
    given = (f'odometry_timeout_sec:={timeout_sec}', *parameters)
    arguments = [word for each in given for word in ('-p', each)]
    process = follow_path('--waypoints', course, '--ros-args', *arguments, check=check)
    wait_until(lambda: len(plant_node.received) >= 80, timeout_sec=15, what='80 commands')
    return process


def test_odometry_that_ends_is_given_up_with_a_message(
    plant_node: PlantNode, follow_path: Any, course: Path
) -> None:
    process = on_its_way(plant_node, follow_path, course, timeout_sec=0.5)
    output, _ = process.communicate(timeout=10)
    assert process.returncode == 1
    assert 'gave up: no odometry for' in output
    assert '/odometry/filtered is silent' in output
    assert plant_node.received[-1] == (0.0, 0.0)


def test_the_time_in_which_it_is_stopped_itself_is_no_silence(
    plant_node: PlantNode, follow_path: Any, course: Path
) -> None:
    """As Ctrl-Z does it, or a computer that is put to sleep: its simulator sleeps, too."""
    process = on_its_way(plant_node, follow_path, course, timeout_sec=2.0)
    process.send_signal(signal.SIGSTOP)
    time.sleep(2.5)
    process.send_signal(signal.SIGCONT)
    time.sleep(0.2)  # it looks whether it is late before it hears anything
    plant_node.go_on()
    output, _ = process.communicate(timeout=60)
    assert process.returncode == 0, output


def test_without_a_simulator_it_gives_up_with_a_reason(
    follow_path: Any, course: Path, domain: int
) -> None:
    process = follow_path('--waypoints', course, '--ros-args', '-p', 'startup_timeout_sec:=0.5')
    output, _ = process.communicate(timeout=10)
    assert process.returncode == 1
    assert 'nobody publishes /odometry/filtered' in output
    assert f'ROS_DOMAIN_ID={domain}' in output
    assert 'Traceback' not in output


def test_a_robot_in_another_namespace_is_named(
    plant_node: PlantNode, follow_path: Any, course: Path
) -> None:
    assert plant_node.count_publishers('/odometry/filtered') == 1
    words = ('--waypoints', course, '--ros-args', '-p', 'startup_timeout_sec:=1.5')
    # Another driver that waits is no robot.
    follow_path(*words[:3], '-r', '__ns:=/also_lost')
    output, _ = follow_path(*words, '-r', '__ns:=/lost').communicate(timeout=20)
    assert (
        'gave up: no odometry for 2 s; nobody publishes /lost/odometry/filtered; it is in the '
        'namespace /: write `--ros-args -r __ns:=/`'
    ) in output


@pytest.mark.parametrize(
    ('name', 'value', 'said'),
    [
        ('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF', 'nodes do not find each other: `export'),
        ('ROS_DISCOVERY_SERVER', '127.0.0.1:11899', 'is the discovery server running, as ROS_D'),
    ],
)
def test_a_variable_that_parts_nodes_is_the_reason(
    follow_path: Any, course: Path, name: str, value: str, said: str
) -> None:
    words = ('--waypoints', course, '--ros-args', '-p', 'startup_timeout_sec:=0.5')
    output, _ = follow_path(*words, **{name: value}).communicate(timeout=10)
    assert said in output


@pytest.mark.parametrize(('number', 'code'), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_stops_the_robot_and_then_the_node(
    plant_node: PlantNode, follow_path: Any, course: Path, number: int, code: int
) -> None:
    process = follow_path('--waypoints', course)
    wait_until(lambda: plant_node.plant.now.speed_m_s > 0.5, timeout_sec=15, what='motion')
    begun = time.monotonic()
    process.send_signal(number)
    output, _ = process.communicate(timeout=10)
    assert time.monotonic() - begun < 2.0
    assert process.returncode == code, output
    assert 'Traceback' not in output
    assert plant_node.plant.now.is_standing


# Ctrl-C sends one to all in a terminal, and a launch of Jazzy's another one to its nodes.
def test_a_signal_that_comes_while_one_is_told_is_not_told(
    domain: int, course: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    drive = Drive(plan_route(load_course(course)))
    node = FollowPath(lambda *_: drive, context=context)
    told = list[str]()

    def error(text: str) -> None:
        told.append(text)
        node.stop(130, 'stopped by SIGINT again')

    monkeypatch.setattr(node, 'get_logger', lambda: SimpleNamespace(error=error))
    node.stop(130, 'stopped by SIGINT')
    node.destroy_node()
    rclpy.shutdown(context=context)
    assert told == ['stopped by SIGINT']


def test_a_drive_can_be_paused_and_goes_on(
    plant_node: PlantNode, follow_path: Any, course: Path
) -> None:
    process = on_its_way(plant_node, follow_path, course)
    pause = '/follow_path/pause'
    assert ask(plant_node, SetBool, pause, data=True).message == 'paused'
    plant_node.go_on()
    wait_until(
        lambda: plant_node.received[-30:] == [Command(0.0, 0.0)] * 30,
        timeout_sec=10,
        what='standing robot',
    )
    assert plant_node.plant.now.x_m < 3.0
    ask(plant_node, SetBool, pause, data=False)
    output, _ = process.communicate(timeout=20)
    assert process.returncode == 0, output
    assert plant_node.plant.now.x_m == pytest.approx(4.0, abs=0.02)


def test_a_new_file_takes_over_and_a_bad_one_is_refused(
    plant_node: PlantNode, follow_path: Any, course: Path
) -> None:
    world = course.with_name('world.xml')
    world.write_text(WORLD)
    process = on_its_way(plant_node, follow_path, course, f'world:={world}', check='refuse')
    names = ('other.yaml', 'broken.yaml', 'through.yaml')
    other, broken, through = map(course.with_name, names)
    other.write_text('speed: 0.8\nwaypoints: [[1, 1], [2, 2]]\n')
    broken.write_text('speed: fast\n')
    through.write_text('waypoints: [[0, 0], [0, -4]]\n')

    def set_waypoints(path: Path | str) -> Any:
        value = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=str(path))
        given = [Parameter(name='waypoints', value=value)]
        name = '/follow_path/set_parameters'
        return ask(plant_node, SetParameters, name, parameters=given).results[0]

    refused = set_waypoints(broken)
    assert not refused.successful
    assert 'broken.yaml: line 1' in refused.reason
    assert set_waypoints('').reason == "waypoints='': no file; give the path of one .yaml file"
    refused = set_waypoints(through)
    assert not refused.successful
    assert refused.reason.endswith('not driven, it passes too near to obstacles')
    assert set_waypoints(other).successful
    plant_node.go_on()
    output, _ = process.communicate(timeout=20)
    assert process.returncode == 0, output
    assert 'done: 2 of 2 waypoints' in output
    assert 'through.yaml: line 1: on the way to waypoint 2 the robot touches crate' in output
    end = plant_node.plant.now
    assert (end.x_m, end.y_m) == pytest.approx((2.0, 2.0), abs=0.02)


def test_a_namespace_and_remaps_apply(
    plant_node: PlantNode, follow_path: Any, course: Path
) -> None:
    process = follow_path(
        *('--waypoints', course, '--ros-args', '-r', '__ns:=/beta'),
        *('-r', 'odometry/filtered:=/odometry/filtered'),
        *('-r', 'husky_velocity_controller/cmd_vel:=/husky_velocity_controller/cmd_vel'),
    )
    output, _ = process.communicate(timeout=20)
    assert process.returncode == 0, output
    assert '[beta.follow_path]' in output
    assert plant_node.plant.now.x_m == pytest.approx(4.0, abs=0.02)


REFUSED = {
    ('--wayponts', 'x'): 'follow_path: unrecognized arguments: --wayponts x',
    ('--ros-args', '-p', 'wayponts:=x'): (
        'follow_path: parameter wayponts does not exist; did you mean waypoints?'
    ),
    ('--ros-args', '-p', 'progress:=x'): "parameter progress: 'x' is not allowed",
    ('--ros-args', '-p', 'odometry_timeout_sec:=a'): "'a' is not allowed; allowed is 0.1 to",
    ('--ros-args', '-p', 'waypoints:=~/no.yaml'): f'{Path.home()}/no.yaml: no such file',
    (): 'follow_path: nobody answers; give a file: --waypoints FILE',
}


@pytest.fixture(scope='module')
def refused() -> dict[tuple[str, ...], Ended]:
    ended = run_forked(*(('husky_driver.follow_path', *words, *NO_SLIP) for words in REFUSED))
    return dict(zip(REFUSED, ended, strict=True))


@pytest.mark.parametrize('arguments', REFUSED)
def test_bad_input_is_refused_with_one_line(refused: Any, arguments: Any) -> None:
    ended = refused[arguments]
    assert ended.status == 2
    assert REFUSED[arguments] in ended.err.splitlines()[-1]
    assert 'Traceback' not in ended.out + ended.err


def nowhere(msg: Odometry) -> None:
    msg.pose.pose.position.x = math.nan


def far_away(msg: Odometry) -> None:
    msg.pose.pose.position.x = 4.4e87


def no_turn(msg: Odometry) -> None:
    msg.pose.pose.orientation.w = msg.pose.pose.orientation.z = 0.0


def elsewhere(msg: Odometry) -> None:
    msg.pose.pose.position.y += 3.0


def earlier(msg: Odometry) -> None:
    msg.header.stamp.sec -= 1


@pytest.mark.parametrize(
    ('spoil', 'said'),
    [
        (nowhere, 'its x is nan m'),
        (far_away, 'its x is 4.4e+87 m'),
        (no_turn, 'its orientation (0, 0, 0, 0) is no rotation: its length is 0, not 1'),
        (elsewhere, 'it jumps 3.00 m in 0.02 s'),
        (earlier, 'which is no reset'),
    ],
)
def test_implausible_odometry_is_named_and_stops_the_robot(
    plant_node: PlantNode, follow_path: Any, course: Path, spoil: Any, said: str
) -> None:
    process = on_its_way(plant_node, follow_path, course)
    told = len(plant_node.received)
    plant_node.spoil = spoil
    plant_node.go_on()
    output, _ = process.communicate(timeout=10)
    assert process.returncode == 1, output
    assert 'Traceback' not in output
    (line,) = [line for line in output.splitlines() if 'cannot be true' in line]
    assert 'gave up: /odometry/filtered cannot be true: ' in line
    assert said in line
    assert line.endswith('`ros2 topic info -v /odometry/filtered` names them')
    stops = plant_node.received[told:]
    assert set(stops) == {Command(0.0, 0.0)}, 'only stops, from the next command on'
    assert plant_node.plant.now.is_standing


@pytest.mark.parametrize(
    ('names', 'said'),
    [
        ((), 'its emergency stop (e_stop) pressed?\n'),
        (
            ('joystick', 'teleop'),
            'pressed?; /joystick and /teleop also publish /husky_velocity_controller/cmd_vel, so',
        ),
    ],
)
def test_who_else_commands_a_robot_that_does_not_obey_is_named(
    plant_node: PlantNode, domain: int, follow_path: Any, course: Path, names: Any, said: str
) -> None:
    advance = plant_node.plant.advance
    plant_node.plant.advance = lambda _: advance(STOP)

    def command(node: Node) -> None:
        node.create_publisher(Twist, 'husky_velocity_controller/cmd_vel', 10)

    with SpunNodes(domain) as nodes:
        for name in names:
            nodes.start(Node, name, before_spin=command)
        output, _ = follow_path('--waypoints', course).communicate(timeout=60)
    assert said in output


def test_an_implausible_imu_message_ends_the_drive(
    plant_node: PlantNode, follow_path: Any, course: Path
) -> None:
    imu = plant_node.create_publisher(Imu, 'imu/data', 50)
    process = on_its_way(plant_node, follow_path, course)
    message = Imu()
    message.orientation_covariance[0] = -1.0  # the orientation is not measured: accepted
    imu.publish(message)
    message = Imu()
    message.linear_acceleration.x = math.nan
    imu.publish(message)
    output, _ = process.communicate(timeout=10)
    assert process.returncode == 1, output
    assert '/imu/data cannot be true: its linear_acceleration.x is nan; who publishes' in output
    assert plant_node.received[-1] == (0.0, 0.0)


def test_two_simulators_end_the_drive_and_are_counted(
    plant_node: PlantNode, follow_path: Any, course: Path
) -> None:
    other = plant_node.create_publisher(Odometry, 'odometry/filtered', 10)
    process = on_its_way(plant_node, follow_path, course)
    message = Odometry()
    message.header.stamp.nanosec = 500_000_000  # that robot stands at its start
    message.pose.pose.orientation.w = 1.0
    other.publish(message)
    plant_node.go_on()
    output, _ = process.communicate(timeout=10)
    assert process.returncode == 1, output
    assert '2 nodes publish it' in output
    assert 'Traceback' not in output
    assert plant_node.received[-1] == (0.0, 0.0)
