# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The steps of the lab that are judged on the live graph: publisher and subscriber."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, ExitStack
from itertools import pairwise
from pathlib import Path
import re
import signal
from statistics import median
import time
from typing import Any

from husky_runtime.children import ChildProcess, tail_of
from husky_runtime.domains import OwnDomain
from husky_runtime.executor import make_executor
import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String

from husky_grader.lab.file_steps import find_executable, Verdict

TOPIC = '/topic_test'
TYPE = 'std_msgs/msg/String'
TEXT = re.compile(r'hello world \d+(\.\d*)?(e\+?\d+)?')
APPEAR_WITHIN_SEC = 15.0
LISTEN_SEC = 3.0
RATE_HZ, RATE_TOLERANCE = 10.0, 0.15


class _Graph(Node):
    """A node in a domain of its own, on the topic of the lab's first two programs."""

    def __init__(self, context: rclpy.Context) -> None:
        super().__init__('grader', context=context)
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
def _running(
    name: str, folder: Path, environment: dict[str, str]
) -> Iterator[tuple[_Graph, ChildProcess, Path]]:
    """Run one of topic_demo's programs in a domain of its own; give its graph and its log."""
    program, log = find_executable(folder, 'topic_demo', name), folder / f'{name}.log'
    context = rclpy.Context()
    with ExitStack() as stack:
        domain = stack.enter_context(OwnDomain()).number
        rclpy.init(
            context=context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO
        )
        stack.callback(rclpy.shutdown, context=context)
        graph = _Graph(context)
        stack.callback(graph.destroy_node)
        theirs = {**environment, 'ROS_DOMAIN_ID': str(domain), 'PYTHONUNBUFFERED': '1'}
        stream = stack.enter_context(log.open('w'))
        process = ChildProcess([str(program)], theirs, stream, parent_death=signal.SIGKILL)
        yield graph, stack.enter_context(process), log


def publisher_step(folder: Path, environment: dict[str, str]) -> Verdict:
    """Run topic_demo's publisher and listen: name of the topic, type, rate and text."""
    with _running('publisher', folder, environment) as (graph, process, log):
        graph.spin_until(
            lambda: bool(graph.received) or process.exit_code is not None, APPEAR_WITHIN_SEC
        )
        if not graph.received:
            return 0.0, _why_silent(graph, process, log)
        graph.received.clear()
        graph.spin_until(lambda: False, LISTEN_SEC)
        return _judge_messages(graph.received)


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


def _judge_messages(received: list[tuple[float, str]]) -> Verdict:
    wrong = next((text for _, text in received if not TEXT.fullmatch(text.strip())), None)
    if wrong is not None:
        return 50.0, f'it says {wrong[:60]!r}; the sheet asks for "hello world <time in seconds>"'
    # Their median: that the machine stood still for a moment is not the publisher's fault.
    gaps = [after - before for (before, _), (after, _) in pairwise(received)]
    rate = 1.0 / max(median(gaps), 1e-3) if gaps else 0.0
    if abs(rate - RATE_HZ) > RATE_TOLERANCE * RATE_HZ:
        return 70.0, f'{rate:.1f} messages a second; the sheet asks for 10'
    return 100.0, f'{rate:.1f} Hz on {TOPIC}, {TYPE}, "{received[-1][1]}"'


def subscriber_step(folder: Path, environment: dict[str, str]) -> Verdict:
    """Run topic_demo's subscriber, publish a text and check that it shows it."""
    sent = f'hello grader {time.time():.3f}'
    with _running('subscriber', folder, environment) as (graph, process, log):

        def repeated() -> bool:
            graph.publisher.publish(String(data=sent))
            graph.spin_until(lambda: False, 0.1)
            return process.exit_code is not None or sent in _text(log)

        graph.spin_until(repeated, APPEAR_WITHIN_SEC)
        if process.exit_code is not None:
            return 0.0, f'it ended with exit code {process.exit_code}: {tail_of(log, 1)}'
        line = next((line for line in _text(log).splitlines() if sent in line), '')
    if not line:
        return 0.0, f'it did not show what came on {TOPIC}: "{sent}"'
    if 'heard' not in line:
        return 70.0, f'it shows "{line}"; the sheet asks for "heard <text>"'
    return 100.0, f'"{line.strip()}"'


def _text(log: Path) -> str:
    return log.read_text(encoding='utf-8', errors='replace')
