# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Topics that only one side uses."""

from __future__ import annotations

from rtps_graph.graph import Role

from ros2doctor.api import DoctorCheck, DoctorReport, get_topic_names, graph, Report, Result
from ros2doctor.api.format import doctor_warn

SKIP_TOPICS = ['/parameter_events', '/rosout']


class TopicCheck(DoctorCheck):
    """Looks for publishers without subscribers, and subscribers without publishers."""

    def category(self) -> str:
        return 'topic'

    def check(self) -> Result:
        counts = {name: _counts(name) for name in get_topic_names(SKIP_TOPICS)}
        unheard = [name for name, (_, subscribers) in counts.items() if not subscribers]
        unfed = [name for name, (publishers, _) in counts.items() if not publishers]
        for what, names in (
            ('Publisher without subscriber', unheard),
            ('Subscriber without publisher', unfed),
        ):
            if names:
                doctor_warn(f'{what} detected on {", ".join(names)}')
        return Result(warning=len(unheard) + len(unfed))


class TopicReport(DoctorReport):
    def category(self) -> str:
        return 'topic'

    def report(self) -> Report:
        report = Report('TOPIC LIST')
        for name in get_topic_names(SKIP_TOPICS):
            _add(report, name, *_counts(name))
        if not report.items:
            _add(report, 'none', 0, 0)
        return report


def _counts(topic: str) -> tuple[int, int]:
    known = graph()
    publishers = known.with_role(Role.PUBLISHER, topic)
    return len(publishers), len(known.with_role(Role.SUBSCRIPTION, topic))


def _add(report: Report, topic: str, publishers: int, subscribers: int) -> None:
    report.add_to_report('topic', topic)
    report.add_to_report('publisher count', publishers)
    report.add_to_report('subscriber count', subscribers)
