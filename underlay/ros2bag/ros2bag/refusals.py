# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a bag refuses, as a command says it: in one line."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ros2cli.errors import CommandError
from rosbag2_py.errors import BagError


@contextmanager
def refused_in_one_line() -> Iterator[None]:
    """Make a CommandError of a BagError; also a decorator."""
    try:
        yield
    except BagError as error:
        raise CommandError(str(error)) from None
