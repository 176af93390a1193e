# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The network interfaces of this computer."""

from __future__ import annotations

import socket

import psutil

from ros2doctor.api import DoctorReport, Report

_NAMES = {socket.AF_INET: 'inet', socket.AF_INET6: 'inet6', psutil.AF_LINK: 'ether'}


class NetworkReport(DoctorReport):
    def category(self) -> str:
        return 'network'

    def report(self) -> Report:
        report = Report('NETWORK CONFIGURATION')
        states = psutil.net_if_stats()
        for device, addresses in psutil.net_if_addrs().items():
            report.add_to_report('device', device)
            for each in addresses:
                report.add_to_report(_NAMES.get(each.family, 'address'), each.address)
                for name, value in (('netmask', each.netmask), ('broadcast', each.broadcast)):
                    if value:
                        report.add_to_report(name, value)
            if device in states:
                report.add_to_report('flags', states[device].flags)
                report.add_to_report('mtu', states[device].mtu)
        return report
