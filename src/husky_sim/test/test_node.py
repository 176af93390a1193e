# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node over DDS: topics, rates, services, and what it refuses."""

from collections.abc import Callable, Iterator
from itertools import pairwise
import math
from pathlib import Path
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Twist, TwistStamped
from husky_course.record import read_record
from husky_course.robot import RobotStart
from husky_sim.errors import SettingError, StartPoseError, WorldError
from husky_sim.ros.node import SimulatorNode
from husky_sim.ros.pacing import CATCH_UP_SEC
from husky_sim.scene_topic import origin_of, read_scene, world_key
from husky_sim.scene_topic import QOS as SCENE_QOS
from husky_sim.world import default_worlds, load_world, urdf_of
from nav_msgs.msg import Odometry
import numpy as np
from playpen_testing.standard_error import standard_error
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState, LaserScan, NavSatFix
from std_msgs.msg import Float64MultiArray, String
from std_srvs.srv import Empty, SetBool, Trigger

from husky_sim.config import CONTROL_PERIOD_SEC

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
COMMANDS = 'husky_velocity_controller/cmd_vel'
TOPICS = {
    'odometry/filtered': Odometry,
    'husky_velocity_controller/odom': Odometry,
    'husky_velocity_controller/cmd_vel_out': Twist,
    'ground_truth/odom': Odometry,
    'imu/data': Imu,
    'joint_states': JointState,
    'collisions': DiagnosticStatus,
    '/clock': Clock,
}


class Probe(Node):
    """Subscribes to every topic of the simulator, and commands it."""

    def __init__(self, context: Context, prefix: str = '') -> None:
        super().__init__('probe', context=context)
        self.received: dict[str, list[Any]] = {name: [] for name in TOPICS}
        for name, kind in TOPICS.items():
            topic = name if name.startswith('/') else prefix + name
            self.create_subscription(kind, topic, self.received[name].append, 500)
        self.publisher = self.create_publisher(Twist, prefix + COMMANDS, 10)

    def command(self, speed_m_s: float, yaw_rate_rad_s: float = 0.0) -> None:
        message = Twist()
        message.linear.x, message.angular.z = speed_m_s, yaw_rate_rad_s
        self.publisher.publish(message)

    @property
    def odometry(self) -> list[Odometry]:
        return self.received['odometry/filtered']


class Bench:
    """A simulator and a probe that one executor serves, in this thread."""

    def __init__(self, domain_id: int, **parameters: Any) -> None:
        self.context = Context()
        rclpy.init(context=self.context, domain_id=domain_id)
        overrides = [Parameter(name, value=value) for name, value in parameters.items()]
        self.simulator = SimulatorNode(context=self.context, parameter_overrides=overrides)
        self.probe = Probe(self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.simulator)
        self.executor.add_node(self.probe)

    def until(self, holds: Callable[[], Any], what: str, *, timeout_sec: float = 15.0) -> None:
        deadline = time.monotonic() + timeout_sec
        while not holds():
            assert time.monotonic() < deadline, f'{what} did not come in {timeout_sec:g} s'
            self.executor.spin_once(timeout_sec=0.05)

    def matched(self) -> None:
        self.until(
            lambda: all(self.probe.received[n] for n in TOPICS if n != 'collisions'), 'topics'
        )

    def begun(self) -> None:
        self.until(lambda: self.probe.odometry, 'the first odometry message')

    def answer(self, speed_m_s: float, yaw_rate_rad_s: float = 0.0) -> None:
        """Command, and wait for the odometry that follows; lockstep repeats its first one."""
        before_sec = stamp_sec(self.probe.odometry[-1])
        self.probe.command(speed_m_s, yaw_rate_rad_s)
        self.until(lambda: stamp_sec(self.probe.odometry[-1]) > before_sec, 'the next odometry')

    def push(self, speed_m_s: float, *, until_m_s: float) -> None:
        """Command with each odometry message until the robot drives so fast."""
        for _ in range(100):
            self.answer(speed_m_s)
            if self.probe.odometry[-1].twist.twist.linear.x > until_m_s:
                return
        raise AssertionError(f'100 commands gave no {until_m_s} m/s')

    def call(self, kind: Any, name: str, request: Any) -> Any:
        client = self.probe.create_client(kind, f'/husky_sim/{name}')
        self.until(client.service_is_ready, f'the service {name}')
        future = client.call_async(request)
        self.until(future.done, f'an answer of {name}')
        return future.result()

    def close(self) -> None:
        self.executor.shutdown()
        self.probe.destroy_node()
        self.simulator.destroy_node()
        self.context.try_shutdown()


def newest(received: list[DiagnosticArray]) -> dict[str, str]:
    return {entry.key: entry.value for each in received[-1:] for entry in each.status[0].values}


@pytest.fixture
def bench(domain_id: int) -> Iterator[Callable[..., Bench]]:
    made: list[Bench] = []

    def make(**parameters: Any) -> Bench:
        made.append(Bench(domain_id, **parameters))
        return made[-1]

    yield make
    for each in made:
        each.close()


def stamp_sec(message: Any) -> float:
    return float(message.header.stamp.sec + message.header.stamp.nanosec * 1e-9)


def value(message: DiagnosticStatus, key: str) -> str:
    return str(next(entry.value for entry in message.values if entry.key == key))


def test_every_topic_comes_at_50_hz_of_simulated_time(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=3.0)
    run.matched()
    run.until(lambda: len(run.probe.received['imu/data']) > 60, '60 IMU messages')
    for name, kind in TOPICS.items():
        if kind in (Odometry, Imu, JointState):
            stamps = [stamp_sec(message) for message in run.probe.received[name]]
            steps = [after - before for before, after in pairwise(stamps)]
            assert steps == pytest.approx([0.02] * len(steps)), name
    clock = [m.clock.sec + m.clock.nanosec * 1e-9 for m in run.probe.received['/clock']]
    assert clock[-1] == pytest.approx(stamp_sec(run.probe.odometry[-1]), abs=0.0201)


def test_frames_and_covariances_are_those_of_the_original(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=0.0)
    run.matched()
    for off in ('front/scan', 'camera/image_raw', 'battery_state'):
        assert run.simulator.count_publishers(off) == 0, f'{off} should be off by default'
    filtered = run.probe.odometry[0]
    truth = run.probe.received['ground_truth/odom'][0]
    wheels = run.probe.received['husky_velocity_controller/odom'][0]
    imu = run.probe.received['imu/data'][-1]
    assert (filtered.header.frame_id, filtered.child_frame_id) == ('odom', 'base_link')
    assert (truth.header.frame_id, truth.child_frame_id) == ('world', 'base_link')
    assert list(wheels.pose.covariance[::7]) == [0.001] * 5 + [0.03]
    assert imu.linear_acceleration.z == pytest.approx(9.8, abs=0.05)
    assert imu.header.frame_id == 'base_link'
    assert list(run.probe.received['joint_states'][0].name) == [
        'front_left_wheel_joint',
        'front_right_wheel_joint',
        'rear_left_wheel_joint',
        'rear_right_wheel_joint',
    ]


def test_scanner_and_receiver_speak_at_their_rates(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=5.0, lidar_rate_hz=10.0)
    scans: list[LaserScan] = []
    fixes: list[NavSatFix] = []
    # Deep: while the simulator catches up it makes more in one turn than the probe reads in many.
    run.probe.create_subscription(LaserScan, 'front/scan', scans.append, 1000)
    run.probe.create_subscription(NavSatFix, 'navsat/fix', fixes.append, 1000)
    run.until(lambda: len(scans) > 5 and len(fixes) > 20, 'scans and fixes')
    steps = [stamp_sec(after) - stamp_sec(before) for before, after in pairwise(scans)]
    assert steps == pytest.approx([0.1] * len(steps))
    assert len(scans[0].ranges) == 720
    assert scans[0].header.frame_id == 'front_laser'
    assert scans[0].angle_max == pytest.approx(2.35619)
    assert (stamp_sec(fixes[20]) - stamp_sec(fixes[0])) == pytest.approx(0.5, abs=0.021)
    assert fixes[0].latitude == pytest.approx(49.9)
    assert fixes[0].position_covariance[0] > 0.0


def test_who_subscribes_later_is_heard(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=0.0, lidar_rate_hz=10.0, robots=['a 0 0 0', 'b -3 1.5 0'])
    run.until(lambda: run.simulator.time_sec > 0.5, 'half a second')
    kinds = {'imu/data': Imu, 'navsat/fix': NavSatFix, 'front/scan': LaserScan}
    heard: list[list[Any]] = []
    for topic, kind in kinds.items():
        heard.append([])
        run.probe.create_subscription(kind, f'b/{topic}', heard[-1].append, 10)
    run.until(lambda: all(heard), 'a message of each')


def test_another_filter_may_take_the_place_of_ours(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=0.0, localization=False)
    run.until(lambda: run.probe.received['husky_velocity_controller/odom'], 'wheel odometry')
    assert run.probe.count_publishers('odometry/filtered') == 0


def test_it_keeps_the_pace_it_is_told(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=0.5)
    heard: list[DiagnosticArray] = []
    for unread in list(run.probe.subscriptions):
        run.probe.destroy_subscription(unread)
    run.probe.create_subscription(DiagnosticArray, '/diagnostics', heard.append, 10)

    def lost_sec() -> float:
        """Return the wall time in which the machine held the simulator up, as it tells next."""
        count = len(heard)
        run.until(lambda: len(heard) > count, 'diagnostics')
        return float(value(heard[-1].status[0], 'wall_time_lost_sec'))

    def assert_pace(factor: float, simulated_sec: float) -> None:
        before_sec = lost_sec()
        first, begin = run.simulator.simulation.time_sec, time.monotonic()
        run.until(
            lambda: run.simulator.simulation.time_sec - first > simulated_sec,
            f'{simulated_sec:g} s of simulated time',
        )
        late_sec = time.monotonic() - begin - simulated_sec / factor
        # A busy machine cannot break this: what is made up for is bounded, the rest is told as
        # lost; on a free one nothing is lost.
        assert -CATCH_UP_SEC - CONTROL_PERIOD_SEC < late_sec < 0.9 + lost_sec() - before_sec

    assert_pace(0.5, 1.0)
    refused, changed = run.simulator.set_parameters(
        [Parameter('real_time_factor', value=-1.0), Parameter('real_time_factor', value=2.0)]
    )
    assert not refused.successful
    assert changed.successful
    assert_pace(2.0, 3.0)
    run.simulator.set_parameters([Parameter('real_time_factor', value=6.0)])
    assert_pace(6.0, 6.0)


def test_the_scene_of_a_fast_run_leaves_periods_out(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=0.0)
    received: list[Float64MultiArray] = []
    run.probe.create_subscription(Float64MultiArray, 'husky_sim/scene', received.append, SCENE_QOS)
    run.until(lambda: len(received) > 10, 'ten scenes')
    scenes = [read_scene(message, robots=1) for message in received[1:]]
    times_sec = np.concatenate([scene.time_sec for scene in scenes])
    assert (np.diff(times_sec) > 0.0).all()
    periods = round((times_sec[-1] - times_sec[0]) / CONTROL_PERIOD_SEC)
    assert len(times_sec) < periods, 'every period is in it'
    world = run.simulator.simulation.world
    seen = load_world(world.path, world.robots)
    assert seen.model.ngeom > world.model.ngeom, 'nothing is left out that is only seen'
    assert origin_of(received[0])[0] == world_key(seen), 'no viewer shows it'


def test_it_stops_within_the_timeout_after_the_last_command(
    bench: Callable[..., Bench], capfd: pytest.CaptureFixture[str]
) -> None:
    # Slowly, so that what is on its way on a busy machine is little of simulated time.
    run = bench(real_time_factor=0.1)
    run.matched()
    run.push(0.5, until_m_s=0.45)
    run.probe.command(0.49)
    (robot,) = run.simulator.simulation.robots
    run.until(lambda: robot.controller.asked_speed_m_s == 0.49, 'the last command')
    last_sec = run.simulator.simulation.time_sec
    run.until(lambda: run.probe.odometry[-1].twist.twist.linear.x < 0.01, 'the stop')
    # 0.25 s of timeout, 0.5 / 3.0 s of braking, and what was on its way
    assert stamp_sec(run.probe.odometry[-1]) - last_sec < 0.25 + 0.167 + 0.1
    assert 'no command for 0.25 s (command_timeout_sec); stopping' in capfd.readouterr().err


@pytest.mark.parametrize('bad', [math.nan, math.inf])
def test_a_command_that_is_no_number_stops_it_with_one_line(
    bench: Callable[..., Bench], capfd: pytest.CaptureFixture[str], bad: float
) -> None:
    run = bench(real_time_factor=1.0)
    run.matched()
    run.push(0.3, until_m_s=0.25)
    run.probe.command(0.3, bad)
    run.until(lambda: run.probe.odometry[-1].twist.twist.linear.x < 0.01, 'the stop')
    lines = [line for line in capfd.readouterr().err.splitlines() if 'finite' in line]
    assert len(lines) == 1


def test_a_stamped_command_is_answered_with_what_is_wrong(
    bench: Callable[..., Bench], domain_id: int
) -> None:
    run = bench()
    context = Context()
    rclpy.init(context=context, domain_id=domain_id)
    stranger = Node('stranger', context=context)
    with standard_error() as logged:
        stranger.create_publisher(TwistStamped, COMMANDS, 10)
        run.until(lambda: 'publish geometry_msgs/msg/Twist' in logged(), 'an explanation')
        assert 'stranger publishes geometry_msgs/msg/TwistStamped on ' in logged()
    stranger.destroy_node()
    context.try_shutdown()


def test_diagnostics_tell_the_pace_and_whether_it_is_kept(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=0.5)  # also a busy machine keeps this one, but for a moment
    received: list[DiagnosticArray] = []
    run.probe.create_subscription(DiagnosticArray, '/diagnostics', received.append, 10)
    kept = [DiagnosticStatus.OK] * 2  # one alone may be of the short time after one that was late
    run.until(lambda: [each.status[0].level for each in received[-2:]] == kept, 'a pace kept')
    values = newest(received)
    assert float(values['real_time_factor']) == pytest.approx(0.5, rel=0.2)
    assert values['real_time_factor_asked'] == '0.5'
    assert values['physics_warnings'] == '0'
    assert received[-1].status[0].name == 'husky_sim: time'


def test_after_a_stall_it_tells_so_and_goes_on_with_whole_steps(
    bench: Callable[..., Bench],
) -> None:
    run = bench(real_time_factor=1.0)
    received: list[DiagnosticArray] = []
    run.probe.create_subscription(DiagnosticArray, '/diagnostics', received.append, 10)
    run.matched()
    run.until(lambda: received, 'diagnostics')
    lost_sec = float(newest(received)['wall_time_lost_sec'])  # by a busy machine
    before_sec, over_at = run.simulator.simulation.time_sec, time.monotonic() + 0.4
    while time.monotonic() < over_at:
        pass  # as if the machine were busy with something else
    run.until(lambda: run.simulator.simulation.time_sec > before_sec, 'the next period')
    assert run.simulator.simulation.time_sec < before_sec + 0.11, 'it should not make up for it'
    run.until(lambda: float(newest(received)['wall_time_lost_sec']) > lost_sec + 0.25, 'lost time')
    assert received[-1].status[0].level == DiagnosticStatus.WARN
    assert int(newest(received)['overruns']) >= 1
    stamps = [stamp_sec(message) for message in run.probe.odometry]
    assert [after - before for before, after in pairwise(stamps)] == pytest.approx(
        [0.02] * (len(stamps) - 1)
    )


def test_a_pace_beyond_the_machine_leaves_it_listening(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=1000.0)
    run.matched()
    spun_at = time.monotonic()
    run.executor.spin_once(timeout_sec=0.0)
    assert time.monotonic() - spun_at < 0.3
    assert run.call(SetBool, 'pause', SetBool.Request(data=True)).success
    assert run.simulator.simulation.physics_warnings == 0


def test_driving_into_the_barrier_reports_one_collision(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=5.0)
    run.matched()

    def hit() -> bool:
        run.probe.command(0.6)
        return bool(run.probe.received['collisions'])

    run.until(hit, 'a collision')
    (touch,) = run.probe.received['collisions']
    assert touch.name == 'jersey_barrier_15'
    assert touch.hardware_id == 'husky'
    assert touch.level == DiagnosticStatus.ERROR
    assert value(touch, 'obstacle') == 'jersey_barrier_15'
    assert value(touch, 'part') in ('front_bumper', 'front_left_wheel')
    assert float(value(touch, 'force_n')) > 0.0
    assert 1.0 < float(value(touch, 'time_sec')) < 20.0
    assert len(value(touch, 'position').split()) == 3


def test_lockstep_advances_one_period_for_each_command(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=0.0, lockstep=True)
    run.begun()
    run.until(lambda: len(run.probe.odometry) >= 2, 'its repetition')
    assert {stamp_sec(message) for message in run.probe.odometry} == {0.0}
    for answered in range(1, 51):
        run.answer(0.5)
        assert stamp_sec(run.probe.odometry[-1]) == pytest.approx(answered * 0.02)
    deadline = time.monotonic() + 0.7
    received = len(run.probe.odometry)
    while time.monotonic() < deadline:
        run.executor.spin_once(timeout_sec=0.05)
    assert len(run.probe.odometry) == received, 'it went on without a command'


def test_pause_step_and_reset(bench: Callable[..., Bench]) -> None:
    run = bench(real_time_factor=1.0)
    run.matched()
    assert not run.call(Trigger, 'step', Trigger.Request()).success
    assert run.call(SetBool, 'pause', SetBool.Request(data=True)).success
    paused_sec = stamp_sec(run.probe.odometry[-1])
    assert run.call(Trigger, 'step', Trigger.Request()).success
    run.until(lambda: stamp_sec(run.probe.odometry[-1]) > paused_sec, 'the stepped period')
    run.call(Empty, 'reset', Empty.Request())
    run.until(lambda: stamp_sec(run.probe.odometry[-1]) == 0.0, 'time 0')
    assert run.probe.odometry[-1].pose.pose.position.x == 0.0
    assert run.call(SetBool, 'pause', SetBool.Request(data=False)).success
    run.until(lambda: stamp_sec(run.probe.odometry[-1]) > 0.1, 'time to pass again')


def test_two_runs_of_the_same_commands_are_the_same_bit_for_bit(
    bench: Callable[..., Bench], tmp_path: Path
) -> None:
    records = []
    for name in ('one', 'two'):
        path = tmp_path / name
        run = bench(real_time_factor=0.0, lockstep=True, record=str(path))
        run.begun()
        for step in range(150):
            run.answer(0.6, 0.8 * math.sin(step / 20.0))
        run.close()
        records.append(read_record(path))
    assert records[0].rows.tobytes() == records[1].rows.tobytes()
    assert len(records[0].rows) == 151
    assert records[0].robots == (RobotStart(),)


def test_who_asks_late_gets_the_description_of_the_robot(bench: Callable[..., Bench]) -> None:
    run = bench()
    run.begun()
    told: list[String] = []
    run.probe.create_subscription(String, 'robot_description', told.append, LATCHED)
    run.until(lambda: told, 'robot_description')
    assert told[0].data == urdf_of(default_worlds() / 'husky.xml')


def test_each_of_many_robots_has_its_own_topics(domain_id: int) -> None:
    context = Context()
    rclpy.init(context=context, domain_id=domain_id)
    robots = ['alpha 0 0 0', 'beta -3 -1 0.7854']
    overrides = [Parameter('robots', value=robots), Parameter('real_time_factor', value=0.0)]
    simulator = SimulatorNode(context=context, parameter_overrides=overrides)
    probes = [Probe(context, prefix) for prefix in ('alpha/', 'beta/')]
    executor = SingleThreadedExecutor(context=context)
    nodes: list[Node] = [simulator, *probes]
    for node in nodes:
        executor.add_node(node)
    deadline = time.monotonic() + 15.0
    while not all(probe.received['ground_truth/odom'] for probe in probes):
        assert time.monotonic() < deadline, 'one of the robots says nothing'
        executor.spin_once(timeout_sec=0.05)
    x = [probe.received['ground_truth/odom'][0].pose.pose.position.x for probe in probes]
    executor.shutdown()
    for node in reversed(nodes):
        node.destroy_node()
    context.try_shutdown()
    assert x == pytest.approx([0.0, -3.0], abs=0.01)


@pytest.mark.parametrize(
    ('parameters', 'error', 'message'),
    [
        ({'world': 'nowhere.xml'}, WorldError, 'no such file'),
        ({'x': 2.4}, StartPoseError, 'would start inside jersey_barrier_15'),
        ({'x': 500.0}, StartPoseError, 'there is no ground under it'),
        ({'speed_limit_m_s': -1.0}, SettingError, 'speed_limit_m_s'),
        ({'real_time_factor': 'fast'}, SettingError, 'real_time_factor'),
        ({'lidar_rate': 20.0}, SettingError, 'did you mean lidar_rate_hz'),
        ({'lidar_rate_hz': 1e-300}, SettingError, '0 or a number from 0.001 to 50 is allowed'),
        (
            {'floor': 'ice'},
            SettingError,
            'one of ideal, asphalt, concrete_indoor, wet, gravel, grass',
        ),
        ({'lockstep': True, 'localization': False}, SettingError, 'set localization to true'),
        ({'seed': 1.5}, SettingError, 'seed=1.5: a whole number from 0 to 4294967295 is allowed'),
        ({'seed': -1}, SettingError, 'seed=-1: a whole number from 0'),
        ({'robots': ['a/b 0 0 0']}, SettingError, "a robot is 'NAME X Y YAW'"),
        ({'robots': ['a 0 0']}, SettingError, "a robot is 'NAME X Y YAW'"),
    ],
)
def test_a_setting_that_cannot_be_is_refused(
    domain_id: int, parameters: dict[str, Any], error: type[Exception], message: str
) -> None:
    context = Context()
    rclpy.init(context=context, domain_id=domain_id)
    overrides = [Parameter(name, value=value) for name, value in parameters.items()]
    with pytest.raises(error, match=message):
        SimulatorNode(context=context, parameter_overrides=overrides)
    context.try_shutdown()
