# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What C reads of a type, in memory that stays until the process ends.

Threads of the middleware read it, and may do so after Python has cleared its modules.
"""

from __future__ import annotations

import ctypes
from typing import Any

_capsule_new = ctypes.pythonapi.PyCapsule_New
_capsule_new.restype = ctypes.py_object
_capsule_new.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
_capsule_pointer = ctypes.pythonapi.PyCapsule_GetPointer
_capsule_pointer.restype = ctypes.c_void_p
_capsule_pointer.argtypes = [ctypes.py_object, ctypes.c_char_p]


def keep(thing: Any) -> int:
    """Keep an object of ctypes for ever, and return its address."""
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(thing))
    return ctypes.addressof(thing)


def keep_function(function: Any) -> int:
    """Keep a function that C calls for ever, and return its address."""
    keep(function)
    return ctypes.cast(function, ctypes.c_void_p).value or 0


def table(*addresses: int | None) -> int:
    """Return the address of a struct that has nothing but pointers."""
    return keep((ctypes.c_void_p * len(addresses))(*addresses))


def text(value: str) -> int:
    """Return the address of a string of C."""
    return keep(ctypes.create_string_buffer(value.encode()))


def capsule(pointer: int) -> Any:
    """Return a pointer as rclpy takes it: a capsule without a name."""
    return _capsule_new(pointer, None, None)


def pointer_in(a_capsule: Any) -> int:
    """Return what a capsule holds."""
    return int(_capsule_pointer(a_capsule, None))
