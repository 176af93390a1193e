# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Take point clouds into another frame; who imports this has them known to `Buffer.transform`."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import Transform, TransformStamped
import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured
from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud2
from sensor_msgs_py.point_cloud2 import create_cloud, read_points
from std_msgs.msg import Header
from tf2_py.motions import matrix_of, normalized
from tf2_ros import ConvertRegistration, TransformRegistration

_AXES = ['x', 'y', 'z']


def transform_points(point_cloud: NDArray[Any], transform: Transform) -> NDArray[Any]:
    """Turn and move points, one a row."""
    turn, to = transform.rotation, transform.translation
    matrix = np.array(matrix_of(normalized((turn.x, turn.y, turn.z, turn.w))))
    moved: NDArray[Any] = point_cloud @ matrix.T + (to.x, to.y, to.z)
    return moved


def do_transform_cloud(cloud: PointCloud2, transform: Transform | TransformStamped) -> PointCloud2:
    """Return a cloud with x, y and z as they are in the other frame; its other fields stay.

    :param transform: one with a header tells the name of the other frame.
    """
    header = Header(stamp=cloud.header.stamp, frame_id=cloud.header.frame_id)
    if isinstance(transform, TransformStamped):
        header.frame_id = transform.header.frame_id
        transform = transform.transform
    if not set(_AXES) <= {field.name for field in cloud.fields}:
        raise AssertionError('Point cloud needs the fields x, y, and z for the transformation')
    points = read_points(cloud).copy()  # what was read is the memory of the message
    moved = transform_points(structured_to_unstructured(points[_AXES]), transform)
    for column, axis in enumerate(_AXES):
        points[axis] = moved[:, column]
    return create_cloud(header, cloud.fields, points, cloud.point_step)


def to_msg_msg(msg: Any) -> Any:
    return msg


def from_msg_msg(msg: Any) -> Any:
    return msg


TransformRegistration().add(PointCloud2, do_transform_cloud)
ConvertRegistration().add_to_msg(PointCloud2, to_msg_msg)
ConvertRegistration().add_from_msg(PointCloud2, from_msg_msg)
