# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The functions of native.c, loaded, and checked against the Fast CDR that is installed."""

from __future__ import annotations

import ctypes
from functools import cache
from pathlib import Path
import sys

LIBRARY = Path(sys.prefix, 'lib', 'librosidl_typesupport_python.so')

_FAST_CDR = 'libfastcdr.so.2'
# bool Cdr::jump(size_t); char * Cdr::get_current_position()
_JUMP = '_ZN8eprosima7fastcdr3Cdr4jumpEm'
_POSITION = '_ZN8eprosima7fastcdr3Cdr20get_current_positionEv'
# FastBuffer(char *, size_t); Cdr(FastBuffer &, Endianness, CdrVersion)
_NEW_BUFFER = '_ZN8eprosima7fastcdr10FastBufferC1EPcm'
_NEW_CDR = '_ZN8eprosima7fastcdr3CdrC1ERNS0_10FastBufferENS1_10EndiannessENS0_10CdrVersionE'
_LITTLE_ENDIAN = 1
_XCDR1 = 1
_ROOM_FOR_AN_OBJECT = 4096


class UnknownLayoutError(ImportError):
    """What is installed is not what the functions of native.c were written for."""


@cache
def functions() -> ctypes.CDLL:
    """
    Return the functions.

    :raises UnknownLayoutError: if they cannot be used with the Fast CDR of this installation.
    """
    try:
        fast_cdr = ctypes.CDLL(str(Path(sys.prefix, 'lib', _FAST_CDR)))
        library = ctypes.CDLL(str(LIBRARY))
    except OSError as error:
        raise UnknownLayoutError(
            f'the type support of messages made here cannot be loaded: {error}; '
            'remove .venv of the lab and call ./lab again'
        ) from None
    library.new_message.argtypes = [ctypes.c_void_p]
    library.new_message.restype = ctypes.c_void_p
    library.destroy_message.argtypes = [ctypes.c_void_p]
    library.set_data.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t]
    for function in (library.set_data, library.serialize, library.deserialize):
        function.restype = ctypes.c_bool
    try:
        pointers = (ctypes.c_void_p * 2).in_dll(library, 'fast_cdr')
        for i, name in enumerate((_JUMP, _POSITION)):
            pointers[i] = address(fast_cdr, name)
        fits = _round_trip(library, fast_cdr)
    except AttributeError:
        fits = False
    if not fits:
        raise UnknownLayoutError(
            f'{_FAST_CDR} is not that of Fast CDR 2.2, which the type support of messages made '
            'here was written for: install the versions in requirements/ of the lab'
        )
    return library


def address(library: ctypes.CDLL, name: str) -> int:
    """Return where a function is."""
    return ctypes.cast(getattr(library, name), ctypes.c_void_p).value or 0


class Shape(ctypes.Structure):
    """struct shape of native.c."""

    _fields_ = [
        ('size', ctypes.c_uint),
        ('has_length', ctypes.c_bool),
        ('count', ctypes.c_size_t),
        ('items', ctypes.c_void_p),
    ]


class CodecStruct(ctypes.Structure):
    """struct codec of native.c."""

    _fields_ = [
        ('encode', ctypes.py_object),
        ('decode', ctypes.py_object),
        ('shape', ctypes.c_void_p),
        ('complaint', ctypes.c_void_p),
        ('has_complained', ctypes.c_bool),
    ]


class Message(ctypes.Structure):
    """struct message of native.c."""

    _fields_ = [
        ('codec', ctypes.c_void_p),
        ('data', ctypes.c_void_p),
        ('size', ctypes.c_size_t),
        ('capacity', ctypes.c_size_t),
    ]

    @property
    def bytes(self) -> bytes:
        return ctypes.string_at(self.data, self.size)


def _round_trip(library: ctypes.CDLL, fast_cdr: ctypes.CDLL) -> bool:
    """Write bytes into a buffer of Fast CDR and read what follows them in it."""
    header, following = b'\0\1\0\0', b'what follows'
    stream = ctypes.create_string_buffer(b'....' + following, 4 + len(following))
    buffer = ctypes.create_string_buffer(_ROOM_FOR_AN_OBJECT)
    cdr = ctypes.create_string_buffer(_ROOM_FOR_AN_OBJECT)
    getattr(fast_cdr, _NEW_BUFFER)(buffer, stream, ctypes.c_size_t(len(stream)))
    getattr(fast_cdr, _NEW_CDR)(cdr, buffer, _LITTLE_ENDIAN, _XCDR1)
    # what the structs of native.c say: the buffer's place in a Cdr, data and size in a buffer
    found = [
        ctypes.c_size_t.from_buffer(*place).value
        for place in ((cdr, 112), (buffer, 8), (buffer, 16))
    ]
    if found != [ctypes.addressof(buffer), ctypes.addressof(stream), len(stream)]:
        return False
    shape = (Shape * 2)(Shape(1, False, len(following)))
    codec = CodecStruct(shape=ctypes.addressof(shape), has_complained=True)
    message = Message.from_address(library.new_message(ctypes.byref(codec)))
    try:
        written = library.set_data(ctypes.byref(message), header, 4) and library.serialize(
            ctypes.byref(message), cdr
        )
        read = library.deserialize(cdr, ctypes.byref(message))
        return bool(written and read) and stream.raw[:4] + message.bytes == header + following
    finally:
        library.destroy_message(ctypes.addressof(message))
