# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What a type tells of itself: its hash, its description and its source (REP-2011, REP-2016).

The structs are those of rosidl_runtime_c, type_hash.h and type_description/.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import ctypes
from functools import cache
import json
from pathlib import Path
from typing import Any

from rosidl_typesupport_python.memory import keep, text

Description = tuple[int, int, int]
"""The addresses of a type's hash, description and sources."""

_HASH_PREFIX = 'RIHS01_'


class _String(ctypes.Structure):
    _fields_ = [
        ('data', ctypes.c_void_p),
        ('size', ctypes.c_size_t),
        ('capacity', ctypes.c_size_t),
    ]


class _FieldType(ctypes.Structure):
    _fields_ = [
        ('type_id', ctypes.c_uint8),
        ('capacity', ctypes.c_uint64),
        ('string_capacity', ctypes.c_uint64),
        ('nested_type_name', _String),
    ]


class _Field(ctypes.Structure):
    _fields_ = [('name', _String), ('type', _FieldType), ('default_value', _String)]


class _Sequence(ctypes.Structure):
    _fields_ = _String._fields_


class _IndividualTypeDescription(ctypes.Structure):
    _fields_ = [('type_name', _String), ('fields', _Sequence)]


class _TypeDescription(ctypes.Structure):
    _fields_ = [
        ('type_description', _IndividualTypeDescription),
        ('referenced_type_descriptions', _Sequence),
    ]


class _TypeSource(ctypes.Structure):
    _fields_ = [('type_name', _String), ('encoding', _String), ('raw_file_contents', _String)]


class _TypeHash(ctypes.Structure):
    _fields_ = [('version', ctypes.c_uint8), ('value', ctypes.c_uint8 * 32)]


class Descriptions:
    """
    The descriptions of an interface and its parts.

    :param share: the folder share/PACKAGE of the prefix that the interface is in.
    :param interface: msg/Num, srv/AddTwoInts or action/Fibonacci.
    """

    def __init__(self, share: Path, interface: str) -> None:
        self._shares = share.parent
        self._interface = f'{share.name}/{interface}'
        content = json.loads((share / f'{interface}.json').read_text(encoding='utf-8'))
        message = content['type_description_msg']
        self._types: dict[str, Mapping[str, Any]] = {
            one['type_name']: one
            for one in (message['type_description'], *message['referenced_type_descriptions'])
        }
        self._hashes = {one['type_name']: one['hash_string'] for one in content['type_hashes']}

    def addresses(self, name: str) -> Description:
        """
        Return the addresses of a type's hash, description and sources.

        :param name: of the interface, or of a part of it: P/srv/AddTwoInts_Request.
        """
        value = bytes.fromhex(self._hashes[name].removeprefix(_HASH_PREFIX))
        type_hash = _TypeHash(1, (ctypes.c_uint8 * 32)(*value))
        referenced = self._referenced(name)
        description = _TypeDescription(
            _individual(self._types[name]),
            _sequence([_individual(self._types[other]) for other in referenced]),
        )
        sources = _sequence([self._source(one) for one in (name, *referenced)])
        return keep(type_hash), keep(description), keep(sources)

    def _referenced(self, name: str) -> list[str]:
        """Return the names of all types that a type consists of, in their order."""
        found: set[str] = set()
        waiting = [name]
        while waiting:
            for field in self._types[waiting.pop()]['fields']:
                other = field['type']['nested_type_name']
                if other and other not in found:
                    found.add(other)
                    waiting.append(other)
        return sorted(found)

    def _source(self, name: str) -> _TypeSource:
        encoding, content = _source_of(self._shares, name)
        return _TypeSource(_string(name), _string(encoding), _string(content))


@cache
def _source_of(shares: Path, name: str) -> tuple[str, str]:
    """Return how a type was written, and the text; a part of a service has none of its own."""
    package, kind, stem = name.split('/')
    for encoding in (kind, 'idl'):
        for folder in (shares / package, _share_of(package)):
            path = folder / kind / f'{stem}.{encoding}'
            if path.is_file():
                return encoding, path.read_text(encoding='utf-8', errors='replace')
    return 'implicit', ''


@cache
def _share_of(package: str) -> Path:
    from ament_index_python import get_package_share_directory

    return Path(get_package_share_directory(package))


def _string(value: str) -> _String:
    size = len(value.encode())
    return _String(text(value), size, size + 1)


def _sequence(items: Sequence[ctypes.Structure]) -> _Sequence:
    if not items:
        return _Sequence(None, 0, 0)
    return _Sequence(keep((type(items[0]) * len(items))(*items)), len(items), len(items))


def _individual(description: Mapping[str, Any]) -> _IndividualTypeDescription:
    fields = [
        _Field(
            _string(field['name']),
            _FieldType(
                field['type']['type_id'],
                field['type']['capacity'],
                field['type']['string_capacity'],
                _string(field['type']['nested_type_name']),
            ),
            _string(field['default_value']),
        )
        for field in description['fields']
    ]
    return _IndividualTypeDescription(_string(description['type_name']), _sequence(fields))
