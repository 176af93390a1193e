# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The grader's eye on the graph: the true pose, and how the controller publishes."""

from __future__ import annotations

import time
from typing import Any

from husky_driver.checks import no_rotation, OdometryCheck
from husky_driver.motion import relative, yaw_of
from husky_driver.ros import read_odometry
from nav_msgs.msg import Odometry
import rclpy
from rclpy.node import Node

from husky_grader.run.graph_hints import controller_hints

COMMAND_TOPIC = '/husky_velocity_controller/cmd_vel'
OWN_NODES = ('husky_sim', 'grader')


class Watcher(Node):
    """Keeps the newest true pose, relative to the first, and hints about the controller."""

    def __init__(self, context: rclpy.Context) -> None:
        super().__init__('grader', context=context)
        self.latest: Odometry | None = None
        self.count = 0
        self.hints: list[str] = []
        self.nonsense = ''  # what came that cannot be true; after it nothing is believed
        self._check = OdometryCheck()
        self._hinting_since_sec: float | None = None
        self._first: tuple[float, float, float] | None = None
        self._poses = self.create_subscription(Odometry, 'ground_truth/odom', self._on_pose, 10)

    def _on_pose(self, msg: Odometry) -> None:
        if self.nonsense:
            return
        what = no_rotation(msg.pose.pose.orientation) or self._check.complaint(read_odometry(msg))
        if what:
            topic = self._poses.topic_name
            count = self.count_publishers(topic)
            self.nonsense = f'{topic} cannot be true: {what}' + (
                f'; {count} nodes publish it: does the controller start a simulator of its own?'
                if count > 1
                else ''
            )
            return
        self.latest = msg
        self.count += 1
        if self._first is None:
            position, q = msg.pose.pose.position, msg.pose.pose.orientation
            self._first = (position.x, position.y, yaw_of(q.x, q.y, q.z, q.w))

    def look(self) -> None:
        """Look at the graph; what was noticed once is kept, for nodes may come and go."""
        hints = controller_hints(self, COMMAND_TOPIC, OWN_NODES)
        if not hints:
            self._hinting_since_sec = None
        elif self._hinting_since_sec is None:
            self._hinting_since_sec = time.monotonic()
        self.hints = hints or self.hints

    def hinting_sec(self, now_sec: float) -> float:
        """Return for how long, until now, every look has found something wrong."""
        since = self._hinting_since_sec
        return 0.0 if since is None else now_sec - since

    def state(self) -> dict[str, Any]:
        """Return what a referee wants to know."""
        msg, first = self.latest, self._first
        if msg is None or first is None:
            raise RuntimeError('no pose yet')
        position, twist = msg.pose.pose.position, msg.twist.twist
        place = relative(position.x, position.y, first)
        stamp = msg.header.stamp
        return {
            'time_sec': stamp.sec + stamp.nanosec * 1e-9,
            'place': place,
            'speed_m_s': twist.linear.x,
            'yaw_rate_rad_s': twist.angular.z,
        }
