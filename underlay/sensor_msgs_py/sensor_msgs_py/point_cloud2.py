# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read and write point clouds as arrays of numpy."""

from __future__ import annotations

import array
from collections import namedtuple
from collections.abc import Iterable, Sequence
import sys
from typing import Any

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured
from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

DUMMY_FIELD_PREFIX = 'unnamed_field'
_DATATYPES: dict[int, np.dtype[Any]] = {
    PointField.INT8: np.dtype(np.int8),
    PointField.UINT8: np.dtype(np.uint8),
    PointField.INT16: np.dtype(np.int16),
    PointField.UINT16: np.dtype(np.uint16),
    PointField.INT32: np.dtype(np.int32),
    PointField.UINT32: np.dtype(np.uint32),
    PointField.FLOAT32: np.dtype(np.float32),
    PointField.FLOAT64: np.dtype(np.float64),
}


def read_points(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Return a structured array of the points, which may be the memory of the message.

    :param field_names: only these fields; None: all.
    :param skip_nans: without points that have a nan, unless the cloud says that it is dense.
    :param uvs: only the points with these numbers.
    :param reshape_organized_cloud: where the cloud has rows, as (width, height).
    :raises AssertionError: not a cloud, or without such a field.
    """
    _require(isinstance(cloud, PointCloud2), 'Cloud is not a sensor_msgs.msg.PointCloud2')
    points: NDArray[Any] = np.ndarray(
        shape=(cloud.width * cloud.height,),
        dtype=dtype_from_fields(cloud.fields, point_step=cloud.point_step),
        buffer=cloud.data,
    )
    if field_names is not None:
        _require(
            set(field_names) <= set(points.dtype.names or ()),
            'Requests field is not in the fields of the PointCloud!',
        )
        points = points[list(field_names)]
    if cloud.is_bigendian != (sys.byteorder != 'little'):
        points = points.byteswap()
    if skip_nans and not cloud.is_dense:
        names = points.dtype.names or ()
        points = points[~np.any([np.isnan(points[name]) for name in names], axis=0)]
    if uvs is not None:
        points = points[uvs if isinstance(uvs, np.ndarray) else np.fromiter(uvs, int)]
    if reshape_organized_cloud and cloud.height > 1:
        points = points.reshape(cloud.width, cloud.height)
    return points


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Return a plain array of fields of one type, a column each; arguments as read_points.

    :raises AssertionError: the fields have several types.
    """
    _require(
        all(
            cloud.fields[0].datatype == field.datatype
            for field in cloud.fields[1:]
            if field_names is None or field.name in field_names
        ),
        'All fields need to have the same datatype. Use `read_points()` otherwise.',
    )
    points = read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud)
    return structured_to_unstructured(points)


def read_points_list(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
) -> list[Any]:
    """Return a named tuple for each point; arguments as read_points, which is faster."""
    _require(isinstance(cloud, PointCloud2), 'cloud is not a sensor_msgs.msg.PointCloud2')
    if field_names is None:
        field_names = [field.name for field in cloud.fields]
    point: Any = namedtuple('Point', field_names)  # type: ignore[misc]  # noqa: PYI024
    return [point._make(each) for each in read_points(cloud, field_names, skip_nans, uvs)]


def dtype_from_fields(
    fields: Iterable[PointField], point_step: int | None = None
) -> np.dtype[Any]:
    """Return the dtype of a point: a field of several values is one field a value, name_0 on.

    :param point_step: bytes from a point to the next; None: the end of the last field.
    :raises AssertionError: two fields have one name, or one has no value.
    """
    names: list[str] = []
    formats: list[str] = []
    offsets: list[int] = []
    for number, field in enumerate(fields):
        datatype = _DATATYPES[field.datatype]
        name = field.name or f'{DUMMY_FIELD_PREFIX}_{number}'
        _require(field.count > 0, "Can't process fields with count = 0.")
        for index in range(field.count):
            single = f'{name}_{index}' if field.count > 1 else name
            _require(single not in names, 'Duplicate field names are not allowed!')
            names.append(single)
            formats.append(datatype.str)
            offsets.append(field.offset + index * datatype.itemsize)
    layout: dict[str, Any] = {'names': names, 'formats': formats, 'offsets': offsets}
    if point_step is not None:
        layout['itemsize'] = point_step
    return np.dtype(layout)  # type: ignore[call-overload, no-any-return]


def create_cloud(
    header: Header,
    fields: Sequence[PointField],
    points: Iterable[Any],
    point_step: int | None = None,
) -> PointCloud2:
    """Make a message of points.

    :param points: a structured array, a plain one where all fields have one type, or rows of
        numbers; with two dimensions of points the cloud has rows.
    :param point_step: bytes from a point to the next; None: the end of the last field.
    :raises AssertionError: points and fields do not fit.
    """
    whole = _structured(points, fields, dtype_from_fields(fields, point_step))
    _require(
        whole.ndim <= 2,
        'Too many dimensions for organized cloud! Points can only be organized in max. two '
        'dimensional space',
    )
    cloud = PointCloud2(
        header=header,
        height=whole.shape[1] if whole.ndim == 2 else 1,
        width=whole.shape[0],
        is_dense=False,
        is_bigendian=sys.byteorder != 'little',
        fields=fields,
        point_step=whole.dtype.itemsize,
        row_step=whole.dtype.itemsize * whole.shape[0],
    )
    # An array is kept as it is; bytes would be looked at one by one.
    cloud.data = array.array('B', whole.tobytes())
    return cloud


def create_cloud_xyz32(header: Header, points: Iterable[Any]) -> PointCloud2:
    """Make a message of points with the fields x, y and z."""
    fields = [
        PointField(name=name, offset=offset, datatype=PointField.FLOAT32, count=1)
        for name, offset in (('x', 0), ('y', 4), ('z', 8))
    ]
    return create_cloud(header, fields, points)


def _structured(
    points: Iterable[Any], fields: Sequence[PointField], dtype: np.dtype[Any]
) -> NDArray[Any]:
    if not isinstance(points, np.ndarray):
        return np.array([tuple(point) for point in points], dtype=dtype)
    if points.dtype.names is not None:
        _require(
            points.dtype == dtype,
            'PointFields and structured NumPy array dtype do not match for all fields! Check '
            'their field order, names and types.',
        )
        return points
    _require(
        all(fields[0].datatype == field.datatype for field in fields[1:]),
        'All fields need to have the same datatype. Pass a structured NumPy array with multiple '
        'dtypes otherwise.',
    )
    structured: NDArray[Any] = unstructured_to_structured(points, dtype=dtype)
    return structured


def _require(holds: bool, otherwise: str) -> None:
    """Refuse as upstream does, also where Python leaves out assertions."""
    if not holds:
        raise AssertionError(otherwise)
