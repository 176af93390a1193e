# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Blocks of numbers and of JSON, one after the other in one file.

Each is what numpy.save writes (the .npy format, numpy/lib/format.py): numbers as float64, JSON as
the bytes of its text. Who stops in the middle of a block leaves all those before it whole.
"""

from collections.abc import Iterator
import io
import json
import math
import os
from tokenize import TokenError
from typing import Any, BinaryIO
from warnings import catch_warnings, simplefilter

import numpy as np

_HEADER_BYTES = 128  # of a block with so few dimensions
_KINDS = (np.dtype('<f8'), np.dtype('|u1'))


def block_of(content: Any) -> bytes:
    """Return the block of an array of float64, or of anything else as JSON."""
    if not isinstance(content, np.ndarray):
        text = json.dumps(content, allow_nan=False, separators=(',', ':'))
        content = np.frombuffer(text.encode(), dtype=np.uint8)
    buffer = io.BytesIO()
    np.save(buffer, content, allow_pickle=False)
    return buffer.getvalue()


def read_blocks(stream: BinaryIO) -> Iterator[Any]:
    """
    Yield arrays of float64, and what was written as JSON; a block that is cut off is the end.

    :raises ValueError: at something else than such a block.
    """
    size = os.fstat(stream.fileno()).st_size
    while size - stream.tell() >= _HEADER_BYTES:
        shape, dtype = _read_header(stream)
        count = math.prod(shape)
        if count * dtype.itemsize > size - stream.tell():
            return
        array = np.fromfile(stream, dtype=dtype, count=count)
        yield array.reshape(shape) if dtype == _KINDS[0] else _parsed(array.tobytes())


def _read_header(stream: BinaryIO) -> tuple[tuple[int, ...], np.dtype[Any]]:
    where = stream.tell()
    try:
        if np.lib.format.read_magic(stream) != (1, 0):
            raise ValueError('another version of the .npy format')
        with catch_warnings():
            simplefilter('error')  # numpy warns of headers that only Python 2 wrote
            shape, fortran_order, dtype = np.lib.format.read_array_header_1_0(stream)
    except (ValueError, TypeError, SyntaxError, TokenError, RecursionError, Warning) as error:
        raise ValueError(f'no block of a record at byte {where}') from error
    if fortran_order or dtype not in _KINDS or any(length < 0 for length in shape):
        raise ValueError(f'no block of a record at byte {where}')
    return shape, dtype


def _parsed(text: bytes) -> Any:
    try:
        return json.loads(text)
    except RecursionError as error:
        raise ValueError('JSON nested too deeply') from error
