# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which publishers and subscriptions fit together."""

from __future__ import annotations

from typing import Any

from rclpy.qos import qos_check_compatible, QoSCompatibility
from ros2cli.node.direct import DirectNode

from ros2doctor.api import DoctorReport, get_topic_names, Report


class QoSCompatibilityReport(DoctorReport):
    def category(self) -> str:
        return 'middleware'

    def report(self) -> Report:
        report = Report('QOS COMPATIBILITY LIST')
        with DirectNode(None) as node:
            for topic in get_topic_names():
                for publisher in node.get_publishers_info_by_topic(topic):
                    for subscription in node.get_subscriptions_info_by_topic(topic):
                        _add(report, topic, publisher, subscription)
        if not report.items:
            report.add_to_report('compatibility status', 'No publisher/subscriber pairs found')
        return report


def _add(report: Report, topic: str, publisher: Any, subscription: Any) -> None:
    compatibility, reason = qos_check_compatible(publisher.qos_profile, subscription.qos_profile)
    fits = compatibility == QoSCompatibility.OK
    report.add_to_report('topic [type]', f'{topic} [{publisher.topic_type}]')
    report.add_to_report('publisher node', publisher.node_name)
    report.add_to_report('subscriber node', subscription.node_name)
    report.add_to_report('compatibility status', 'OK' if fits else reason)
