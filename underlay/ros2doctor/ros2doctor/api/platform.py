# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What this computer and its ROS are."""

from __future__ import annotations

import os
import platform
import sys

from ros2_diagnosis import packages
from ros2cli import discovery

from ros2doctor.api import DoctorReport, Report


class PlatformReport(DoctorReport):
    def category(self) -> str:
        return 'platform'

    def report(self) -> Report:
        report = Report('PLATFORM INFORMATION')
        report.add_to_report('system', platform.system())
        report.add_to_report('platform info', platform.platform())
        report.add_to_report('release', platform.release())
        report.add_to_report('processor', platform.machine())
        report.add_to_report('python', f'{platform.python_version()} ({sys.executable})')
        return report


class RosdistroReport(DoctorReport):
    """Tells what the environment says; upstream's asks the index of distributions besides."""

    def category(self) -> str:
        return 'platform'

    def report(self) -> Report:
        settings = discovery.settings_from_environment()
        report = Report('ROS 2 INFORMATION')
        report.add_to_report('distribution name', os.environ.get('ROS_DISTRO', 'jazzy'))
        report.add_to_report('domain id', settings.domain_id)
        report.add_to_report('discovery range', settings.discovery_range)
        report.add_to_report('prefixes', os.pathsep.join(map(str, packages.prefixes())))
        return report
