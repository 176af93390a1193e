# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages in another frame: points, vectors, poses, polygons, covariances and clouds."""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import (
    Point32,
    PointStamped,
    PolygonStamped,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
)
from hypothesis import given, strategies
import numpy as np
from playpen_testing.transforms import NO_TURN, transform
import pytest
from rclpy.duration import Duration
from sensor_msgs.msg import PointField
from sensor_msgs_py.point_cloud2 import (
    create_cloud,
    create_cloud_xyz32,
    read_points,
    read_points_numpy,
)
from std_msgs.msg import Header
import tf2_geometry_msgs
import tf2_ros
import tf2_sensor_msgs

QUARTER = math.sqrt(0.5)
TO_ODOM = transform('odom', 'base', 3.0, (1.0, 2.0, 3.0), (0.0, 0.0, QUARTER, QUARTER))
numbers = strategies.floats(-10.0, 10.0)


def buffer() -> tf2_ros.Buffer:
    found = tf2_ros.Buffer()
    found.set_transform(TO_ODOM, 'test')
    return found


def in_odom(message: Any) -> Any:
    """Let a buffer transform a message of the frame base."""
    message.header = Header(frame_id='base', stamp=TO_ODOM.header.stamp)
    result = buffer().transform(message, 'odom', Duration(seconds=1))
    assert (result.header.frame_id, result.header.stamp.sec) == ('odom', 3)
    assert type(result) is type(message)
    return result


def xyz(at: Any) -> tuple[float, float, float]:
    return (at.x, at.y, at.z)


def test_a_point_is_turned_and_moved() -> None:
    point = PointStamped()
    point.point.x = 5.0
    assert xyz(in_odom(point).point) == pytest.approx((1.0, 7.0, 3.0))


def test_a_vector_is_turned_and_the_transform_stays_as_it_was() -> None:
    vector = Vector3Stamped()
    vector.vector.x = 5.0
    assert xyz(in_odom(vector).vector) == pytest.approx((0.0, 5.0, 0.0))
    given_transform = transform('odom', 'base', 3.0, (1.0, 2.0, 3.0))
    tf2_geometry_msgs.do_transform_vector3(vector, given_transform)
    assert xyz(given_transform.transform.translation) == (1.0, 2.0, 3.0)


def test_a_pose_is_turned_and_moved_and_w_is_not_negative() -> None:
    pose = PoseStamped()
    pose.pose.position.y = 2.0
    pose.pose.orientation.z, pose.pose.orientation.w = 0.8, -0.6
    moved = in_odom(pose).pose
    assert xyz(moved.position) == pytest.approx((-1.0, 2.0, 3.0))
    turn = moved.orientation
    expected = 2.0 * math.atan2(0.8, -0.6) + 0.5 * math.pi
    assert turn.w >= 0.0
    assert math.remainder(2.0 * math.atan2(turn.z, turn.w) - expected, math.tau) == (
        pytest.approx(0.0)
    )


def test_a_pose_without_orientation_gets_that_of_the_transform() -> None:
    pose = PoseStamped()
    pose.pose.orientation.w = 0.0
    turn = in_odom(pose).pose.orientation
    assert (turn.x, turn.y, turn.z, turn.w) == pytest.approx((0.0, 0.0, QUARTER, QUARTER))


def test_a_polygon_has_its_corners_moved() -> None:
    polygon = PolygonStamped()
    polygon.polygon.points = [Point32(x=1.0), Point32(y=1.0)]
    corners = [xyz(point) for point in in_odom(polygon).polygon.points]
    assert corners == [pytest.approx((1.0, 3.0, 3.0)), pytest.approx((0.0, 2.0, 3.0))]


@given(strategies.lists(numbers, min_size=36, max_size=36))
def test_a_covariance_is_that_of_turned_samples(entries: list[float]) -> None:
    root = np.array(entries).reshape(6, 6)
    samples = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    turned = np.vstack([samples @ root[:3], samples @ root[3:]])
    found = tf2_geometry_msgs.transform_covariance((root @ root.T).ravel(), TO_ODOM)
    assert found.shape == (36,)
    assert np.allclose(found.reshape(6, 6), turned @ turned.T, atol=1e-6)


def test_a_pose_with_covariance_has_both_turned() -> None:
    pose = PoseWithCovarianceStamped()
    pose.pose.pose.orientation.w = 1.0
    pose.pose.covariance[0] = 4.0  # of x
    moved = in_odom(pose).pose
    assert xyz(moved.pose.position) == pytest.approx((1.0, 2.0, 3.0))
    assert moved.covariance[7] == pytest.approx(4.0)  # of y
    assert sum(moved.covariance) == pytest.approx(4.0)


def test_messages_convert_to_themselves() -> None:
    point = PointStamped()
    converted = tf2_ros.convert(point, PointStamped)
    assert converted == point
    assert tf2_geometry_msgs.from_msg_msg(tf2_geometry_msgs.to_msg_msg(point)) is point


@pytest.mark.parametrize('by', [TO_ODOM, TO_ODOM.transform])
def test_a_cloud_keeps_what_is_not_its_place(by: Any) -> None:
    fields = [
        PointField(name=name, offset=4 * i, datatype=PointField.FLOAT32, count=1)
        for i, name in enumerate('xyz')
    ]
    fields.append(PointField(name='intensity', offset=12, datatype=PointField.UINT8, count=1))
    header = Header(frame_id='base')
    cloud = create_cloud(header, fields, [(5.0, 0.0, 0.0, 7), (0.0, 0.0, 1.0, 9)], 20)
    before = bytes(cloud.data)
    moved = tf2_sensor_msgs.do_transform_cloud(cloud, by)
    assert moved.header.frame_id == ('odom' if isinstance(by, TransformStamped) else 'base')
    assert (moved.fields, moved.point_step) == (cloud.fields, 20)
    places = read_points_numpy(moved, ['x', 'y', 'z'])
    assert np.allclose(places, [[1.0, 7.0, 3.0], [1.0, 2.0, 4.0]])
    assert read_points(moved)['intensity'].tolist() == [7, 9]
    assert bytes(cloud.data) == before


def test_a_buffer_transforms_clouds() -> None:
    moved = in_odom(create_cloud_xyz32(Header(), [(5.0, 0.0, 0.0)]))
    assert np.allclose(read_points_numpy(moved), [[1.0, 7.0, 3.0]])


def test_a_cloud_without_places_is_refused() -> None:
    field = PointField(name='x', datatype=PointField.FLOAT32, count=1)
    cloud = create_cloud(Header(), [field], [(1.0,)])
    with pytest.raises(AssertionError, match=r'^Point cloud needs the fields x, y, and z for'):
        tf2_sensor_msgs.do_transform_cloud(cloud, transform('a', 'b', rotation=NO_TURN))
