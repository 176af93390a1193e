# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How a node says on /diagnostics whether it, its device and its topics are well."""

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from diagnostic_updater._diagnostic_status_wrapper import DiagnosticStatusWrapper
from diagnostic_updater._diagnostic_updater import DiagnosticTaskVector, Updater
from diagnostic_updater._publisher import (
    DiagnosedPublisher,
    HeaderlessTopicDiagnostic,
    TopicDiagnostic,
)
from diagnostic_updater._tasks import (
    CompositeDiagnosticTask,
    DiagnosticTask,
    FunctionDiagnosticTask,
)
from diagnostic_updater._update_functions import (
    FrequencyStatus,
    FrequencyStatusParam,
    Heartbeat,
    TimeStampStatus,
    TimeStampStatusParam,
)

__all__ = [
    'CompositeDiagnosticTask',
    'DiagnosedPublisher',
    'DiagnosticArray',
    'DiagnosticStatus',
    'DiagnosticStatusWrapper',
    'DiagnosticTask',
    'DiagnosticTaskVector',
    'FrequencyStatus',
    'FrequencyStatusParam',
    'FunctionDiagnosticTask',
    'HeaderlessTopicDiagnostic',
    'Heartbeat',
    'KeyValue',
    'TimeStampStatus',
    'TimeStampStatusParam',
    'TopicDiagnostic',
    'Updater',
]
