# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""All checks, in the order in which a person would make them."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from ros2cli import discovery
from ros2cli.diagnosis import connections, nodes, places, workspaces
from ros2cli.diagnosis.finding import Finding
from ros2cli.settings import settings_from_environment


@dataclass(frozen=True)
class Check:
    name: str
    title: str
    run: Callable[[], Iterable[Finding]]


def checks(args: argparse.Namespace) -> list[Check]:
    """List the checks; the graph is read once, before the first that needs it."""
    settings = settings_from_environment()
    graph = discovery.read_graph(args, quiet=True)

    def command_rate() -> Iterator[Finding]:
        from ros2cli.diagnosis import commands  # rclpy is loaded for this check alone.

        return commands.check_command_rate(graph)

    return [
        Check('environment', 'settings', lambda: places.check_environment(settings)),
        Check('workspace', 'workspaces', lambda: workspaces.check_workspaces(Path.cwd())),
        Check('domain', 'domains', lambda: places.check_domains(settings, here=len(graph.nodes))),
        Check('range', 'discovery range', lambda: places.check_range(settings)),
        Check('silent', 'processes', lambda: nodes.check_silent(graph, settings.domain_id)),
        Check('names', 'node names', lambda: nodes.check_names(graph)),
        Check('publishers', 'rival publishers', lambda: nodes.check_publishers(graph)),
        Check('types', 'topic types', lambda: connections.check_types(graph)),
        Check('qos', 'quality of service', lambda: connections.check_qos(graph)),
        Check('clock', 'simulation time', lambda: nodes.check_clock(graph)),
        Check('commands', 'velocity commands', command_rate),
    ]
