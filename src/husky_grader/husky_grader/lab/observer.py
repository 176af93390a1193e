# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The grader's own node in the graph of a student's program: it listens, sends and calls.

A process of its own, in the network of the program: `python3 -m husky_grader.lab.observer FOLDER
LOG WORLD`. The files in the folder are those of `observed`; the log is what the program prints.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
import gc
import json
from pathlib import Path
import pickle
import random
import re
import sys
import time
from typing import Any, TYPE_CHECKING

import rclpy
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rosidl_runtime_py.utilities import get_message, get_service

from husky_grader.lab.file_steps import asked
from husky_grader.lab.finding import Finding, nothing
from husky_grader.lab.messages import about, complaint, rate_hz
from husky_grader.lab.observed import FINDING_FILE, OVER_FILE, STEP_FILE
from husky_grader.lab.patience import Patience
from husky_grader.rubric.forms import ANYTHING, Form, TOKEN, with_token
from husky_grader.rubric.interfaces import filled
from husky_grader.rubric.steps import (
    ProgramStep,
    PublisherStep,
    ServiceCall,
    ServiceStep,
    SubscriberStep,
)
from husky_grader.run.diagnosis import Graph, in_domain, nearest, silence, unheard_topics
from husky_grader.run.graph import has_other_fields, read_graph
from husky_grader.run.printed import printed_lines
from husky_grader.run.trusted import limit_memory

if TYPE_CHECKING:
    from husky_grader.lab.robot import Robot

NAME = 'grader'
OTHERS = ('husky_sim', 'follow_path')  # the nodes of the robot beside, where there is one
SEND_EVERY_SEC = 0.1
SETTLED_SEC = 0.3  # what was on its way when a service answered has come by then
HEARD_PERIODS = 3  # of the rate that is asked for: so long is waited and listened at least
JUDGED_GAPS = 2  # between messages: of fewer no rate is told while there is time to hear more
LISTEN_TIMES = 4  # at most, while a rate is unknown, or off by no more tolerances than ...
DOUBTFUL_TOLERANCES = 4.0
TOKENS = (10_000_000, 2**24)  # any field of numbers but the smallest holds them exactly
# What listens, and prints numbers as fast as it can, comes to most of those before its time is up.
TEXT_TOKENS = (10**11, 10**12 - 1)
MAX_MESSAGES = 2000  # that are judged
# What rclpy warns of, once, where on a busy machine the server has found the client too late.
RESPONSE_LOST = 'client will not receive response'
# It matches every publisher, and every subscription.
HEARS_ALL = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)
HEARD_BY_ALL = QoSProfile(
    depth=10,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)

# Types as Python's messages name them, and as students write them in a .msg.
_IN_MSG = {'boolean': 'bool', 'octet': 'byte', 'float': 'float32', 'double': 'float64'}
_OF_PYTHON = re.compile(rf'\b({"|".join(_IN_MSG)})\b')
_LOGGED_AT = re.compile(r'\[\d+\.\d+\] ')  # the time of a logger's line

Over = Callable[[], bool]
"""Tells whether the student's program has ended."""


def observe(step: ProgramStep, over: Over, log: Path, folder: Path, world: str = '') -> Finding:
    """
    Find out what a running program does of what a step asks.

    :param log: what it prints.
    :param folder: for what the grader's own programs print.
    :param world: of a Husky beside the program, an MJCF file; empty: the playpen.
    :raises TypeError: when the step is of another kind.
    """
    with _observer(over) as observer:
        if isinstance(step, PublisherStep):
            return _publisher(step, observer, log, folder, world)
        if isinstance(step, SubscriberStep):
            return _subscriber(step, observer, log)
        if isinstance(step, ServiceStep):
            return _service(step, observer, log)
    raise TypeError(f'{step.kind}: nothing can be observed of such a step')


class _Observer:
    """A node in the domain of the program."""

    def __init__(self, node: Node, over: Over) -> None:
        self.node = node
        self.over = over
        # The EventsExecutor of rclpy 7.1.6 fails where a callback asks when a message was sent.
        self.executor = SingleThreadedExecutor(context=node.context)
        self.executor.add_node(node)

    def spin_until(self, fact: Callable[[], object], within_sec: float) -> None:
        """Serve the node until there is a fact, the program has ended or time is up."""
        patience = Patience(within_sec)
        while not (fact() or self.over() or patience.is_over()):
            self.executor.spin_once(timeout_sec=0.05)

    def spin_for(self, duration_sec: float) -> None:
        deadline = time.monotonic() + duration_sec
        while not self.over() and time.monotonic() <= deadline:
            self.executor.spin_once(timeout_sec=0.05)


@contextmanager
def _observer(over: Over) -> Iterator[_Observer]:
    context = rclpy.Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = Node(NAME, context=context, enable_rosout=False, start_parameter_services=False)
        observer = _Observer(node, over)
        try:
            yield observer
        finally:
            observer.executor.remove_node(node)
            node.destroy_node()
    finally:
        rclpy.shutdown(context=context)


def _publisher(
    step: PublisherStep, observer: _Observer, log: Path, folder: Path, world: str
) -> Finding:
    if step.after_drive is None:
        return _published(step, observer, log)
    from husky_grader.lab.robot import Robot  # to plan a route takes numpy, which takes its time

    with Robot(step.after_drive, folder, world) as robot:
        return _published(step, observer, log, robot)


def _published(
    step: PublisherStep, observer: _Observer, log: Path, robot: Robot | None = None
) -> Finding:
    times_sec: list[float] = []
    complaints: list[str] = []  # the first; no message is kept: a large one costs much memory

    def on_message(message: Any, info: Mapping[str, int]) -> None:
        if len(times_sec) < MAX_MESSAGES:
            # When it was sent: on a busy machine this node may hear several at once.
            times_sec.append(info['source_timestamp'] / 1e9)
            if not complaints and (wrong := complaint(message, step.content)):
                complaints.append(wrong)

    def listen() -> str:
        """Wait for a message; return why there is none that can be judged, or nothing."""
        observer.spin_until(
            lambda: times_sec or _other_fields(step, observer.node),
            _lengthened(step.within_sec, step),
        )
        other = _other_fields(step, observer.node)
        if times_sec or other:
            return other
        return _why_silent(step, read_graph(observer.node, (NAME, *OTHERS)))

    observer.node.create_subscription(get_message(step.type), step.topic, on_message, HEARS_ALL)
    if robot is not None:
        if why := listen():
            return nothing(why)
        if step.content and not complaints:
            return nothing('what it publishes is the same before the Husky has driven')
        if why := _driven(robot, observer):
            return nothing(f'the Husky beside it did not come to the end of its course: {why}')
    if step.call is not None:
        found = _called(step.call, step, observer, log)
        if isinstance(found, Finding):
            return found
    if robot is not None or step.call is not None:
        observer.spin_for(SETTLED_SEC)
        times_sec.clear()
        complaints.clear()
    if why := listen():
        return nothing(why)
    rate = _rate_hz(step, observer, times_sec)
    defects = {'content': complaints[0]} if complaints else {}
    if _tolerances_off(rate, step) <= 1.0 and (why := _why_stopped(step, observer, times_sec)):
        defects['rate'] = why
    return _with_rate(step, rate, defects)


def _why_stopped(step: PublisherStep, observer: _Observer, times_sec: Sequence[float]) -> str:
    """Return that a program publishes no more, as after a loop, or nothing."""
    heard, within_sec = len(times_sec), _lengthened(step.within_sec, step)
    if step.rate_hz is None or heard >= MAX_MESSAGES:
        return ''
    observer.spin_until(lambda: len(times_sec) > heard, within_sec)
    if len(times_sec) > heard or observer.over():
        return ''
    wanted = asked(f'{step.rate_hz:g} messages a second, without an end')
    return f'it stopped: nothing came any more within {within_sec:g} s; {wanted}'


def _with_rate(step: PublisherStep, rate: float, defects: dict[str, str]) -> Finding:
    """Return the finding on what was published, at a rate in Hz, with these defects so far."""
    shown = about(rate)
    if step.rate_hz is not None:
        wanted = f'{step.rate_hz:g}'
        if _tolerances_off(rate, step) <= 1.0:
            shown = wanted
        else:
            shown = f'{rate:.2f}' if shown == wanted else shown
            defects['rate'] = f'about {shown} messages a second; {asked(wanted)}'
    return Finding(f'{shown} Hz on {step.topic}, {step.type}', defects=defects)


def _rate_hz(step: PublisherStep, observer: _Observer, times_sec: Sequence[float]) -> float:
    """
    Listen as long as the step says, and again while a busy machine may have made the difference.

    Where a rate is asked for, also while too few messages came to tell one.
    What was heard last counts by itself, too: a program that was kept waiting before has its rate.

    :param times_sec: of the messages; grows meanwhile.
    """
    fewest_gaps = 0 if step.rate_hz is None else JUDGED_GAPS
    rates: list[float] = []
    for _ in range(LISTEN_TIMES):
        before = len(times_sec)
        observer.spin_for(_lengthened(step.listen_sec, step))
        heard = (times_sec, times_sec[before:])
        rates += [rate_hz(each) for each in heard if len(each) > fewest_gaps]
        off = [_tolerances_off(rate, step) for rate in rates]
        if off and not 1.0 < min(off) <= DOUBTFUL_TOLERANCES:
            break
    return min(rates or [rate_hz(times_sec)], key=lambda rate: _tolerances_off(rate, step))


def _lengthened(duration_sec: float, step: PublisherStep) -> float:
    """Return a duration, or that of HEARD_PERIODS where the rate that is asked for needs more."""
    return max(duration_sec, HEARD_PERIODS / step.rate_hz) if step.rate_hz else duration_sec


def _tolerances_off(rate: float, step: PublisherStep) -> float:
    """Return how far a rate is from what is asked for, in tolerances."""
    if step.rate_hz is None:
        return 0.0
    return abs(rate / step.rate_hz - 1.0) * 100.0 / step.rate_tolerance_percent


def _driven(robot: Robot, observer: _Observer) -> str:
    """Let the robot drive its course; return why it is not at the end, or nothing."""
    robot.drive()
    observer.spin_until(lambda: robot.stands, robot.limit_sec)
    return robot.why_not_there()


def _other_fields(step: PublisherStep, node: Node) -> str:
    """Return that a publisher's type has the name that is asked for, and other fields."""
    if not has_other_fields(node, step.topic, step.type):
        return ''
    fields = get_message(step.type).get_fields_and_field_types().items()
    asked_for = ', '.join(
        f'{name} ({_OF_PYTHON.sub(lambda kind: _IN_MSG[kind[0]], kind)})' for name, kind in fields
    )
    return f'its {step.type} has other fields; {asked(asked_for)}'


def _why_silent(step: PublisherStep, graph: Graph) -> str:
    types = [each.type for each in graph.publishers if each.topic == step.topic]
    if types and step.type not in types:
        return f'it publishes {types[0]} on {step.topic}; {asked(step.type)}'
    topics = [each.topic for each in graph.publishers if each.type == step.type]
    if topics and not types:
        topic = nearest(step.topic, topics) or topics[0]
        return f'it publishes on {topic}; {asked(step.topic)}'
    waited_sec = _lengthened(step.within_sec, step)
    nothing_came = f'nothing came on {step.topic} within {waited_sec:g} s'
    return '; '.join([nothing_came, *silence(graph, step.topic), *unheard_topics(graph)])


def _subscriber(step: SubscriberStep, observer: _Observer, log: Path) -> Finding:
    token = new_token(step)
    message = filled(get_message(step.type)(), with_token(step.sent, token))
    matched: list[object] = []  # who has listened: what is printed else is guessed
    publisher = observer.node.create_publisher(
        type(message),
        step.topic,
        HEARD_BY_ALL,
        event_callbacks=PublisherEventCallbacks(matched=matched.append),
    )

    def lines() -> list[str]:
        return [line.strip() for line in printed_lines(log, token)] if matched else []

    def sent_and_printed() -> bool:
        publisher.publish(message)
        observer.spin_for(SEND_EVERY_SEC)
        return bool(lines())

    observer.spin_until(sent_and_printed, step.within_sec)
    wanted = with_token(step.printed, token)
    form = Form(f'{ANYTHING}{wanted}{ANYTHING}')
    if not lines():
        return nothing(_why_deaf(step, read_graph(observer.node, (NAME,))))
    if any(form.fits(line) for line in lines()):
        return Finding(f'it prints "{step.printed}"')
    shown = _LOGGED_AT.sub('', lines()[0]).replace(token, TOKEN)
    return Finding('', defects={'printed': f'it prints "{shown}"; {asked(step.printed)}'})


def new_token(step: SubscriberStep) -> str:
    """Return a number to be heard and printed: one of many where it is sent in texts alone."""
    try:
        sent = with_token(step.sent, str(TEXT_TOKENS[1]))
        is_text = _is_in_texts(step.sent, filled(get_message(step.type)(), sent))
    except ValueError:  # that is too large for a number, or too long for a text
        is_text = False
    return str(random.randint(*(TEXT_TOKENS if is_text else TOKENS)))


def _is_in_texts(value: Any, field: Any) -> bool:
    """Tell whether a value of a rubric has its token in texts, by the field that it was put in."""
    if isinstance(value, Mapping):
        return all(_is_in_texts(each, getattr(field, name)) for name, each in value.items())
    entries = field if isinstance(field, list) else [field]
    return TOKEN not in str(value) or all(isinstance(entry, str) for entry in entries)


def _why_deaf(step: SubscriberStep, graph: Graph) -> str:
    listening = [each for each in graph.subscriptions if each.topic == step.topic]
    if graph.elsewhere is not None:
        return in_domain(graph.elsewhere)
    if not graph.subscriptions:
        return f'it listens to nothing; {asked(step.topic)}'
    wrong = unheard_topics(replace(graph, subscriptions=listening or graph.subscriptions))
    if not listening:
        topics = ' and '.join(sorted({each.topic for each in graph.subscriptions}))
        return next(wrong, f'it listens to {topics}; {asked(step.topic)}')
    if step.launch:
        hint = 'a launch file shows what a node prints by output="screen"'
    else:
        hint = 'does it spin, and does its callback print what is in the message?'
    return next(wrong, f'it did not print what came on {step.topic}; {hint}')


def _service(step: ServiceStep, observer: _Observer, log: Path) -> Finding:
    call = ServiceCall(service=step.service, type=step.type, request=step.request)
    response = _called(call, step, observer, log)
    if isinstance(response, Finding):
        return response
    if wrong := complaint(response, step.response):
        return Finding('', defects={'response': f'{step.service} answers: {wrong}'})
    return Finding(f'{step.service} answers, {step.type}')


def _called(
    call: ServiceCall, step: PublisherStep | ServiceStep, observer: _Observer, log: Path
) -> Any:
    """Return the response of a service; a finding where there is none."""
    kind = get_service(call.type)
    client = observer.node.create_client(kind, call.service)
    observer.spin_until(client.service_is_ready, step.within_sec)
    if not client.service_is_ready():
        elsewhere = read_graph(observer.node, (NAME, *OTHERS)).elsewhere
        if elsewhere is not None:
            return nothing(in_domain(elsewhere))
        return nothing(_why_no_service(call, dict(observer.node.get_service_names_and_types())))
    request = filled(kind.Request(), call.request)
    future = client.call_async(request)
    observer.spin_until(
        lambda: future.done() or printed_lines(log, RESPONSE_LOST), step.within_sec
    )
    if not future.done() and printed_lines(log, RESPONSE_LOST):
        future = client.call_async(request)
        observer.spin_until(future.done, step.within_sec)
    if not future.done():
        return nothing(
            f'{call.service} did not answer within {step.within_sec:g} s: does its callback '
            'return a response, and wait for no other answer (client.call) in the same group?'
        )
    return future.result()


def _why_no_service(call: ServiceCall, offered: Mapping[str, Sequence[str]]) -> str:
    if others := [kind for kind in offered.get(call.service, ()) if kind != call.type]:
        return f'it offers {call.service} as {others[0]}; {asked(call.type)}'
    near = nearest(call.service, [name for name in offered if name != call.service])
    return (
        f'it offers {near}; {asked(call.service)}' if near else f'it does not offer {call.service}'
    )


def main() -> int:
    """Find it out, and write down the finding."""
    folder, log = map(Path, sys.argv[1:3])
    limit_memory()
    gc.freeze()  # no collection, nor the last one, looks at what was loaded
    step = pickle.loads((folder / STEP_FILE).read_bytes())  # noqa: S301  # the grader's own
    found = observe(step, (folder / OVER_FILE).exists, log, folder, sys.argv[3])
    part = folder / 'part'
    part.write_text(json.dumps(asdict(found)), encoding='utf-8')
    part.replace(folder / FINDING_FILE)
    return 0


if __name__ == '__main__':
    sys.exit(main())
