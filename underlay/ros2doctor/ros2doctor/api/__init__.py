# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What checks and reports of `ros2 doctor` are.

Packages register theirs in the entry point groups 'ros2doctor.checks' and 'ros2doctor.report'.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import cache, partial
import time
from typing import Any

from entry_point_index import entry_points, load
from ros2cli import discovery
from ros2cli.errors import UsageError
from rtps_graph.graph import Graph

from ros2doctor.api.format import doctor_warn

_MADE_WITHIN_SEC = 2.0
"""Programs with DDS but without ROS have topics and never a node."""


@dataclass
class Result:
    """How many errors and warnings a check has found; it prints them itself."""

    error: int = 0
    warning: int = 0

    def add_error(self) -> None:
        self.error += 1

    def add_warning(self) -> None:
        self.warning += 1


class Report:
    """A list of what is so, under a title."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.items: list[tuple[str, Any]] = []

    def add_to_report(self, item_name: str, item_info: Any) -> None:
        self.items.append((item_name, item_info))


class DoctorCheck:
    """Base of a check."""

    def category(self) -> str:
        raise NotImplementedError()

    def check(self) -> Result:
        raise NotImplementedError()


class DoctorReport:
    """Base of a report; it is shown where checks of its category have failed."""

    def category(self) -> str:
        raise NotImplementedError()

    def report(self) -> Report:
        raise NotImplementedError()


def run_checks(
    *, include_warnings: bool = False, exclude_packages: bool = False
) -> tuple[set[str], int, int]:
    """Run the checks in the order of the names of their entry points.

    :param exclude_packages: leave out what looks at packages.
    :return: the categories of what failed, how many failed, how many there are.
    """
    graph.cache_clear()
    categories: set[str] = set()
    failed = total = 0
    for name, check in _made('ros2doctor.checks', exclude_packages=exclude_packages):
        for result in _answer(name, check.check):
            total += 1
            if result.error or (include_warnings and result.warning):
                failed += 1
                categories.add(check.category())
    return categories, failed, total


def generate_reports(
    *, categories: Collection[str] | None = None, exclude_packages: bool = False
) -> list[Report]:
    """Make the reports of some categories; None and an empty collection mean all."""
    graph.cache_clear()
    return [
        report
        for name, each in _made('ros2doctor.report', exclude_packages=exclude_packages)
        if not categories or each.category() in categories
        for report in _answer(name, each.report)
    ]


@cache
def graph() -> Graph:
    """Read the graph once for all checks, or all reports.

    A node that is being made is waited for: for a moment others know its topics without its name.
    """
    end = time.monotonic() + _MADE_WITHIN_SEC
    found = discovery.read_graph(quiet=True)
    while not _names_all(found) and time.monotonic() < end:
        found = discovery.read_graph(quiet=True)
    return found


def _names_all(found: Graph) -> bool:
    of_nodes = {endpoint.guid for node in found.nodes for endpoint in node.endpoints}
    return all(endpoint.guid in of_nodes for endpoint in found.endpoints)


def get_topic_names(skip_topics: Iterable[str] = ()) -> list[str]:
    skipped = set(skip_topics)
    return [name for name in graph().topics() if name not in skipped]


def _made(group: str, *, exclude_packages: bool) -> Iterator[tuple[str, Any]]:
    """Yield what packages have registered; a warning is printed for what cannot be made."""
    for name, target in sorted(entry_points(group).items()):
        for each in _answer(name, partial(_make, target)):
            if not (exclude_packages and each.category() == 'package'):
                yield name, each


def _make(target: str) -> Any:
    return load(target)()


def _answer(name: str, function: Callable[[], Any]) -> Iterator[Any]:
    """Yield what a plugin returns; where it fails, only a warning: the others may do."""
    try:
        answer = function()
    except UsageError:
        raise  # The environment is wrong, for all of them.
    except Exception as error:
        doctor_warn(f"'{name}' of ros2 doctor fails: {type(error).__name__}: {error}")
    else:
        yield answer
