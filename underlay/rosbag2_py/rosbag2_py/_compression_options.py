# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How a bag is compressed: names of upstream's, of which zstd is the only format."""

from __future__ import annotations

import enum

from rosbag2_py._fields import Field, one, text, whole
from rosbag2_py._log import warn

FORMATS = ('zstd',)


class CompressionMode(enum.Enum):
    """What is compressed: nothing, each file when it is complete, or each message."""

    NONE = 0
    FILE = 1
    MESSAGE = 2

    def __int__(self) -> int:
        return self.value

    __index__ = __int__


class CompressionOptions:
    """
    How a writer compresses.

    :param compression_format: 'zstd', or '' where nothing is compressed.
    :param compression_queue_size: taken, and of no effect, as is the number of threads.
    """

    compression_format = Field(text)
    compression_mode = Field(one(CompressionMode))
    compression_queue_size = Field(whole(64))
    compression_threads = Field(whole(64))

    def __init__(
        self,
        compression_format: str = '',
        compression_mode: CompressionMode = CompressionMode.NONE,
        compression_queue_size: int = 0,
        compression_threads: int = 0,
    ) -> None:
        self.compression_format = compression_format
        self.compression_mode = compression_mode
        self.compression_queue_size = compression_queue_size
        self.compression_threads = compression_threads


def compression_mode_from_string(compression_mode: str, /) -> CompressionMode:
    """Return a mode by its name, in letters of either kind; NONE where there is no such mode."""
    name = compression_mode.upper() or 'NONE'
    if name not in CompressionMode.__members__:
        modes = ', '.join(CompressionMode.__members__)
        warn(f"'{compression_mode}' is no mode of compression, and nothing is compressed: {modes}")
        return CompressionMode.NONE
    return CompressionMode[name]


def compression_mode_to_string(compression_mode: CompressionMode, /) -> str:
    return compression_mode.name
