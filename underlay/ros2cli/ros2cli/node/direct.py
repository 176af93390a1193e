# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node of a command that takes part in the graph: hidden, and gone when the command ends."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
import math
import os
import signal
import sys
import threading
import time
from typing import Any

import rclpy
from rclpy.exceptions import InvalidNodeNameException, NotInitializedException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rtps_graph import names

from ros2cli import calls, discovery
from ros2cli.discovery import add_direct_arguments as add_arguments
from ros2cli.errors import CommandError
from ros2cli.node import NODE_NAME_PREFIX

__all__ = ['DEFAULT_TIMEOUT', 'CommandNode', 'DirectNode', 'add_arguments', 'command_node']

DEFAULT_TIMEOUT = discovery.DEFAULT_SPIN_TIME_SEC


class _Executor(SingleThreadedExecutor):
    """An executor that lets go without a traceback, too, where a signal came amid its making."""

    _sigint_gc = None  # rclpy's own, which it makes late and asks for in any case


class CommandNode:
    """A node with its executor.

    :param interrupted: where it is set, the next spin raises KeyboardInterrupt; None: rclpy
        handles the signals, and shuts ROS down at once.
    """

    def __init__(
        self,
        args: Any,
        *,
        node_name: str | None = None,
        interrupted: threading.Event | None = None,
        **options: Any,
    ) -> None:
        discovery.settings_from_environment()
        handled = SignalHandlerOptions.ALL if interrupted is None else SignalHandlerOptions.NO
        rclpy.init(args=getattr(args, 'argv', []), signal_handler_options=handled)
        self._interrupted = interrupted or threading.Event()
        use_sim_time = Parameter('use_sim_time', value=bool(getattr(args, 'use_sim_time', False)))
        overrides = [use_sim_time, *options.pop('parameter_overrides', ())]
        options = {'enable_rosout': False, 'start_parameter_services': False, **options}
        try:
            with _ended_by_signals():
                self.node = Node(
                    node_name or f'{names.COMMAND_NODE}{os.getpid()}',
                    use_global_arguments=False,
                    parameter_overrides=overrides,
                    **options,
                )
                self._executor = _Executor()
                self._executor.add_node(self.node)
        except InvalidNodeNameException as error:
            rclpy.try_shutdown()
            raise CommandError(' '.join(str(error).split())) from None
        discovery.signal_checks.append(self._check_signals)

    def _check_signals(self) -> None:
        """Raise KeyboardInterrupt where a signal has come; that is heard once."""
        if self._interrupted.is_set() or not rclpy.ok():
            self._interrupted.clear()
            raise KeyboardInterrupt

    def spin_once(self, timeout_sec: float | None = None) -> None:
        with _ended_by_signals():
            self._executor.spin_once(timeout_sec)

    def spin_until(self, done: Callable[[], bool], timeout_sec: float | None = None) -> bool:
        """Spin until `done()`; False where `timeout_sec` passed before that."""
        end = math.inf if timeout_sec is None else time.monotonic() + timeout_sec
        while not done():
            left_sec = end - time.monotonic()  # asked once: below 0 rclpy would wait for ever
            if left_sec <= 0.0:
                return False
            self._check_signals()
            self.spin_once(min(0.02, left_sec))
        return True

    def found(self, service: str) -> AbstractContextManager[None]:
        """Call a service in the context of this, when its server has found the client here."""
        return calls.found(self.node, [service], self.spin_until)

    def spin_until_answered(
        self,
        future: Any,
        service: str,
        is_offered: Callable[[], bool],
        timeout_sec: float | None = None,
    ) -> bool:
        """Spin until a service has answered; where it never will, or is late, say so on stderr.

        :returns: False where `timeout_sec` passed before that.
        """
        end = math.inf if timeout_sec is None else time.monotonic() + timeout_sec

        def has_ended() -> bool:
            return future.done() or time.monotonic() >= end

        def is_over() -> bool:
            return has_ended() or not is_offered()

        if self.spin_until(has_ended, discovery.SOON_SEC):
            return bool(future.done())
        why = discovery.why_unanswered([service]).get(service)
        if why is None and not self.spin_until(is_over, calls.TIMEOUT_SEC):
            why = calls.no_answer(service)
        if why is not None:
            print(f'hint: {why}', file=sys.stderr)
        self.spin_until(is_over)
        # What a server sent at its end may be on its way.
        if not self.spin_until(has_ended, discovery.SOON_SEC):
            print(f'hint: {calls.no_server(service)}; Ctrl-C ends the waiting', file=sys.stderr)
            self.spin_until(has_ended)
        return bool(future.done())

    def destroy(self) -> None:
        if self._check_signals in discovery.signal_checks:
            discovery.signal_checks.remove(self._check_signals)
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown()


class DirectNode(CommandNode):
    """The node as upstream's verbs use it: it has what the node has, and knows the others.

    :param args: may hold what upstream's verbs set: `node_name_suffix`, `spin_time`,
        `start_parameter_services`, `start_type_description_service`, `use_sim_time`, `argv`.
    """

    def __init__(self, args: Any, *, node_name: str | None = None) -> None:
        suffix = getattr(args, 'node_name_suffix', f'_{os.getpid()}')
        described = getattr(args, 'start_type_description_service', True)
        super().__init__(
            args,
            node_name=node_name or f'{NODE_NAME_PREFIX}{suffix}',
            enable_rosout=True,
            start_parameter_services=getattr(args, 'start_parameter_services', False),
            parameter_overrides=[Parameter('start_type_description_service', value=described)],
        )
        try:
            others = {node.full_name for node in discovery.read_graph(args, quiet=True).nodes}
            self.spin_until(lambda: others <= self._discovered(), discovery.DEFAULT_TIMEOUT_SEC)
        except BaseException:
            self.destroy()
            raise

    def __enter__(self) -> DirectNode:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.__dict__['node'], name)

    def _discovered(self) -> set[str]:
        found = self.node.get_node_names_and_namespaces()
        return {names.full_node_name(namespace, name) for name, namespace in found}

    # What the node has not, because rclpy keeps actions apart.

    def get_action_names_and_types(self) -> list[tuple[str, list[str]]]:
        return _actions().get_action_names_and_types(self.node)

    def get_action_client_names_and_types_by_node(
        self, remote_node_name: str, remote_node_namespace: str
    ) -> list[tuple[str, list[str]]]:
        by_node = _actions().get_action_client_names_and_types_by_node
        return by_node(self.node, remote_node_name, remote_node_namespace)

    def get_action_server_names_and_types_by_node(
        self, remote_node_name: str, remote_node_namespace: str
    ) -> list[tuple[str, list[str]]]:
        by_node = _actions().get_action_server_names_and_types_by_node
        return by_node(self.node, remote_node_name, remote_node_namespace)


def _actions() -> Any:
    """Return rclpy's part for the graph of actions; it loads clients and servers of them, too."""
    from rclpy.action import graph

    return graph


@contextmanager
def command_node(
    args: argparse.Namespace | None = None,
    *,
    name: str | None = None,
    may_spin_when_interrupted: bool = False,
) -> Iterator[CommandNode]:
    """Give a node for the time of a command; Ctrl-C, SIGTERM and a closed terminal end it cleanly.

    :param may_spin_when_interrupted: a signal comes as KeyboardInterrupt from
        `CommandNode.spin_until`, once: the node may still be used then, and further signals are
        ignored, so that the command must end soon.
    """
    with _first_signal() if may_spin_when_interrupted else _closed_terminal_ends() as interrupted:
        node = CommandNode(args, node_name=name, interrupted=interrupted)
        try:
            with _ended_by_signals():
                yield node
        finally:
            node.destroy()


@contextmanager
def _ended_by_signals() -> Iterator[None]:
    """Raise KeyboardInterrupt where a signal has shut ROS down, whatever rclpy makes of that.

    Only what waits at that moment hears of it by ExternalShutdownException: what is asked of ROS
    afterwards, to publish or to wait for the next message, is refused by rcl.
    """
    try:
        yield
    except (
        ExternalShutdownException,
        NotInitializedException,
        rclpy_implementation.RCLError,
    ):
        if rclpy.ok():
            raise
        raise KeyboardInterrupt from None


@contextmanager
def _closed_terminal_ends() -> Iterator[None]:
    """Let SIGHUP end ROS as SIGTERM does, or the node's shared memory would be left."""
    before = signal.getsignal(signal.SIGHUP)
    if before is not signal.SIG_DFL or threading.current_thread() is not threading.main_thread():
        yield  # under nohup it is ignored
        return
    signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGTERM))
    try:
        yield
    finally:
        signal.signal(signal.SIGHUP, before)


@contextmanager
def _first_signal() -> Iterator[threading.Event]:
    """Give an event that SIGINT, SIGTERM or a closed terminal sets; the next ones are not heard.

    A thread waits for it. Of handlers, those of many signals would run one within another, until
    Python refuses to go deeper.
    """
    ends = {signal.SIGINT, signal.SIGTERM}
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # which it is under nohup
        ends.add(signal.SIGHUP)
    first = threading.Event()

    def wait() -> None:
        signal.sigwait(ends)
        first.set()

    before = signal.pthread_sigmask(signal.SIG_BLOCK, ends)  # the threads of ROS inherit it
    waiting = threading.Thread(target=wait, daemon=True)
    waiting.start()
    try:
        yield first
    finally:
        if waiting.is_alive():
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
