# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The middleware."""

from __future__ import annotations

from rclpy.utilities import get_rmw_implementation_identifier

from ros2doctor.api import DoctorReport, Report


class RMWReport(DoctorReport):
    def category(self) -> str:
        return 'middleware'

    def report(self) -> Report:
        report = Report('RMW MIDDLEWARE')
        report.add_to_report('middleware name', get_rmw_implementation_identifier())
        return report
