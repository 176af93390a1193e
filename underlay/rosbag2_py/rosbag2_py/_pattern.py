# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Expressions that choose topics."""

from __future__ import annotations

import re

from rosbag2_py.errors import BagError

EVENTS = '/_service_event'
"""Ends the names of the topics that tell what a service does."""


def pattern(text: str) -> re.Pattern[str] | None:
    """
    Compile an expression; None where none is given.

    :raises BagError: it is none.
    """
    try:
        return re.compile(text) if text else None
    except re.error as error:
        raise BagError(f"'{text}' is no regular expression: {error}") from None
