# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The checks, which `ros2 doctor` runs in the order of their entry points' names."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable
from functools import cache, partial
from pathlib import Path

from ros2_diagnosis import connections, nodes, places, workspaces
from ros2_diagnosis.finding import Finding
from ros2cli import discovery
from ros2doctor.api import DoctorCheck, Result
from rtps_graph.graph import Graph


class _Check(DoctorCheck):
    """Print each finding in one line."""

    def __init__(self, name: str, find: Callable[[_Check], Iterable[Finding]]) -> None:
        self._name = name
        self._find = find

    def category(self) -> str:
        return self._name

    def check(self) -> Result:
        result = Result()
        for finding in self._find(self):
            print(f'{"problem" if finding.serious else "note"} ({self._name}): {finding}')
            if finding.serious:
                result.add_error()
            else:
                result.add_warning()
        return result

    @property
    def graph(self) -> Graph:
        spin_time_sec = getattr(self.args, 'spin_time', discovery.DEFAULT_SPIN_TIME_SEC)
        return _graph(spin_time_sec)


@cache
def _graph(spin_time_sec: float) -> Graph:
    """Read the graph once for all checks."""
    return discovery.read_graph(argparse.Namespace(spin_time=spin_time_sec), quiet=True)


def _commands(check: _Check) -> Iterable[Finding]:
    from ros2_doctor_checks import commands  # rclpy is loaded for this check alone.

    return commands.check_command_rate(check.graph)


# What the entry points name: called, each makes its check.
Environment = partial(
    _Check,
    'environment',
    lambda _: places.check_environment(discovery.settings_from_environment()),
)
Workspace = partial(_Check, 'workspace', lambda _: workspaces.check_workspaces(Path.cwd()))
Domain = partial(
    _Check,
    'domain',
    lambda check: places.check_domains(
        discovery.settings_from_environment(), here=len(check.graph.nodes)
    ),
)
Range = partial(
    _Check, 'range', lambda _: places.check_range(discovery.settings_from_environment())
)
Silent = partial(
    _Check,
    'silent',
    lambda check: nodes.check_silent(check.graph, discovery.settings_from_environment().domain_id),
)
Names = partial(_Check, 'names', lambda check: nodes.check_names(check.graph))
Publishers = partial(_Check, 'publishers', lambda check: nodes.check_publishers(check.graph))
Types = partial(_Check, 'types', lambda check: connections.check_types(check.graph))
QualityOfService = partial(_Check, 'qos', lambda check: connections.check_qos(check.graph))
Clock = partial(_Check, 'clock', lambda check: nodes.check_clock(check.graph))
Commands = partial(_Check, 'commands', _commands)
