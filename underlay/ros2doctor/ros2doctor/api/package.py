# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The packages that are installed, and their versions."""

from __future__ import annotations

from pathlib import Path
import re

from ros2_diagnosis import packages

from ros2doctor.api import DoctorReport, Report

_VERSION = re.compile(r'<version[^>]*>\s*([^<\s]+)')


class PackageReport(DoctorReport):
    """Tells the local versions; upstream's asks the network for the latest ones besides."""

    def category(self) -> str:
        return 'package'

    def report(self) -> Report:
        report = Report('PACKAGE VERSIONS')
        for name, prefix in packages.installed().items():
            source = packages.source_of(name)
            place = f', source={source}' if source else ''
            report.add_to_report(name, f'local={_version(prefix / "share" / name)}{place}')
        return report


def _version(share: Path) -> str:
    try:
        match = _VERSION.search((share / 'package.xml').read_text(encoding='utf-8'))
    except OSError:
        return 'unknown'
    return match[1] if match else 'unknown'
