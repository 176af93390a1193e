# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Matchers of processes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...actions import ExecuteLocal


def matches_pid(pid: int) -> Callable[[ExecuteLocal], bool]:
    def matcher(action: ExecuteLocal) -> bool:
        details = action.process_details
        return details is not None and details.get('pid') == pid

    return matcher


def matches_name(name: str) -> Callable[[ExecuteLocal], bool]:
    """Return a predicate on the name that launch gave, as ``talker-1``."""

    def matcher(action: ExecuteLocal) -> bool:
        details = action.process_details
        return details is not None and bool(details['name'] == name)

    return matcher


def matches_executable(executable: str) -> Callable[[ExecuteLocal], bool]:
    """Return a predicate on the last part of the path of the executable."""

    def matcher(action: ExecuteLocal) -> bool:
        details = action.process_details
        return details is not None and Path(details['cmd'][0]).name == executable

    return matcher
