# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The checks, which `ros2 doctor` runs in the order of their entry points' names."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from ros2_diagnosis import connections, nodes, partners, places, remappings, workspaces
from ros2_diagnosis.finding import Finding
from ros2cli import discovery
from ros2doctor.api import DoctorCheck, graph, Result


class _Check(DoctorCheck):
    """Print each finding in one line.

    :param category: what upstream calls that which the check looks at; its name where None.
    """

    def __init__(
        self, name: str, find: Callable[[], Iterable[Finding]], category: str | None = None
    ) -> None:
        self._name = name
        self._find = find
        self._category = category or name

    def category(self) -> str:
        return self._category

    def check(self) -> Result:
        result = Result()
        for finding in self._find():
            print(f'{"problem" if finding.serious else "note"} ({self._name}): {finding}')
            if finding.serious:
                result.add_error()
            else:
                result.add_warning()
        return result


def _types() -> Iterable[Finding]:
    services = [*connections.check_service_types(graph())]
    # An action is named once, not with each of its topics and services.
    named = {finding.where for finding in services}
    for finding in [*connections.check_types(graph()), *services]:
        action, _, part = finding.where.partition('/_action/')
        if not part:
            yield finding
        elif action not in named:
            named.add(action)
            yield finding


def _clock() -> Iterable[Finding]:
    from ros2_doctor_checks import clock

    found = (nodes.check_clock, nodes.check_wall_clock, clock.check_clock_runs)
    return [finding for check in found for finding in check(graph())]


def _partners() -> Iterable[Finding]:
    return [*partners.check_topics(graph()), *partners.check_services(graph())]


def _qos() -> Iterable[Finding]:
    from ros2_doctor_checks import kept

    return [*connections.check_qos(graph()), *kept.check_kept(graph())]


def _commands() -> Iterable[Finding]:
    from ros2_doctor_checks import commands  # rclpy is loaded for this check alone.

    return commands.check_command_rate(graph())


def _answers() -> Iterable[Finding]:
    from ros2_doctor_checks import answers

    return answers.check_answers(graph())


def _lifecycle() -> Iterable[Finding]:
    from ros2_doctor_checks import lifecycle

    return lifecycle.check_lifecycle(graph())


def _frames() -> Iterable[Finding]:
    from ros2_doctor_checks import frames

    return frames.check_frames(graph())


def _parameters() -> Iterable[Finding]:
    from ros2_doctor_checks import parameters

    return parameters.check_parameters(graph())


# What the entry points name: called, each makes its check.
Environment = partial(
    _Check,
    'environment',
    lambda: places.check_environment(discovery.settings_from_environment()),
)
Workspace = partial(
    _Check, 'workspace', lambda: workspaces.check_workspaces(Path.cwd()), 'package'
)
Domain = partial(
    _Check,
    'domain',
    lambda: places.check_domains(discovery.settings_from_environment(), here=len(graph().nodes)),
)
Range = partial(_Check, 'range', lambda: places.check_range(discovery.settings_from_environment()))
Silent = partial(
    _Check,
    'silent',
    lambda: nodes.check_silent(graph(), discovery.settings_from_environment().domain_id),
)
Names = partial(_Check, 'names', lambda: nodes.check_names(graph()))
Publishers = partial(
    _Check,
    'publishers',
    lambda: [
        found
        for check in (nodes.check_publishers, nodes.check_servers, nodes.check_numbers)
        for found in check(graph())
    ],
)
Types = partial(_Check, 'types', _types)
QualityOfService = partial(_Check, 'qos', _qos, 'middleware')
Partners = partial(_Check, 'partners', _partners)
Clock = partial(_Check, 'clock', _clock)
Memory = partial(_Check, 'memory', lambda: nodes.check_memory(graph().nodes), 'middleware')
Vendors = partial(_Check, 'vendors', lambda: nodes.check_vendors(graph()))
Commands = partial(_Check, 'commands', _commands)
Answers = partial(_Check, 'answers', _answers)
Parameters = partial(_Check, 'parameters', _parameters)
Lifecycle = partial(_Check, 'lifecycle', _lifecycle)
Remappings = partial(_Check, 'remappings', lambda: remappings.check_remappings(graph()))
Frames = partial(_Check, 'frames', _frames)
