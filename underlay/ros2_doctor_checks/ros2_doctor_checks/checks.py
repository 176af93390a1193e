# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The checks, which `ros2 doctor` runs in the order of their entry points' names."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
import functools
from pathlib import Path

from ros2_diagnosis import connections, nodes, places, workspaces
from ros2_diagnosis.finding import Finding
from ros2cli import discovery
from ros2cli.settings import settings_from_environment
from ros2doctor.api import DoctorCheck, Result
from rtps_graph.graph import Graph


class _Check(DoctorCheck):
    """Print each finding in one line."""

    NAME = ''

    def category(self) -> str:
        return self.NAME

    def findings(self) -> Iterable[Finding]:
        raise NotImplementedError()

    def check(self) -> Result:
        result = Result()
        for finding in self.findings():
            print(f'{"problem" if finding.serious else "note"} ({self.NAME}): {finding}')
            if finding.serious:
                result.add_error()
            else:
                result.add_warning()
        return result

    @property
    def graph(self) -> Graph:
        spin_time_sec = getattr(self.args, 'spin_time', discovery.DEFAULT_SPIN_TIME_SEC)
        return _graph(spin_time_sec)


@functools.cache
def _graph(spin_time_sec: float) -> Graph:
    """Read the graph once for all checks."""
    return discovery.read_graph(argparse.Namespace(spin_time=spin_time_sec), quiet=True)


class Environment(_Check):
    NAME = 'environment'

    def findings(self) -> Iterable[Finding]:
        return places.check_environment(settings_from_environment())


class Workspace(_Check):
    NAME = 'workspace'

    def findings(self) -> Iterable[Finding]:
        return workspaces.check_workspaces(Path.cwd())


class Domain(_Check):
    NAME = 'domain'

    def findings(self) -> Iterable[Finding]:
        return places.check_domains(settings_from_environment(), here=len(self.graph.nodes))


class Range(_Check):
    NAME = 'range'

    def findings(self) -> Iterable[Finding]:
        return places.check_range(settings_from_environment())


class Silent(_Check):
    NAME = 'silent'

    def findings(self) -> Iterable[Finding]:
        return nodes.check_silent(self.graph, settings_from_environment().domain_id)


class Names(_Check):
    NAME = 'names'

    def findings(self) -> Iterable[Finding]:
        return nodes.check_names(self.graph)


class Publishers(_Check):
    NAME = 'publishers'

    def findings(self) -> Iterable[Finding]:
        return nodes.check_publishers(self.graph)


class Types(_Check):
    NAME = 'types'

    def findings(self) -> Iterable[Finding]:
        return connections.check_types(self.graph)


class QualityOfService(_Check):
    NAME = 'qos'

    def findings(self) -> Iterable[Finding]:
        return connections.check_qos(self.graph)


class Clock(_Check):
    NAME = 'clock'

    def findings(self) -> Iterable[Finding]:
        return nodes.check_clock(self.graph)


class Commands(_Check):
    NAME = 'commands'

    def findings(self) -> Iterable[Finding]:
        from ros2_doctor_checks import commands  # rclpy is loaded for this check alone.

        return commands.check_command_rate(self.graph)
