# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of each robot, as the live view uses them."""

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
from nav_msgs.msg import Path
import numpy as np
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import (
    DurabilityPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool, UInt32

from husky_view.live.checks import FARTHEST_M
from husky_view.picture.picture import Picture

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)

IDLE_SEC = 1.0
"""A page that has not driven for so long publishes no commands any more: others may."""


class RobotLink:
    """
    Draws what a robot and its driver publish, and sends commands.

    `is_stopped` tells whether the emergency stop is pressed, by whomever.

    :param place: of the robot in the world.
    :param namespace: empty, or with a slash at its end.
    :param is_stopped: whether the stop is pressed already, on a page of another world.
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
        *,
        is_stopped: bool,
    ) -> None:
        self.is_stopped = is_stopped
        self._has_heard = False  # of a stop, by which it knows more than a scene of before
        self._node = node
        self._invalid = invalid
        self._picture = picture
        self._place = place
        self._robot = picture.robots[place]
        self._scan: LaserScan | None = None  # since the last frame
        self._waypoints: Array = np.zeros((0, 2))
        self.waypoints_left: int | None = None
        self._path_topic = f'{namespace}path'
        self._command_topic = f'{namespace}husky_velocity_controller/cmd_vel'
        self._commands: Publisher[Twist] | None = None  # only while the page drives
        self._driven_sec = 0.0
        self._stops: Publisher[Bool] | None = node.create_publisher(
            Bool,
            f'{namespace}e_stop',
            LATCHED,
            event_callbacks=PublisherEventCallbacks(matched=self._on_stop_match),
        )
        closing.callback(self._end_stops)
        closing.callback(self._end_commands)
        for kind, topic, callback, qos in (
            (Bool, 'e_stop', self._on_stop, 10),
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
            self._commands = self._node.create_publisher(Twist, self._command_topic, 10)
        self._driven_sec = now_sec
        command = Twist()
        command.linear.x = speed_m_s
        command.angular.z = yaw_rate_rad_s
        self._commands.publish(command)

    def _end_commands(self) -> None:
        if self._commands is not None:
            self._node.destroy_publisher(self._commands)
            self._commands = None

    def _end_stops(self) -> None:
        if self._stops is not None:
            self._node.destroy_publisher(self._stops)
            self._stops = None

    def stop(self, stopped: bool) -> None:
        """Press or release the emergency stop; where it is closed, it is only known here."""
        self._learn(stopped)
        if self._stops is not None:
            self._stops.publish(Bool(data=stopped))

    def adopt_stop(self, *, stopped: bool) -> None:
        """Learn of a stop that held the robot before the page heard of any."""
        if stopped and not self._has_heard:
            self.is_stopped = True

    def _learn(self, stopped: bool) -> None:
        self.is_stopped = stopped
        self._has_heard = True

    def _on_stop(self, msg: Bool) -> None:
        self._learn(msg.data)

    def _on_stop_match(self, event: Any) -> None:
        # The next simulator does not ask for what was published before it began.
        if self.is_stopped and event.current_count_change > 0:
            self.stop(True)

    def begin_run(self) -> None:
        """Forget the path of a driver that has ended."""
        if not self._node.count_publishers(self._path_topic):
            self._robot.set_path(np.zeros((0, 2)))
            self._set_waypoints(np.zeros((0, 2)))
            self.waypoints_left = None

    def end_idle_commands(self, now_sec: float) -> None:
        """Leave the robot to others where the page has not driven it for a while."""
        if now_sec - self._driven_sec > IDLE_SEC:
            self._end_commands()

    def draw(self) -> None:
        """Draw the newest scan; once a frame, however often scans come."""
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
            self._set_waypoints(np.array(points).reshape(-1, 2))

    def _set_waypoints(self, points: Array) -> None:
        self._waypoints = points
        self._robot.set_waypoints(points, reached=self._reached)

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
