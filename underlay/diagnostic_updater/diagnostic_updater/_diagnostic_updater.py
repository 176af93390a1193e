# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ask tasks once in a period, and publish what they say."""

from __future__ import annotations

import threading
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node

from diagnostic_updater._diagnostic_status_wrapper import DiagnosticStatusWrapper
from diagnostic_updater._tasks import (
    CompositeDiagnosticTask,
    DiagnosticTask,
    Fill,
    filled,
    FunctionDiagnosticTask,
)

__all__ = [
    'CompositeDiagnosticTask',
    'DiagnosticTask',
    'DiagnosticTaskVector',
    'FunctionDiagnosticTask',
    'Updater',
]


class DiagnosticTaskVector:
    """A list of tasks; the lock is held while it changes, and while tasks run."""

    class DiagnosticTaskInternal:
        """A name, and a function that fills a status."""

        def __init__(self, name: str, fn: Fill) -> None:
            self.name = name
            self.fn = fn

        def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
            stat.name = self.name
            return filled(self.name, self.fn, stat)

    def __init__(self) -> None:
        self.tasks: list[DiagnosticTaskVector.DiagnosticTaskInternal] = []
        self.lock = threading.Lock()

    def addedTaskCallback(self, task: DiagnosticTaskInternal) -> None:
        """Do what is to be done when a task is new; nothing here."""

    def add(self, *args: Any) -> None:
        """
        Add a task.

        :param args: a DiagnosticTask, or a name and a function that returns the status that it is
            given.
        """
        if len(args) == 1:
            name, fill = args[0].getName(), args[0].run
        elif len(args) == 2:
            name, fill = args
        else:
            raise TypeError(f'add takes a task, or a name and a function, not {len(args)} values')
        task = self.DiagnosticTaskInternal(name, fill)
        with self.lock:
            self.tasks.append(task)
            self.addedTaskCallback(task)

    def removeByName(self, name: str) -> bool:
        """Remove the first task of this name; return whether there was one."""
        with self.lock:
            for task in self.tasks:
                if task.name == name:
                    self.tasks.remove(task)
                    return True
        return False


class Updater(DiagnosticTaskVector):
    """
    Publishes on /diagnostics what its tasks say, while the node is spun.

    :param node: it gets the parameters diagnostic_updater.period and diagnostic_updater.use_fqn.
    :param period: in s; where the parameter is given that one counts.
    """

    def __init__(self, node: Node, period: float = 1.0) -> None:
        super().__init__()
        self.node = node
        self.publisher = node.create_publisher(DiagnosticArray, '/diagnostics', 1)
        self.period_parameter = 'diagnostic_updater.period'
        self._period = node.declare_parameter(self.period_parameter, period).value
        self.timer = node.create_timer(self._period, self.update)
        self.verbose = False
        self.hwid = ''
        self.warn_nohwid_done = False
        self.use_fqn_parameter = 'diagnostic_updater.use_fqn'
        if not node.has_parameter(self.use_fqn_parameter):
            node.declare_parameter(self.use_fqn_parameter, False)
        self.node_name = node.get_name()
        if node.get_parameter(self.use_fqn_parameter).value:
            # As upstream: in the namespace / it begins with two slashes.
            self.node_name = f'{node.get_namespace()}/{self.node_name}'

    @property
    def period(self) -> float:
        """How long from one message to the next, in s; may be set."""
        return self._period

    @period.setter
    def period(self, period: float) -> None:
        self.node.destroy_timer(self.timer)
        self._period = period
        self.timer = self.node.create_timer(period, self.update)

    def setHardwareID(self, hwid: str) -> None:
        """Set what every status names as its device."""
        self.hwid = hwid

    def force_update(self) -> None:
        """Publish now, not only when it is due."""
        self.update()

    def update(self) -> None:
        """
        Run the tasks, and publish what they say.

        :raises TypeError: a task does not return the status.
        """
        with self.lock:
            statuses = [self._run(task) for task in self.tasks]
        is_bad = [status.level != DiagnosticStatus.OK for status in statuses]
        if not (self.hwid or self.warn_nohwid_done or any(is_bad)):
            self.warn_nohwid_done = True
            self.node.get_logger().warning(
                'diagnostic_updater: No HW_ID was set. Call setHardwareID with a name of the '
                "device, or with 'none' where there is none."
            )
        self.publish(statuses)

    def _run(self, task: DiagnosticTaskVector.DiagnosticTaskInternal) -> DiagnosticStatusWrapper:
        status = task.run(
            DiagnosticStatusWrapper(
                level=DiagnosticStatus.ERROR,
                name=task.name,
                message='No message was set',
                hardware_id=self.hwid,
            )
        )
        if self.verbose and status.level != DiagnosticStatus.OK:
            self.node.get_logger().warning(
                f'Non-zero diagnostic status. Name: {status.name}, status {status.level!r}: '
                f'{status.message}'
            )
        return status

    def broadcast(self, lvl: bytes, msg: str) -> None:
        """Publish one level and message for every task, as before the node ends."""
        statuses = [DiagnosticStatusWrapper(name=task.name) for task in self.tasks]
        for status in statuses:
            status.summary(lvl, msg)
        self.publish(statuses)

    def publish(self, msg: DiagnosticStatus | list[DiagnosticStatus]) -> None:
        """Publish a status, or several in one message, under the name of the node."""
        array = DiagnosticArray()
        array.header.stamp = self.node.get_clock().now().to_msg()
        for status in msg if isinstance(msg, list) else [msg]:
            # Of the type itself: rclpy sends none of a class that derives from it.
            array.status.append(
                DiagnosticStatus(
                    level=status.level,
                    name=f'{self.node_name}: {status.name}',
                    message=status.message,
                    hardware_id=status.hardware_id,
                    values=status.values,
                )
            )
        self.publisher.publish(array)

    def addedTaskCallback(self, task: DiagnosticTaskVector.DiagnosticTaskInternal) -> None:
        """Publish that the node is starting."""
        status = DiagnosticStatusWrapper(name=task.name)
        status.summary(DiagnosticStatus.OK, 'Node starting up')
        self.publish(status)
