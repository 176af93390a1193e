# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Topics that show a drive, in the frame `odom`; they have no influence on it.

`path`, `waypoints` and `waypoints_left` are latched; `lookahead_point` is the place on the path
that is steered for.
"""

from geometry_msgs.msg import PointStamped, Pose, PoseArray, PoseStamped
from husky_course.route import Point
from nav_msgs.msg import Path
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import UInt32

from husky_driver.drive.drive import Drive

EVERY = 5  # of the samples of a curve, 2 cm apart
LOOK_AHEAD_SEC = 0.16  # what the tracker allows for delay, and its preview

_KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class DriveDisplay:
    """Publishes one drive."""

    def __init__(self, node: Node, drive: Drive) -> None:
        self._drive = drive
        self._route: object = None
        self._left = -1
        self._path = node.create_publisher(Path, 'path', _KEPT)
        self._waypoints = node.create_publisher(PoseArray, 'waypoints', _KEPT)
        self._waypoints_left = node.create_publisher(UInt32, 'waypoints_left', _KEPT)
        self._look_ahead = node.create_publisher(PointStamped, 'lookahead_point', 1)
        self._point = PointStamped()
        self._point.header.frame_id = 'odom'

    def show(self, drive: Drive) -> None:
        """Change to another drive."""
        self._drive, self._route, self._left = drive, None, -1

    def update(self) -> None:
        """Publish what has changed; call it regularly."""
        drive = self._drive
        if drive.route is not self._route:  # planned from where the robot stands
            self._route = drive.route
            self._publish_course()
        left = drive.total - drive.reached
        if left != self._left:
            self._left = left
            self._waypoints_left.publish(UInt32(data=left))
        if drive.tracker is not None and self._look_ahead.get_subscription_count():
            ahead = drive.tracker.s + LOOK_AHEAD_SEC * abs(drive.speed_m_s)
            self._point.point.x, self._point.point.y = drive.tracker.curve.point_at(ahead)
            self._look_ahead.publish(self._point)

    def _publish_course(self) -> None:
        path = Path()
        path.header.frame_id = 'odom'
        for leg in self._drive.route.legs:
            curve = leg.curve
            xs, ys = [*curve.x[:-1:EVERY], curve.x[-1]], [*curve.y[:-1:EVERY], curve.y[-1]]
            path.poses += [_stamped(point) for point in zip(xs, ys, strict=True)]
        self._path.publish(path)
        stops = PoseArray(poses=[_pose((p.x_m, p.y_m)) for p in self._drive.course.stops])
        stops.header.frame_id = 'odom'
        self._waypoints.publish(stops)


def _pose(point: Point) -> Pose:
    pose = Pose()
    pose.position.x, pose.position.y = point
    return pose


def _stamped(point: Point) -> PoseStamped:
    stamped = PoseStamped(pose=_pose(point))
    stamped.header.frame_id = 'odom'
    return stamped
