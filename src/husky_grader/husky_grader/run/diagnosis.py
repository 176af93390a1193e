# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Why a program did not do what it should: from what it printed, and from its place in the graph.

Pure functions of the logs and of a description of the graph, see `graph`.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import takewhile
import math
from pathlib import PurePath
import re
from signal import Signals
import sys
import sysconfig

from husky_course.printable import printable

MAX_LINE = 200  # characters of an error in a reason
COMMAND_TOPIC = '/husky_velocity_controller/cmd_vel'
COMMAND_TYPE = 'geometry_msgs/msg/Twist'
VELOCITY_TYPES = (COMMAND_TYPE, 'geometry_msgs/msg/TwistStamped')
TAKEN = {
    'lab': {COMMAND_TOPIC: COMMAND_TYPE},
    'clearpath': {COMMAND_TOPIC: COMMAND_TYPE, '/cmd_vel': 'geometry_msgs/msg/TwistStamped'},
}
"""Types of commands by their topics, by interface; the one to name is last."""
CLOCK = '/clock'
EVERYWHERE = (CLOCK, '/parameter_events', '/rosout')  # topics of which each node may have one
# Which file an error stands in tells most; one of these is not what a student has written.
LIBRARIES = tuple(
    {sysconfig.get_path(name) for name in ('stdlib', 'platstdlib', 'purelib', 'platlib')}
    | {f'{sys.base_prefix}/lib/python3', '/opt/ros/', '/usr/lib/python3', '<frozen '}
)

_LAUNCHED = re.compile(r'\[[\w.-]+-\d+\] ')  # what `ros2 launch` puts before each line
_LAUNCH_FAILED = '[ERROR] [launch]: Caught exception in launch (see debug for traceback): '
_OF_LAUNCH = '[INFO] [launch]: '  # where its logs are, and how much it tells
_LOADING = re.compile(r'^Caught exception when trying to load file of format \[\w+\]: ')
# Of a file in share/PACKAGE of a workspace: its package and what follows say which one it is.
# Sought where a word begins: from each of its letters the time would grow with its square.
_SHARED = re.compile(r'(?<![^\s\'"(\[])[^\s\'"(\[]*\binstall/[\w-]+/share/')
_OF_RUN = '[ros2run]: Process exited with failure '  # by `ros2 run`, below what the program says
_FATAL = 'Fatal Python error: '  # Python lists frames and modules below it
_NOTE = '[ended by the grader: '
_TRIED = ' - '  # before what each parser of upstream's launch says of a file that none can read
_FRAME = re.compile(r'\s+File "(?P<file>[^"]+)", line (?P<line>\d+)')
_ERROR = re.compile(r'(?P<name>[A-Za-z_][\w.]*)(: .*)?')
_TIMED_OUT = re.compile(r'no command for (\S+) s \(command_timeout_sec\)')
_SPINS = (
    'does it spin, and does no callback wait for an answer (client.call) or for time (Rate.sleep)?'
)
_ENDED = ('KeyboardInterrupt', 'ExternalShutdownException')  # whoever asked it to end
_NOT_FINITE = re.compile(r'linear\.x=(\S+), angular\.z=(\S+): a velocity must be a finite number')


@dataclass(frozen=True)
class Endpoint:
    """A publisher or a subscription of a node."""

    topic: str
    type: str
    reliable: bool = True
    transient_local: bool = False
    deadline_sec: float = math.inf
    manual_liveliness: bool = False
    lease_sec: float = math.inf  # of its liveliness


@dataclass(frozen=True)
class Graph:
    """
    What the program publishes and listens to, and what all others do.

    :param elsewhere: the domain that the program is in, where it is in another one.
    """

    publishers: Sequence[Endpoint] = ()
    subscriptions: Sequence[Endpoint] = ()
    other_publishers: Sequence[Endpoint] = ()
    elsewhere: int | None = None


def reasons(
    printed: str,
    simulator_log: str,
    graph_reasons: Iterable[str],
    exit_code: int | None,
    unsent: Iterable[str] = (),
) -> tuple[str, ...]:
    """
    Return why a controller did not drive, the most telling first.

    :param printed: what it has printed until it was ended.
    :param graph_reasons: what its place in the graph says, see `reasons_of_graph`.
    :param exit_code: with which it has ended by itself; None where it was ended.
    :param unsent: what is told where nothing else is, see `unsent_commands`.
    """
    crashed = crash(printed)
    if exit_code:
        last = crashed or shortened(last_line(printed))
        crashed = f'it crashed ({how_ended(exit_code, last)})' + (f': {last}' if last else '')
    found = [crashed] if crashed else []
    if refused := _NOT_FINITE.search(simulator_log):
        found.append(
            f'it commanded linear.x = {refused[1]}, angular.z = {refused[2]}: a velocity must be '
            'a finite number'
        )
    found += graph_reasons
    found = found or list(unsent)
    if exit_code is None and (timed_out := _TIMED_OUT.search(simulator_log)):
        found.append(
            f'it left the Husky without a command while that drove, which stops after '
            f'{timed_out[1]} s: send commands again and again, also the same'
        )
    return tuple(dict.fromkeys(map(printable, found)))


def last_line(printed: str) -> str:
    """Return the last line of the program that says something; of launch what has ended it."""
    lines = printed.strip().splitlines()
    failed = [n for n, line in enumerate(lines) if line.startswith(_LAUNCH_FAILED)]
    if failed and not lines[-1].startswith(_NOTE):
        # It may be of several lines; what comes then are those of launch about its nodes.
        first, *others = lines[failed[-1] :]
        told = [first.removeprefix(_LAUNCH_FAILED)]
        told += takewhile(lambda line: not line.startswith('['), others)
        if tried := [line.removeprefix(_TRIED) for line in told if line.startswith(_TRIED)]:
            # Each parser says what it minds, that of the file's own kind first; some in several.
            return next((line for line in tried if not line.endswith(':')), tried[0])
        return _SHARED.sub('', _LOADING.sub('', ' '.join(map(str.strip, told))))
    told = [line for line in lines if not line.startswith((_OF_LAUNCH, _OF_RUN))]
    if not told[-1:] or not told[-1].startswith(_NOTE):
        told = [line for line in told if line.startswith(_FATAL)] or told
    return told[-1].strip() if told else ''


def how_ended(exit_code: int, last: str = '') -> str:
    """
    Return an exit status in words; of a signal its name, which most real-time ones lack.

    :param last: the last line of the log; where the grader has ended it, that says so.
    """
    if exit_code >= 0:
        return f'exit code {exit_code}'
    if exit_code == -Signals.SIGKILL and not last.startswith(_NOTE):
        return 'SIGKILL, as by the kernel where memory runs out'
    return {each.value: each.name for each in Signals}.get(-exit_code, f'signal {-exit_code}')


def how_it_ended(exit_code: int, printed: str) -> str:
    """Return why a program has ended, by its own error if it tells of one."""
    if error := crash(printed):
        return error
    last = last_line(printed)
    how = f'it ended by itself ({how_ended(exit_code, last)})'
    return shortened(how + (f': {last}' if last else ''))


def reasons_of_graph(graph: Graph, interface: str = 'lab') -> list[str]:
    """
    Return what a program's place in the graph says, the most telling first.

    :param graph: where it stood, with the publishers of the simulator as others.
    :param interface: that of the Husky.
    """
    return [*unheard_topics(graph), *unheard_commands(graph, interface)]


def crash(printed: str) -> str:
    """
    Return the error that ended a program, with the student's own line: `follow_path.py line 12:`.

    :param printed: what it has printed; nothing is said of an end that it was asked for.
    """
    errors = list(takewhile(lambda error: not error.was_asked_for, _errors(printed)))
    if not errors:
        return ''
    return shortened(_SHARED.sub('', f'{errors[-1].place}: {errors[-1].text}'))


@dataclass(frozen=True)
class _Error:
    """An error of Python with its frames, file and line each, the innermost last."""

    text: str
    frames: Sequence[tuple[str, str]]

    @property
    def was_asked_for(self) -> bool:
        return self.text.partition(':')[0].endswith(_ENDED)

    @property
    def place(self) -> str:
        own = [frame for frame in self.frames if not frame[0].startswith(LIBRARIES)]
        file, line = (own or self.frames)[-1]
        return f'{PurePath(file).name} line {line}'


def _errors(printed: str) -> Iterator[_Error]:
    """Yield the errors of tracebacks, and of what Python could not even read."""
    frames: list[tuple[str, str]] = []
    for printed_line in printed.splitlines():
        line = _LAUNCHED.sub('', printed_line, count=1)
        if found := _FRAME.match(line):
            frames.append((found['file'], found['line']))
        elif line[:1].strip():  # neither source nor a mark below it
            if frames and _ERROR.fullmatch(line):
                yield _Error(line, frames)
            frames = []


def shortened(text: str, most: int = MAX_LINE) -> str:
    return text if len(text) <= most else f'{text[: most - 3]}...'


def unheard_topics(graph: Graph) -> Iterator[str]:
    """Yield why subscriptions of a program hear nothing."""
    by_topic: dict[str, list[Endpoint]] = {}
    for publisher in graph.other_publishers:
        by_topic.setdefault(publisher.topic, []).append(publisher)
    own = {publisher.topic for publisher in graph.publishers}
    for wanted in graph.subscriptions:
        if wanted.topic in EVERYWHERE or wanted.topic in own:
            continue
        offered = by_topic.get(wanted.topic)
        if not offered:
            near = nearest(wanted.topic, by_topic)
            hint = f'; did you mean {near}?' if near else ''
            yield f'it listens to {wanted.topic}, which nobody publishes{hint}'
        elif wanted.type not in {each.type for each in offered}:
            yield (
                f'it listens to {wanted.topic} as {wanted.type}; that topic carries '
                f'{offered[0].type}'
            )
        else:
            yield from _wrong_qos(wanted, offered)


def _wrong_qos(wanted: Endpoint, offered: Sequence[Endpoint]) -> Iterator[str]:
    """Yield what a subscription requests and nobody offers (DDS 1.4, 2.2.3)."""
    latched = wanted.transient_local and not any(each.transient_local for each in offered)
    reliable = wanted.reliable and not any(each.reliable for each in offered)
    manual = wanted.manual_liveliness and not any(each.manual_liveliness for each in offered)
    deadline = wanted.deadline_sec < min(each.deadline_sec for each in offered)
    lease = wanted.lease_sec < min(each.lease_sec for each in offered)
    for is_unmet, requested, published, mend in (
        (latched, 'TRANSIENT_LOCAL', 'VOLATILE', _leave_out('durability')),
        (reliable, 'RELIABLE', 'BEST_EFFORT', 'subscribe with qos_profile_sensor_data'),
        (manual, 'MANUAL_BY_TOPIC', 'AUTOMATIC', _leave_out('liveliness')),
        (deadline, f'a deadline of {wanted.deadline_sec:g} s', 'without', _leave_out('deadline')),
        (lease, f'a liveliness lease of {wanted.lease_sec:g} s', 'without', _leave_out('lease')),
    ):
        if is_unmet:
            yield (
                f'it hears nothing of {wanted.topic}: it asks for {requested}, but that is '
                f'published {published}; {mend}'
            )


def _leave_out(policy: str) -> str:
    return f'leave the {policy} of its QoS profile out'


def unheard_commands(graph: Graph, interface: str = 'lab') -> Iterator[str]:
    """Yield why the Husky hears no commands; by the interface clearpath it takes both kinds."""
    taken = TAKEN[interface]
    commands = [each for each in graph.publishers if each.topic in taken]
    for each in commands:
        if each.type != taken[each.topic]:
            yield f'it publishes {each.type} on {each.topic}; the Husky takes {taken[each.topic]}'
        if not each.reliable:
            yield (
                f'it publishes {each.topic} best effort; the Husky listens reliably and hears '
                'nothing'
            )
    if not commands:
        for each in graph.publishers:
            if each.type in VELOCITY_TYPES:
                yield (
                    f'it publishes {each.type} on {each.topic}; the Husky listens on '
                    f'{next(reversed(taken))}'
                )


def unsent_commands(graph: Graph, interface: str = 'lab') -> Iterator[str]:
    """Yield what stops a program that could be heard, and has never sent a command."""
    taken = TAKEN[interface]
    if graph.elsewhere is not None:
        yield in_domain(graph.elsewhere)
        return
    for each in graph.publishers:
        if taken.get(each.topic) == each.type and each.reliable:
            yield f'it has a publisher on {each.topic}, and never sent a command: {_SPINS}'
    if not any(each.topic in taken or each.type in VELOCITY_TYPES for each in graph.publishers):
        yield (
            f'it has no publisher on {next(reversed(taken))}: is it made at all, and does nothing '
            'before it wait, such as wait_for_service?'
        )


def in_domain(elsewhere: int) -> str:
    return (
        f'it is in domain {elsewhere}, where nobody hears it: leave ROS_DOMAIN_ID and domain_id '
        'to who starts it'
    )


def silence(graph: Graph, topic: str) -> Iterator[str]:
    """Yield why nothing comes on a topic that a program is to publish."""
    own = sorted({each.topic for each in graph.publishers}.difference(EVERYWHERE))
    clocks = {each.topic for each in (*graph.publishers, *graph.other_publishers)} & {CLOCK}
    if not clocks and any(each.topic == CLOCK for each in graph.subscriptions):
        yield 'its clock is that of /clock (use_sim_time), which nobody publishes here'
    elif topic in own:
        yield f'it has a publisher there: does it publish again and again, {_SPINS}'
    elif graph.elsewhere is not None:
        yield in_domain(graph.elsewhere)
    elif own:
        yield f'it has publishers on {" and ".join(own)} alone'
    else:
        yield 'it has no publisher: is one made, and does nothing before it wait?'


def nearest(name: str, known: Iterable[str]) -> str:
    """Return the name that was likely meant: one like it, or with the same last part."""
    names = sorted(known)
    near = get_close_matches(name, names, n=1)
    last = name.rpartition('/')[2]
    near += [each for each in names if each.rpartition('/')[2] == last]
    return near[0] if near else ''
