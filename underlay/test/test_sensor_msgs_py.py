# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Point clouds: every type and layout there and back, selections, refusals."""

from __future__ import annotations

import sys
from typing import Any

from hypothesis import given, strategies
import numpy as np
import pytest
from sensor_msgs.msg import PointCloud2, PointField
from sensor_msgs_py import point_cloud2
from std_msgs.msg import Header

HEADER = Header(frame_id='laser')
TYPES = {
    PointField.INT8: 'i1',
    PointField.UINT8: 'u1',
    PointField.INT16: 'i2',
    PointField.UINT16: 'u2',
    PointField.INT32: 'i4',
    PointField.UINT32: 'u4',
    PointField.FLOAT32: 'f4',
    PointField.FLOAT64: 'f8',
}
ROWS = [(0.0, 0.5, 1.0), (2.0, float('nan'), 3.0), (4.0, 4.5, 5.0), (6.0, 6.5, 7.0)]
layouts = strategies.lists(
    strategies.tuples(strategies.sampled_from(sorted(TYPES)), strategies.integers(1, 3)),
    min_size=1,
    max_size=5,
)


def fields_of(layout: list[tuple[int, int]], gap: int = 0) -> list[PointField]:
    fields, offset = [], 0
    for number, (datatype, count) in enumerate(layout):
        fields.append(PointField(name=f'f{number}', offset=offset, datatype=datatype, count=count))
        offset += count * np.dtype(TYPES[datatype]).itemsize + gap
    return fields


def xyz() -> PointCloud2:
    return point_cloud2.create_cloud_xyz32(HEADER, ROWS)


@given(layouts, strategies.integers(0, 3), strategies.data())
def test_what_is_written_is_read(
    layout: list[tuple[int, int]], gap: int, data: strategies.DataObject
) -> None:
    fields = fields_of(layout, gap)
    values = strategies.tuples(
        *[strategies.integers(0, 100) for _, count in layout for _ in range(count)]
    )
    rows = data.draw(strategies.lists(values, max_size=5))
    cloud = point_cloud2.create_cloud(HEADER, fields, rows)
    assert (cloud.height, cloud.width) == (1, len(rows))
    assert cloud.row_step == cloud.point_step * len(rows) == len(cloud.data)
    points = point_cloud2.read_points(cloud)
    assert [tuple(point) for point in points.tolist()] == rows
    names = [
        f'f{i}_{j}' if count > 1 else f'f{i}'
        for i, (_, count) in enumerate(layout)
        for j in range(count)
    ]
    assert list(points.dtype.names or ()) == names
    assert point_cloud2.create_cloud(HEADER, fields, points, cloud.point_step) == cloud


def test_fields_and_points_are_selected() -> None:
    cloud = xyz()
    assert point_cloud2.read_points(cloud, ['z', 'x']).tolist()[0] == (1.0, 0.0)
    assert len(point_cloud2.read_points(cloud, skip_nans=True)) == 3
    assert len(point_cloud2.read_points(cloud, ['x', 'z'], skip_nans=True)) == 4
    assert point_cloud2.read_points(cloud, uvs=iter([3, 0]))['x'].tolist() == [6.0, 0.0]
    assert point_cloud2.read_points_numpy(cloud, uvs=np.array([2])).tolist() == [[4.0, 4.5, 5.0]]
    cloud.is_dense = True  # says that it has no nan, and is believed
    assert len(point_cloud2.read_points(cloud, skip_nans=True)) == 4


def test_a_list_has_named_tuples() -> None:
    first, *_ = point_cloud2.read_points_list(xyz(), ('x', 'z'))
    assert (first.x, first.z, len(first)) == (0.0, 1.0, 2)
    assert point_cloud2.read_points_list(xyz())[2]._fields == ('x', 'y', 'z')


def test_a_cloud_with_rows_keeps_its_shape() -> None:
    grid = np.arange(18, dtype=np.float32).reshape(2, 3, 3)
    cloud = point_cloud2.create_cloud_xyz32(HEADER, grid)
    assert (cloud.width, cloud.height, cloud.row_step) == (2, 3, 24)
    assert point_cloud2.read_points_numpy(cloud).shape == (6, 3)
    again = point_cloud2.read_points_numpy(cloud, reshape_organized_cloud=True)
    assert np.array_equal(again, grid)


def test_the_other_byte_order_is_read_twice_alike() -> None:
    cloud = xyz()
    swapped = np.frombuffer(bytes(cloud.data), dtype='u4').byteswap().tobytes()
    cloud.data, cloud.is_bigendian = swapped, sys.byteorder == 'little'
    for _ in range(2):
        assert point_cloud2.read_points_numpy(cloud, ['x']).ravel().tolist() == [0, 2, 4, 6]


def test_fields_without_a_name_get_one() -> None:
    fields = [PointField(name='', offset=0, datatype=PointField.UINT8, count=2)]
    assert point_cloud2.dtype_from_fields(fields).names == (
        'unnamed_field_0_0',
        'unnamed_field_0_1',
    )
    assert point_cloud2.dtype_from_fields(fields, point_step=8).itemsize == 8


MIXED = fields_of([(PointField.UINT8, 1), (PointField.FLOAT32, 1)])


@pytest.mark.parametrize(
    ('call', 'said'),
    [
        (lambda: point_cloud2.read_points(HEADER), 'Cloud is not a sensor_msgs.msg.PointCloud2'),
        (
            lambda: point_cloud2.read_points_list(HEADER),
            'cloud is not a sensor_msgs.msg.PointCloud2',
        ),
        (
            lambda: point_cloud2.read_points(xyz(), ['w']),
            'Requests field is not in the fields of the PointCloud!',
        ),
        (
            lambda: point_cloud2.read_points_numpy(
                point_cloud2.create_cloud(HEADER, MIXED, [(1, 2.0)])
            ),
            'All fields need to have the same datatype. Use `read_points()` otherwise.',
        ),
        (
            lambda: point_cloud2.create_cloud(HEADER, MIXED, np.zeros((2, 2))),
            'All fields need to have the same datatype. Pass a structured NumPy array with '
            'multiple dtypes otherwise.',
        ),
        (
            lambda: point_cloud2.create_cloud(HEADER, MIXED, np.zeros(2, dtype='f4,f4')),
            'PointFields and structured NumPy array dtype do not match for all fields! Check '
            'their field order, names and types.',
        ),
        (
            lambda: point_cloud2.create_cloud_xyz32(HEADER, np.zeros((2, 2, 2, 3))),
            'Too many dimensions for organized cloud! Points can only be organized in max. two '
            'dimensional space',
        ),
        (
            lambda: point_cloud2.dtype_from_fields([*MIXED, MIXED[0]]),
            'Duplicate field names are not allowed!',
        ),
        (
            lambda: point_cloud2.dtype_from_fields([PointField(name='x', datatype=7)]),
            "Can't process fields with count = 0.",
        ),
    ],
)
def test_what_does_not_fit_is_refused(call: Any, said: str) -> None:
    with pytest.raises(AssertionError) as caught:
        call()
    assert str(caught.value) == said
