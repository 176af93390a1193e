# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Watches the graph of a live run: the true pose, and how the controller publishes commands."""

from __future__ import annotations

from collections.abc import Sequence
import time
from typing import Any

from husky_course.frames import to_odom
from husky_driver.checks import no_rotation, OdometryCheck
from husky_driver.motion import yaw_of
from husky_driver.ros import read_odometry
from nav_msgs.msg import Odometry
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
        self._first: tuple[float, float, float] | None = None
        self._poses = self.create_subscription(Odometry, 'ground_truth/odom', self._on_pose, 10)

    def _on_pose(self, msg: Odometry) -> None:
        if self.refused:
            return
        what = no_rotation(msg.pose.pose.orientation) or self._check.complaint(read_odometry(msg))
        if what:
            topic = self._poses.topic_name
            count = self.count_publishers(topic)
            self.refused = f'{topic} cannot be true: {what}' + (
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

    def check_graph(self) -> None:
        """Look at the graph; hints are kept, because nodes may come and go."""
        hints = _hints(self, COMMAND_TOPIC, OWN_NODES)
        if not hints:
            self._hinting_since_sec = None
        elif self._hinting_since_sec is None:
            self._hinting_since_sec = time.monotonic()
        self.hints = hints or self.hints

    def hinting_sec(self, now_sec: float) -> float:
        """Return since when, until now, every look at the graph has found something wrong."""
        since = self._hinting_since_sec
        return 0.0 if since is None else now_sec - since

    def state(self) -> dict[str, Any]:
        """Return the arguments of `Referee.over` that the newest pose gives."""
        msg, first = self.latest, self._first
        if msg is None or first is None:
            raise RuntimeError('no pose yet')
        position, twist = msg.pose.pose.position, msg.twist.twist
        place = to_odom(first, position.x, position.y)
        stamp = msg.header.stamp
        return {
            'time_sec': stamp.sec + stamp.nanosec * 1e-9,
            'place': place,
            'speed_m_s': twist.linear.x,
            'yaw_rate_rad_s': twist.angular.z,
        }


def _hints(node: Node, topic: str, own: Sequence[str]) -> list[str]:
    """
    Return what is wrong with how commands are published, seen from a node in the same graph.

    :param topic: where the robot listens, fully qualified.
    :param own: names of the nodes that are not the controller's.
    """
    publishers = [info for info in node.get_publishers_info_by_topic(topic) if _is_its(info, own)]
    hints = [hint for info in publishers for hint in _wrong(info, topic)]
    if publishers:
        return hints
    elsewhere = _elsewhere(node, topic, own)
    return [
        f'it publishes {kind} on {name}; the Husky listens on {topic}' for name, kind in elsewhere
    ]


def _is_its(info: Any, own: Sequence[str]) -> bool:
    return info.node_name not in own


def _wrong(info: Any, topic: str) -> list[str]:
    hints = []
    if info.topic_type != WANTED_TYPE:
        hints.append(f'it publishes {info.topic_type} on {topic}; the Husky takes {WANTED_TYPE}')
    if info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT:
        hints.append(
            f'it publishes {topic} best effort; the Husky listens reliably and hears nothing'
        )
    return hints


def _elsewhere(node: Node, topic: str, own: Sequence[str]) -> list[tuple[str, str]]:
    found = []
    for name, kinds in sorted(node.get_topic_names_and_types()):
        velocity = [kind for kind in kinds if kind in VELOCITY_TYPES]
        if name != topic and velocity:
            infos = node.get_publishers_info_by_topic(name)
            if any(_is_its(info, own) for info in infos):
                found.append((name, velocity[0]))
    return found
