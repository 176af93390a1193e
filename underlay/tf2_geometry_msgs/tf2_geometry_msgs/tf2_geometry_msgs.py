# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Take messages of geometry into another frame.

Who imports this has them known to `tf2_ros.Buffer.transform`. The header of a result is that of
the transform.
"""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import (
    Point,
    Point32,
    PointStamped,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
)
import numpy as np
from numpy.typing import ArrayLike, NDArray
from tf2_py.motions import compose, matrix_of, Motion, NO_ROTATION, normalized, rotate
from tf2_ros import ConvertRegistration, TransformRegistration


def do_transform_point(point: PointStamped, transform: TransformStamped) -> PointStamped:
    """Return where a point is in the other frame."""
    moved = compose(_motion_of(transform), Motion(NO_ROTATION, _coordinates(point.point)))
    result = PointStamped(header=transform.header)
    result.point.x, result.point.y, result.point.z = moved.translation
    return result


def do_transform_vector3(vector3: Vector3Stamped, transform: TransformStamped) -> Vector3Stamped:
    """Return a vector as the other frame sees it: turned, not moved."""
    turned = rotate(_motion_of(transform).rotation, _coordinates(vector3.vector))
    result = Vector3Stamped(header=transform.header)
    result.vector.x, result.vector.y, result.vector.z = turned
    return result


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    """Return a pose as it is in the other frame, with w of its quaternion not negative."""
    orientation = _quaternion(pose.orientation)
    moved = compose(_motion_of(transform), Motion(orientation, _coordinates(pose.position)))
    sign = -1.0 if moved.rotation[3] < 0.0 else 1.0
    result = Pose()
    to, turn = result.position, result.orientation
    to.x, to.y, to.z = moved.translation
    turn.x, turn.y, turn.z, turn.w = (sign * component for component in moved.rotation)
    return result


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """Return a pose as it is in the other frame."""
    return PoseStamped(header=transform.header, pose=do_transform_pose(pose.pose, transform))


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    """Return a pose and how sure it is, as they are in the other frame."""
    result = PoseWithCovarianceStamped(header=transform.header)
    result.pose.pose = do_transform_pose(pose.pose.pose, transform)
    result.pose.covariance = transform_covariance(pose.pose.covariance, transform)
    return result


def do_transform_polygon_stamped(
    polygon: PolygonStamped, transform: TransformStamped
) -> PolygonStamped:
    """Return a polygon as it is in the other frame."""
    result = PolygonStamped(header=transform.header)
    for corner in polygon.polygon.points:
        at = PointStamped(point=Point(x=corner.x, y=corner.y, z=corner.z))
        moved = do_transform_point(at, transform).point
        result.polygon.points.append(Point32(x=moved.x, y=moved.y, z=moved.z))
    return result


def transform_covariance(cov_in: ArrayLike, transform: TransformStamped) -> NDArray[np.float64]:
    """Turn a covariance of position and rotation: 36 numbers, row by row."""
    turn = np.zeros((6, 6))
    turn[:3, :3] = turn[3:, 3:] = matrix_of(_motion_of(transform).rotation)
    covariance = np.asarray(cov_in, dtype=np.float64).reshape(6, 6)
    return (turn @ covariance @ turn.T).ravel()


def to_msg_msg(msg: Any) -> Any:
    return msg


def from_msg_msg(msg: Any) -> Any:
    return msg


def _motion_of(transform: TransformStamped) -> Motion:
    parts = transform.transform
    return Motion(_quaternion(parts.rotation), _coordinates(parts.translation))


def _coordinates(at: Any) -> tuple[float, float, float]:
    return (at.x, at.y, at.z)


def _quaternion(turn: Any) -> tuple[float, float, float, float]:
    return normalized((turn.x, turn.y, turn.z, turn.w))


def _register() -> None:
    transforms = TransformRegistration()
    transforms.add(PointStamped, do_transform_point)
    transforms.add(Vector3Stamped, do_transform_vector3)
    transforms.add(PoseStamped, do_transform_pose_stamped)
    transforms.add(PoseWithCovarianceStamped, do_transform_pose_with_covariance_stamped)
    transforms.add(PolygonStamped, do_transform_polygon_stamped)
    conversions = ConvertRegistration()
    for message in (Vector3Stamped, PoseStamped, PointStamped):
        conversions.add_to_msg(message, to_msg_msg)
        conversions.add_from_msg(message, from_msg_msg)


_register()
