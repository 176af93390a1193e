# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Watches the graph of a live run: the true pose, and how the controller publishes commands."""

import time
from typing import Any

from husky_driver.checks import no_rotation, OdometryCheck
from husky_driver.motion import Odometry, relative_odometry
from husky_driver.ros import read_odometry
from nav_msgs.msg import Odometry as OdometryMsg
import rclpy
from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy

WANTED_TYPE = 'geometry_msgs/msg/Twist'
VELOCITY_TYPES = (WANTED_TYPE, 'geometry_msgs/msg/TwistStamped')
COMMAND_TOPIC = '/husky_velocity_controller/cmd_vel'
OWN_NODES = ('husky_sim', 'grader')


class Watcher(Node):
    """Keeps the newest true pose, relative to the first, and hints about the controller."""

    def __init__(self, context: rclpy.Context) -> None:
        super().__init__('grader', context=context)
        self.latest: Odometry | None = None
        self.count = 0
        self.hints: list[str] = []
        self.refused = ''  # why a pose cannot be true; after it none is taken
        self._check = OdometryCheck()
        self._hinting_since_sec: float | None = None
        self._first: Odometry | None = None
        self._poses = self.create_subscription(OdometryMsg, 'ground_truth/odom', self._on_pose, 10)

    def _on_pose(self, msg: OdometryMsg) -> None:
        if self.refused:
            return
        pose = read_odometry(msg)
        if what := no_rotation(msg.pose.pose.orientation) or self._check.complaint(pose):
            topic = self._poses.topic_name
            count = self.count_publishers(topic)
            self.refused = f'{topic} cannot be true: {what}' + (
                f'; {count} nodes publish it: does the controller start a simulator of its own?'
                if count > 1
                else ''
            )
            return
        self._first = self._first or pose
        self.latest = relative_odometry(pose, self._first)
        self.count += 1

    def check_graph(self) -> None:
        """Look at the graph; hints are kept, because nodes may come and go."""
        hints = self._wrong_commands()
        if not hints:
            self._hinting_since_sec = None
        elif self._hinting_since_sec is None:
            self._hinting_since_sec = time.monotonic()
        self.hints = hints or self.hints

    def _wrong_commands(self) -> list[str]:
        """Return what is wrong with how the controller publishes commands."""
        if publishers := self._theirs(COMMAND_TOPIC):
            return [hint for info in publishers for hint in _wrong(info)]
        return [
            f'it publishes {velocity[0]} on {name}; the Husky listens on {COMMAND_TOPIC}'
            for name, kinds in sorted(self.get_topic_names_and_types())
            if (velocity := [kind for kind in kinds if kind in VELOCITY_TYPES])
            and name != COMMAND_TOPIC
            and self._theirs(name)
        ]

    def _theirs(self, topic: str) -> list[Any]:
        """Return the publishers of a topic that are the controller's."""
        infos = self.get_publishers_info_by_topic(topic)
        return [info for info in infos if info.node_name not in OWN_NODES]

    def hinting_sec(self, now_sec: float) -> float:
        """Return since when, until now, every look at the graph has found something wrong."""
        since = self._hinting_since_sec
        return 0.0 if since is None else now_sec - since

    def state(self) -> dict[str, Any]:
        """Return the arguments of `Referee.over` that the newest pose gives."""
        now = self.latest
        if now is None:
            raise RuntimeError('no pose yet')
        return {
            'time_sec': now.time_sec,
            'place': (now.x_m, now.y_m),
            'speed_m_s': now.speed_m_s,
            'yaw_rate_rad_s': now.yaw_rate_rad_s,
        }


def _wrong(info: Any) -> list[str]:
    kind, hints = info.topic_type, []
    if kind != WANTED_TYPE:
        hints.append(f'it publishes {kind} on {COMMAND_TOPIC}; the Husky takes {WANTED_TYPE}')
    if info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT:
        hints.append(
            f'it publishes {COMMAND_TOPIC} best effort; the Husky listens reliably and hears '
            'nothing'
        )
    return hints
