# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What every source of transforms can do, and how objects of other packages are transformed."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.time import Time
from std_msgs.msg import Header

Transform = Callable[[Any, TransformStamped], Any]
Conversion = Callable[[Any], Any]


class BufferInterface:
    """Lookups that a Buffer and a BufferClient have, and the transform of whole objects."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self,
        object_stamped: Any,
        target_frame: str,
        timeout: Duration = Duration(),  # noqa: B008 - never changed
        new_type: type | None = None,
    ) -> Any:
        """Return an object as it is in another frame, at the time in its header.

        :param new_type: convert the result to this type.
        :raises TypeException: no package that is imported transforms such objects.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        transform = self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout)
        return _as_type(do_transform(object_stamped, transform), new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Time,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
        new_type: type | None = None,
    ) -> Any:
        """Return an object as it is in another frame at another time.

        :param fixed_frame: what has not moved between the two times.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        transform = self.lookup_transform_full(
            target_frame, target_time, header.frame_id, header.stamp, fixed_frame, timeout
        )
        return _as_type(do_transform(object_stamped, transform), new_type)

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        raise NotImplementedException

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> Any:
        raise NotImplementedException

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> Any:
        raise NotImplementedException


def Stamped(obj: Any, stamp: Any, frame_id: str) -> Any:  # noqa: N802 - upstream's name
    """Give an object a header, and return it."""
    obj.header = Header(frame_id=frame_id, stamp=stamp)
    return obj


class TypeException(Exception):  # noqa: N818 - upstream's name
    """Nobody has registered what is asked for."""

    def __init__(self, errstr: str) -> None:
        self.errstr = errstr


class NotImplementedException(Exception):  # noqa: N818
    """A class derived from BufferInterface lacks a lookup."""

    def __init__(self) -> None:
        self.errstr = 'CanTransform or LookupTransform not implemented'


class TransformRegistration:
    """What transforms an object, by its type; the same for all buffers."""

    __type_map: dict[Any, Transform] = {}

    def print_me(self) -> None:
        print(self.__type_map)

    def add(self, key: Any, callback: Transform) -> None:
        self.__type_map[key] = callback

    def get(self, key: Any) -> Transform:
        """Return what transforms objects of a type.

        :raises TypeException: nothing does.
        """
        return _registered(self.__type_map, key)


class ConvertRegistration:
    """What converts an object from and to its message, or straight to another type."""

    __to_msg_map: dict[Any, Conversion] = {}
    __from_msg_map: dict[Any, Conversion] = {}
    __convert_map: dict[Any, Conversion] = {}

    def add_from_msg(self, key: Any, callback: Conversion) -> None:
        self.__from_msg_map[key] = callback

    def add_to_msg(self, key: Any, callback: Conversion) -> None:
        self.__to_msg_map[key] = callback

    def add_convert(self, key: tuple[Any, Any], callback: Conversion) -> None:
        self.__convert_map[key] = callback

    def get_from_msg(self, key: Any) -> Conversion:
        return _registered(self.__from_msg_map, key)

    def get_to_msg(self, key: Any) -> Conversion:
        return _registered(self.__to_msg_map, key)

    def get_convert(self, key: tuple[Any, Any]) -> Conversion:
        return _registered(self.__convert_map, key)


def convert(a: Any, b_type: Any) -> Any:
    """Return an object as another type: straight where that is registered, else by a message."""
    registered = ConvertRegistration()
    try:
        straight = registered.get_convert((type(a), b_type))
    except TypeException:
        if type(a) is b_type:
            return deepcopy(a)
        to_message = registered.get_to_msg(type(a))
        from_message = registered.get_from_msg(b_type)
        return from_message(to_message(a))
    return straight(a)


def _as_type(result: Any, new_type: type | None) -> Any:
    return result if new_type is None else convert(result, new_type)


def _registered(known: dict[Any, Any], key: Any) -> Any:
    if key not in known:
        raise TypeException(f'Type {key} is not loaded or supported')
    return known[key]
