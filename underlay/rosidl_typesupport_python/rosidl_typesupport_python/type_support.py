# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The type supports of messages, services and actions: the structs that rcl and rmw are given.

Their layouts are those of rosidl_runtime_c and rosidl_typesupport_fastrtps_cpp. Each has behind it
what the functions of native.c return for it: the struct description there.
"""

from __future__ import annotations

import ctypes
from functools import partial
from typing import Any

from rosidl_typesupport_python.cdr import Codec, codec_of, type_name
from rosidl_typesupport_python.descriptions import Description
from rosidl_typesupport_python.introspection import handle_of, identifier, members
from rosidl_typesupport_python.memory import capsule, keep, keep_function, table, text
from rosidl_typesupport_python.native import address, CodecStruct, functions, Message
from rosidl_typesupport_python.shapes import shape_of

_FAST_RTPS = 'rosidl_typesupport_fastrtps_c'
_INTROSPECTION = 'rosidl_typesupport_introspection_c'


_COMPLAINT = (
    'Bytes that are not those of {name} came, and were dropped: build the sender and this program '
    'from the same definition (told once)\n'
)


class MessageSupport:
    """What is asked for of a class of messages, as capsules and as addresses."""

    def __init__(self, kind: Any, description: Description) -> None:
        self.codec: Codec = codec_of(kind)
        complaint = text(_COMPLAINT.format(name=type_name(kind)))
        self._codec = keep(
            CodecStruct(self.codec.encode, self.codec.decode, shape_of(kind), complaint)
        )
        self.members = members(kind, ctypes.sizeof(Message))
        self.introspected = _support(
            'message', _INTROSPECTION, self.members, (), (None, *description)
        )
        names = (text('::'.join(kind.__module__.split('.')[:2])), text(kind.__name__))
        callbacks = ('serialize', 'deserialize', 'serialized_size', 'max_serialized_size')
        self.handle = _support(
            'message',
            _FAST_RTPS,
            table(*names, *map(_native, callbacks), None),
            (),
            (self.introspected, *description),
        )
        new = ctypes.CFUNCTYPE(ctypes.c_void_p)(partial(functions().new_message, self._codec))
        self.capsules = {
            'create_ros_message': capsule(keep_function(new)),
            'destroy_ros_message': capsule(_native('destroy_message')),
            'convert_from_py': capsule(_native('convert_from_py')),
            'convert_to_py': capsule(_native('convert_to_py')),
            'type_support': capsule(self.handle),
        }

    def new_message(self, data: bytes) -> int:
        """
        Return the address of a message that consists of these bytes.

        :raises MemoryError: if there is no room for it.
        """
        new = functions().new_message(self._codec)
        if not new or not functions().set_data(new, data, len(data)):
            functions().destroy_message(new)
            raise MemoryError(f'{len(data)} bytes')
        return int(new)


class _EventInfo(ctypes.Structure):
    """rosidl_service_introspection_info_t."""

    _fields_ = [
        ('event_type', ctypes.c_uint8),
        ('stamp_sec', ctypes.c_int32),
        ('stamp_nanosec', ctypes.c_uint32),
        ('client_gid', ctypes.c_uint8 * 16),
        ('sequence_number', ctypes.c_int64),
    ]


_NewEvent = ctypes.CFUNCTYPE(
    ctypes.c_void_p,
    ctypes.POINTER(_EventInfo),
    ctypes.c_void_p,
    ctypes.POINTER(Message),
    ctypes.POINTER(Message),
)


class ServiceSupport:
    """
    What is asked for of a class of services.

    :param parts: the supports of its request, response and event.
    """

    def __init__(
        self, kind: Any, parts: tuple[MessageSupport, ...], description: Description
    ) -> None:
        self._event = kind.Event
        self._parts = parts
        package, folder = kind.__module__.split('.')[:2]
        name = text(kind.__name__)
        events = (keep_function(_NewEvent(self._new_event)), _native('destroy_event'))
        introspected = _support(
            'service',
            _INTROSPECTION,
            table(text(f'{package}__{folder}'), name, *(part.members for part in parts)),
            (*(part.introspected for part in parts), *events),
            (None, *description),
        )
        self.handle = _support(
            'service',
            _FAST_RTPS,
            table(text(f'{package}::{folder}'), name, parts[0].handle, parts[1].handle),
            (*(part.handle for part in parts), *events),
            (introspected, *description),
        )
        self.capsules = {'type_support': capsule(self.handle)}

    def _new_event(self, info: Any, _allocator: int, request: Any, response: Any) -> int:
        """Make the message that tells of a request or a response, see `ros2 service echo`."""
        from service_msgs.msg import ServiceEventInfo

        told = ServiceEventInfo(event_type=info[0].event_type)
        told.stamp.sec = info[0].stamp_sec
        told.stamp.nanosec = info[0].stamp_nanosec
        told.client_gid = list(info[0].client_gid)
        told.sequence_number = info[0].sequence_number
        event = self._event(info=told)
        if request:
            event.request = [self._parts[0].codec.decode(request[0].bytes)]
        if response:
            event.response = [self._parts[1].codec.decode(response[0].bytes)]
        return self._parts[2].new_message(self._parts[2].codec.encode(event))


class ActionSupport:
    """What is asked for of a class of actions."""

    def __init__(self, kind: Any, description: Description) -> None:
        parts = (
            kind.Impl.SendGoalService,
            kind.Impl.GetResultService,
            kind.Impl.CancelGoalService,
            kind.Impl.FeedbackMessage,
            kind.Impl.GoalStatusMessage,
        )
        getters = (_native(f'action_{what}') for what in ('hash', 'type', 'sources'))
        self.handle = table(*map(handle_of, parts), *getters, None, *description)
        self.capsules = {'type_support': capsule(self.handle)}


def _support(
    kind: str,
    library: str,
    data: int,
    parts: tuple[int, ...],
    description: tuple[int | None, int, int, int],
) -> int:
    """Return the address of a rosidl_message_type_support_t or rosidl_service_type_support_t."""
    getters = (_native(f'{kind}_{what}') for what in ('hash', 'type', 'sources'))
    find = _native(f'{kind}_find')
    return table(identifier(library), data, find, *parts, *getters, *description)


def _native(name: str) -> int:
    return address(functions(), name)
