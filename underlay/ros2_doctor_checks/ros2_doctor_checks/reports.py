# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `ros2 doctor --report` shows of the graph besides topics."""

from __future__ import annotations

from ros2doctor.api import DoctorReport, graph, Report


class NodeReport(DoctorReport):
    def category(self) -> str:
        return 'names'

    def report(self) -> Report:
        report = Report('NODE LIST')
        for node in graph().nodes:
            report.add_to_report('node', node.full_name)
        return report


class ServiceReport(DoctorReport):
    def category(self) -> str:
        return 'types'

    def report(self) -> Report:
        report = Report('SERVICE LIST')
        for name, types in graph().services().items():
            report.add_to_report(name, ', '.join(types))
        return report
