# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The steps of the lab that are judged on the live graph: publisher and subscriber."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
import re
import signal
from statistics import median
import time
from typing import Any, IO

from husky_runtime.children import ChildProcess, tail_of
from husky_runtime.domains import OwnDomain
from husky_runtime.executor import make_executor
import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String

from husky_grader.lab.file_steps import failed, find_executable, Step

TOPIC = '/topic_test'
TYPE = 'std_msgs/msg/String'
TEXT = re.compile(r'hello world \d+(\.\d*)?(e\+?\d+)?')
APPEAR_WITHIN_SEC = 15.0
LISTEN_SEC = 3.0
RATE_HZ, RATE_TOLERANCE = 10.0, 0.15


class _Graph(Node):
    """A node in a domain of its own, on the topic of the lab's first two programs."""

    def __init__(self, context: rclpy.Context, domain: int) -> None:
        super().__init__('grader', context=context)
        self.domain = domain
        self.received: list[tuple[float, str]] = []
        self.publisher = self.create_publisher(String, 'topic_test', 10)
        self.create_subscription(String, 'topic_test', self._on_message, 10)
        self._own_executor = make_executor(context)
        self._own_executor.add_node(self)

    def _on_message(self, msg: String) -> None:
        self.received.append((time.monotonic(), msg.data))

    def others(self, infos: list[Any]) -> list[Any]:
        return [info for info in infos if info.node_name != 'grader']

    def spin_until(self, fact: Callable[[], bool], within_sec: float) -> None:
        deadline = time.monotonic() + within_sec
        while not fact() and time.monotonic() <= deadline:
            self._own_executor.spin_once(timeout_sec=0.05)

    def destroy_node(self) -> None:
        self._own_executor.remove_node(self)
        super().destroy_node()


@contextmanager
def _own_graph() -> Iterator[_Graph]:
    context = rclpy.Context()
    with OwnDomain() as domain:
        rclpy.init(
            context=context,
            domain_id=domain.number,
            signal_handler_options=SignalHandlerOptions.NO,
        )
        graph = _Graph(context, domain.number)
        try:
            yield graph
        finally:
            graph.destroy_node()
            rclpy.shutdown(context=context)


def publisher_step(folder: Path, environment: dict[str, str], most: float) -> Step:
    """Run topic_demo's publisher and listen: name of the topic, type, rate and text."""
    name = 'publisher'
    try:
        program = find_executable(folder, 'topic_demo', 'publisher')
    except ValueError as error:
        return failed(name, most, str(error))
    with _own_graph() as graph:
        environment = {**environment, 'ROS_DOMAIN_ID': str(graph.domain)}
        log = folder / 'publisher.log'
        with log.open('w') as stream, _start(program, environment, stream) as process:
            graph.spin_until(
                lambda: bool(graph.received) or process.exit_code is not None, APPEAR_WITHIN_SEC
            )
            if not graph.received:
                return failed(name, most, _why_silent(graph, process, log))
            graph.received.clear()
            graph.spin_until(lambda: False, LISTEN_SEC)
            return _judge_messages(graph.received, most)


def _start(program: Path, environment: dict[str, str], log: IO[str]) -> ChildProcess:
    return ChildProcess([str(program)], environment, log, parent_death=signal.SIGKILL)


def _why_silent(graph: _Graph, process: ChildProcess, log: Path) -> str:
    if process.exit_code is not None:
        return f'it ended with exit code {process.exit_code}: {tail_of(log, 1)}'
    infos = graph.others(graph.get_publishers_info_by_topic(TOPIC))
    wrong = [info.topic_type for info in infos if info.topic_type != TYPE]
    if wrong:
        return f'it publishes {wrong[0]} on {TOPIC}; the sheet asks for {TYPE}'
    topics = [
        topic
        for topic, kinds in graph.get_topic_names_and_types()
        if TYPE in kinds and graph.others(graph.get_publishers_info_by_topic(topic))
    ]
    if topics and not infos:
        return f'it publishes on {topics[0]}; the sheet asks for {TOPIC}'
    return f'nothing came on {TOPIC} within {APPEAR_WITHIN_SEC:g} s'


def _judge_messages(received: list[tuple[float, str]], most: float) -> Step:
    name = 'publisher'
    wrong = next((text for _, text in received if not TEXT.fullmatch(text.strip())), None)
    if wrong is not None:
        why = f'it says {wrong[:60]!r}; the sheet asks for "hello world <time in seconds>"'
        return failed(name, most, why, 0.5)
    # Their median: that the machine stood still for a moment is not the publisher's fault.
    gaps = [after - before for (before, _), (after, _) in pairwise(received)]
    rate = 1.0 / max(median(gaps), 1e-3) if gaps else 0.0
    if abs(rate - RATE_HZ) > RATE_TOLERANCE * RATE_HZ:
        return failed(name, most, f'{rate:.1f} messages a second; the sheet asks for 10', 0.7)
    return Step(name, most, most, f'{rate:.1f} Hz on {TOPIC}, {TYPE}, "{received[-1][1]}"')


def subscriber_step(folder: Path, environment: dict[str, str], most: float) -> Step:
    """Run topic_demo's subscriber, publish a text and check that it shows it."""
    name, sent = 'subscriber', f'hello grader {time.time():.3f}'
    try:
        program = find_executable(folder, 'topic_demo', 'subscriber')
    except ValueError as error:
        return failed(name, most, str(error))
    with _own_graph() as graph:
        environment = {**environment, 'ROS_DOMAIN_ID': str(graph.domain), 'PYTHONUNBUFFERED': '1'}
        log = folder / 'subscriber.log'
        with log.open('w') as stream, _start(program, environment, stream) as process:

            def repeated() -> bool:
                graph.publisher.publish(String(data=sent))
                graph.spin_until(lambda: False, 0.1)
                return process.exit_code is not None or sent in _text(log)

            graph.spin_until(repeated, APPEAR_WITHIN_SEC)
            if process.exit_code is not None:
                why = f'it ended with exit code {process.exit_code}: {tail_of(log, 1)}'
                return failed(name, most, why)
            line = next((line for line in _text(log).splitlines() if sent in line), '')
    if not line:
        return failed(name, most, f'it did not show what came on {TOPIC}: "{sent}"')
    if 'heard' not in line:
        return failed(name, most, f'it shows "{line}"; the sheet asks for "heard <text>"', 0.7)
    return Step(name, most, most, f'"{line.strip()}"')


def _text(log: Path) -> str:
    return log.read_text(encoding='utf-8', errors='replace')
