# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Matchers of processes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:
    from ...actions import ExecuteLocal


def _matcher(holds: Callable[[dict[str, Any]], bool]) -> Callable[[ExecuteLocal], bool]:
    """Return a predicate on the details of the process, which an action has once executed."""
    return lambda action: action.process_details is not None and holds(action.process_details)


def matches_pid(pid: int) -> Callable[[ExecuteLocal], bool]:
    return _matcher(lambda details: details.get('pid') == pid)


def matches_name(name: str) -> Callable[[ExecuteLocal], bool]:
    """Return a predicate on the name that launch gave, as ``talker-1``."""
    return _matcher(lambda details: bool(details['name'] == name))


def matches_executable(executable: str) -> Callable[[ExecuteLocal], bool]:
    """Return a predicate on the end of the path of the executable, as ``ls`` or ``/bin/ls``."""
    return _matcher(lambda details: bool(details['cmd'][0].endswith(executable)))
