# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The fields of a type as rmw_fastrtps_cpp reads them, to announce the type to other DDS programs.

The structs are those of rosidl_typesupport_introspection_c. rmw looks at names and types alone:
no functions and no places of fields are given, for there is no struct that has them.
"""

from __future__ import annotations

import ctypes
from functools import cache
from pathlib import Path
import sys
from typing import Any

from rosidl_parser import definition as idl

from rosidl_typesupport_python.cdr import class_of
from rosidl_typesupport_python.memory import keep, pointer_in, text

# field_types.h
_TYPE_IDS = {
    **{'float': 1, 'double': 2, 'boolean': 6, 'octet': 7, 'uint8': 8, 'int8': 9, 'uint16': 10},
    **{'int16': 11, 'uint32': 12, 'int32': 13, 'uint64': 14, 'int64': 15},
}
_STRING, _WSTRING, _MESSAGE = 16, 17, 18


class _Member(ctypes.Structure):
    _fields_ = [
        ('name', ctypes.c_void_p),
        ('type_id', ctypes.c_uint8),
        ('string_upper_bound', ctypes.c_size_t),
        ('members', ctypes.c_void_p),
        ('is_key', ctypes.c_bool),
        ('is_array', ctypes.c_bool),
        ('array_size', ctypes.c_size_t),
        ('is_upper_bound', ctypes.c_bool),
        ('offset', ctypes.c_uint32),
        ('default_value', ctypes.c_void_p),
        ('functions', ctypes.c_void_p * 6),
    ]


class _Members(ctypes.Structure):
    _fields_ = [
        ('message_namespace', ctypes.c_void_p),
        ('message_name', ctypes.c_void_p),
        ('member_count', ctypes.c_uint32),
        ('size_of', ctypes.c_size_t),
        ('has_any_key_member', ctypes.c_bool),
        ('members', ctypes.c_void_p),
        ('init_and_fini', ctypes.c_void_p * 2),
    ]


def members(kind: Any, size: int) -> int:
    """
    Return the address of the MessageMembers of a class of messages.

    :param size: of the message in memory.
    """
    package, folder = kind.__module__.split('.')[:2]
    slots = list(zip(kind.get_fields_and_field_types(), kind.SLOT_TYPES, strict=True))
    fields = [_member(name, slot) for name, slot in slots] or [
        _Member(text(idl.EMPTY_STRUCTURE_REQUIRED_MEMBER_NAME), _TYPE_IDS['uint8'])
    ]
    array = (_Member * len(fields))(*fields)
    name, namespace = text(kind.__name__), text(f'{package}__{folder}')
    return keep(_Members(namespace, name, len(fields), size, False, keep(array)))


def _member(name: str, slot: Any) -> _Member:
    member = _Member(text(name))
    if isinstance(slot, idl.AbstractNestedType):
        member.is_array = True
        member.is_upper_bound = isinstance(slot, idl.BoundedSequence)
        member.array_size = getattr(slot, 'size', getattr(slot, 'maximum_size', 0))
        slot = slot.value_type
    if isinstance(slot, idl.NamespacedType):
        member.type_id = _MESSAGE
        member.members = _of_message(handle_of(class_of(slot)))
    elif isinstance(slot, idl.BasicType):
        member.type_id = _TYPE_IDS[slot.typename]
    else:
        member.type_id = _WSTRING if isinstance(slot, idl.AbstractWString) else _STRING
        member.string_upper_bound = getattr(slot, 'maximum_size', 0)
    return member


def handle_of(kind: Any) -> int:
    """Return the address of the type support of a class of a message, service or action."""
    if kind.__class__._TYPE_SUPPORT is None:
        kind.__class__.__import_type_support__()
    return pointer_in(kind.__class__._TYPE_SUPPORT)


def _of_message(handle: int) -> int:
    find = _runtime().get_message_typesupport_handle
    find.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    find.restype = ctypes.c_void_p
    return int(find(handle, identifier('rosidl_typesupport_introspection_c')))


@cache
def _runtime() -> ctypes.CDLL:
    return ctypes.CDLL(str(Path(sys.prefix, 'lib', 'librosidl_runtime_c.so')))


@cache
def identifier(library: str) -> int:
    """Return the address of the text by which a kind of type support is asked for."""
    loaded = ctypes.CDLL(str(Path(sys.prefix, 'lib', f'lib{library}.so')))
    return ctypes.c_void_p.in_dll(loaded, f'{library}__identifier').value or 0
