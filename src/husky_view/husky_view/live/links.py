# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topics and services of the simulator and of each robot, as the live view uses them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
import math
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PointStamped, PoseArray, Twist
from husky_course.frames import Array
from husky_course.record import Collision
from husky_course.robot import RobotStart
from husky_sim.world import default_worlds
from nav_msgs.msg import Path
import numpy as np
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.task import Future
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool, UInt32
from std_srvs.srv import Empty, SetBool, Trigger

from husky_view.live.checks import FARTHEST_M
from husky_view.picture.picture import Picture

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)

IDLE_SEC = 1.0
"""A page that has not driven for so long publishes no commands any more: others may."""

ANSWER_SEC = 2.0
"""A request without an answer is repeated after this time."""

_PARAMETERS = ['world', 'x', 'y', 'yaw', 'robots']


class SimulatorQuery:
    """Asks a simulator which world and robots it runs. Nothing here blocks."""

    def __init__(self, node: Node, name: str) -> None:
        self.name = name
        self._client = node.create_client(GetParameters, f'{name}/get_parameters')
        self._request: Future[Any] | None = None
        self._due_sec = 0.0

    def poll(self) -> tuple[str, tuple[RobotStart, ...]] | None:
        """Return the world's file and the robots if an answer has come; else ask where due."""
        now = time.monotonic()
        if self._request is None or now > self._due_sec:
            self._due_sec = now + ANSWER_SEC
            if self._client.service_is_ready():
                self._request = self._client.call_async(GetParameters.Request(names=_PARAMETERS))
            else:
                self._request = None
        elif self._request.done():
            answer, self._request = self._request.result(), None
            return _world_and_robots(answer)
        return None


def _world_and_robots(answer: GetParameters.Response) -> tuple[str, tuple[RobotStart, ...]]:
    world, x, y, yaw, robots = answer.values
    starts = tuple(RobotStart.parse(line) for line in robots.string_array_value if line.strip())
    one = RobotStart(x=_number(x), y=_number(y), yaw=_number(yaw))
    return world.string_value or str(default_worlds() / 'playpen.xml'), starts or (one,)


def _number(value: ParameterValue) -> float:
    # A person may have written 1 for 1.0.
    if value.type == ParameterType.PARAMETER_INTEGER:
        return float(value.integer_value)
    return float(value.double_value)


class SimulatorControl:
    """
    Controls a running simulator. Nothing here blocks.

    :param refused: called with what could not be done and why.
    :param closing: destroys the clients.
    """

    def __init__(
        self, node: Node, name: str, refused: Callable[[str, str], None], closing: ExitStack
    ) -> None:
        self._name = name
        self._refused = refused

        def create_client(kind: Any, service: str) -> Any:
            client = node.create_client(kind, f'{name}/{service}')
            closing.callback(node.destroy_client, client)
            return client

        self._set = create_client(SetParameters, 'set_parameters')
        self._pause = create_client(SetBool, 'pause')
        self._step = create_client(Trigger, 'step')
        self._reset = create_client(Empty, 'reset')

    def pause(self, paused: bool) -> None:
        """Pause, or go on."""
        self._call('Pause', self._pause, SetBool.Request(data=paused))

    def step(self) -> None:
        """Advance a paused simulation by one control period."""
        self._call('Step', self._step, Trigger.Request())

    def reset(self, then: Callable[[], None] | None = None) -> None:
        """Put everything back to the start; `then` is called when it is done."""
        self._call('Reset', self._reset, Empty.Request(), then)

    def set_factor(self, factor: float) -> None:
        """Set the real-time factor; 0 is as fast as possible."""
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=factor)
        parameter = Parameter(name='real_time_factor', value=value)
        self._call('Speed', self._set, SetParameters.Request(parameters=[parameter]))

    def _call(
        self, what: str, client: Any, request: Any, then: Callable[[], None] | None = None
    ) -> None:
        if not client.service_is_ready():
            self._refused(what, f'{self._name} does not answer: is the simulator running?')
            return

        def on_done(future: Future[Any]) -> None:
            for result in getattr(future.result(), 'results', [future.result()]):
                if not getattr(result, 'successful', getattr(result, 'success', True)):
                    reason = getattr(result, 'reason', '') or getattr(result, 'message', '')
                    self._refused(what, reason)
                    return
            if then is not None:
                then()

        client.call_async(request).add_done_callback(on_done)


class RobotLink:
    """
    Draws what a robot and its driver publish, and sends commands.

    :param place: of the robot in the world.
    :param namespace: empty, or with a slash at its end.
    :param invalid: called with what came that is invalid; it is not drawn.
    :param closing: destroys the publishers and subscriptions.
    """

    def __init__(
        self,
        node: Node,
        picture: Picture,
        place: int,
        namespace: str,
        invalid: Callable[[str], None],
        closing: ExitStack,
    ) -> None:
        self._node = node
        self._invalid = invalid
        self._picture = picture
        self._place = place
        self._robot = picture.robots[place]
        self._scan: LaserScan | None = None  # since the last frame
        self._waypoints: Array = np.zeros((0, 2))
        self.waypoints_left: int | None = None
        self._topic = f'{namespace}husky_velocity_controller/cmd_vel'
        self._commands: Publisher[Twist] | None = None  # only while the page drives
        self._driven_sec = 0.0
        self._stops = node.create_publisher(Bool, f'{namespace}e_stop', LATCHED)
        closing.callback(node.destroy_publisher, self._stops)
        closing.callback(self._end_commands)
        for kind, topic, callback, qos in (
            (DiagnosticStatus, 'collisions', self._on_collision, 10),
            (Path, 'path', self._on_path, LATCHED),
            (PoseArray, 'waypoints', self._on_waypoints, LATCHED),
            (UInt32, 'waypoints_left', self._on_waypoints_left, LATCHED),
            (PointStamped, 'lookahead_point', self._on_look_ahead, NEWEST),
            (LaserScan, 'front/scan', self._on_scan, NEWEST),
        ):
            subscription = node.create_subscription(kind, f'{namespace}{topic}', callback, qos)
            closing.callback(node.destroy_subscription, subscription)

    def drive(self, speed_m_s: float, yaw_rate_rad_s: float, *, now_sec: float) -> None:
        """Send a velocity command, as any teleop does."""
        if self._commands is None:
            self._commands = self._node.create_publisher(Twist, self._topic, 10)
        self._driven_sec = now_sec
        command = Twist()
        command.linear.x = speed_m_s
        command.angular.z = yaw_rate_rad_s
        self._commands.publish(command)

    def _end_commands(self) -> None:
        if self._commands is not None:
            self._node.destroy_publisher(self._commands)
            self._commands = None

    def stop(self, stopped: bool) -> None:
        """Press or release the emergency stop."""
        self._stops.publish(Bool(data=stopped))

    def draw(self, now_sec: float) -> None:
        """Draw the newest scan; once a frame, however often scans come."""
        if now_sec - self._driven_sec > IDLE_SEC:
            self._end_commands()
        scan, self._scan = self._scan, None
        if scan is not None:
            ranges = np.asarray(scan.ranges, dtype=np.float64)
            angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
            self._picture.show_scan(self._place, ranges, angles, reach_m=scan.range_max)

    def _on_collision(self, msg: DiagnosticStatus) -> None:
        try:
            collision = _collision_of(msg)
        except (KeyError, ValueError) as error:
            self._invalid(f'collisions: {error}')
            return
        self._picture.collisions.add(collision, now_sec=time.monotonic())

    def _on_path(self, msg: Path) -> None:
        points = [(pose.pose.position.x, pose.pose.position.y) for pose in msg.poses]
        if self._are_places('path', points):
            self._robot.set_path(np.array(points).reshape(-1, 2))

    def _on_waypoints(self, msg: PoseArray) -> None:
        points = [(pose.position.x, pose.position.y) for pose in msg.poses]
        if self._are_places('waypoints', points):
            self._waypoints = np.array(points).reshape(-1, 2)
            self._robot.set_waypoints(self._waypoints, reached=self._reached)

    def _on_waypoints_left(self, msg: UInt32) -> None:
        self.waypoints_left = msg.data
        self._robot.set_reached(self._reached)

    @property
    def _reached(self) -> int:
        left = self.waypoints_left
        return 0 if left is None else max(len(self._waypoints) - left, 0)

    def _on_look_ahead(self, msg: PointStamped) -> None:
        if self._are_places('lookahead_point', [(msg.point.x, msg.point.y)]):
            self._robot.set_look_ahead(np.array([msg.point.x, msg.point.y]))

    def _on_scan(self, msg: LaserScan) -> None:
        if not all(map(math.isfinite, (msg.angle_min, msg.angle_increment, msg.range_max))):
            self._invalid('front/scan: an angle or the greatest range is no number')
            return
        self._scan = msg

    def _are_places(self, topic: str, points: list[tuple[float, float]]) -> bool:
        for x, y in points:
            if not (abs(x) < FARTHEST_M and abs(y) < FARTHEST_M):  # NaN is not
                self._invalid(f'{topic}: ({x:g}, {y:g}) is no place')
                return False
        return True


def _collision_of(msg: DiagnosticStatus) -> Collision:
    values = {entry.key: entry.value for entry in msg.values}
    x, y, z = (float(word) for word in values['position'].split())
    if not all(map(math.isfinite, (x, y, z))):
        raise ValueError(f'position {values["position"]}')
    return Collision(
        robot=msg.hardware_id,
        obstacle=values['obstacle'],
        part=values['part'],
        time_sec=float(values['time_sec']),
        force_n=float(values['force_n']),
        position=(x, y, z),
    )
