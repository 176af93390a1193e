# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The command line itself: help, choices, completion, speed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import http.client
import os
from pathlib import Path
import signal
import socket
import subprocess
import sys
from typing import Any

import pytest
from ros2cli.daemon import get_address
from ros2cli.node.strategy import NodeStrategy

COMMANDS = {
    'action': {'info', 'list', 'send_goal', 'type'},
    'bag': {'burst', 'convert', 'info', 'list', 'play', 'record', 'reindex'},
    'component': {'list', 'load', 'standalone', 'types', 'unload'},
    'daemon': {'start', 'status', 'stop'},
    'interface': {'list', 'package', 'packages', 'proto', 'show'},
    'lifecycle': {'get', 'list', 'nodes', 'set'},
    'multicast': {'receive', 'send'},
    'node': {'info', 'list'},
    'param': {'delete', 'describe', 'dump', 'get', 'list', 'load', 'set'},
    'pkg': {'create', 'executables', 'list', 'prefix', 'xml'},
    'service': {'call', 'echo', 'find', 'info', 'list', 'type'},
    'topic': {'bw', 'delay', 'echo', 'find', 'hz', 'info', 'list', 'pub', 'type'},
}
SINGLE = {'doctor', 'launch', 'run', 'wtf'}


def test_every_command_is_in_the_help(ros2: Callable[..., Any]) -> None:
    answer = ros2('--help')
    assert answer.status == 0
    listed = answer.out.partition('Commands:')[2].split('\n\n')[0].split('\n')
    names = {line.split()[0] for line in listed if line.strip()}
    assert names == COMMANDS.keys() | SINGLE


@pytest.mark.parametrize('command', sorted(COMMANDS))
def test_every_verb_is_in_the_help_of_its_command(ros2: Callable[..., Any], command: str) -> None:
    answer = ros2(command)
    assert answer.status == 0
    listed = answer.out.partition('Commands:')[2].split('\n\n')[0].split('\n')
    assert {line.split()[0] for line in listed if line.strip()} == COMMANDS[command]


def test_where_nothing_is_open_nothing_is_printed() -> None:
    closed = ['bash', '-c', 'exec "$@" <&- >&-', 'bash', sys.executable, '-m', 'ros2cli.cli']
    words = ('pkg', 'prefix', 'rclpy')
    ended = subprocess.run([*closed, *words], capture_output=True, timeout=30, check=False)
    assert (ended.returncode, ended.stderr) == (0, b'')


def test_every_verb_has_help_and_completion_words() -> None:
    from entry_point_index import docstring, entry_points
    from ros2cli import cli

    for command, verbs in [*COMMANDS.items(), *((name, {''}) for name in SINGLE)]:
        group = 'ros2cli.daemon.verb' if command == 'daemon' else f'ros2{command}.verb'
        for verb in verbs:
            assert cli.build_parser([word for word in (command, verb) if word]).format_help()
            target = entry_points(group if verb else 'ros2cli.command')[verb or command]
            assert docstring(target).partition('\n')[0].endswith('.')


def modules_printed(code: str) -> set[str]:
    """Return the names in the last line that a program prints."""
    printed = subprocess.check_output([sys.executable, '-c', code], text=True)
    return set(printed.splitlines()[-1].split())


def test_the_help_imports_nothing_that_takes_long() -> None:
    long = {
        'asyncio',
        'email',
        'importlib.metadata',
        'numpy',
        'rclpy',
        'subprocess',
        'yaml',
    }
    bare = 'import argparse, sys\nargparse.ArgumentParser().format_help()\nprint(*sys.modules)'
    shown = 'import sys; from ros2cli.cli import main\ntry: main(["--help"])\nexcept SystemExit: '
    loaded = modules_printed(f'{shown}print(*sys.modules)')
    more = loaded - modules_printed(bare)
    assert long & loaded == set()
    assert len(more) < 40, sorted(more)


@pytest.mark.parametrize(
    ('words', 'message'),
    [
        (('topc',), "'topc' is no command of ros2; did you mean 'topic'?"),
        (('topic', 'lst'), "'lst' is no verb of ros2 topic; did you mean 'list'?"),
        (('topic', 'list', '--nonsense'), 'unrecognized arguments: --nonsense'),
        (('topic', 'list', '--all'), 'is not in Jazzy; use --include-hidden-topics'),
        (('topic', 'echo', '/t', '--onec'), "--onec; did you mean '--once'?"),
        (('topic', 'echo', '/t', 'T', '\N{EM DASH}once'), "hyphens: '--once'"),
        (('topic', 'pub', '/t', 'T', '{a:', '{x: 1}}'), '; a value in YAML stands between'),
        (('topic', 'pub', '/t', 'T', 'data:', '1'), 'straight quotes: "{field: value}"'),
        (('security',), 'is part of a full ROS 2 and left out here'),
        (
            ('action', 'find', 'x'),
            'ros2 action find came after Jazzy; `ros2 action list -t` shows',
        ),
        (('action', 'echo', 'x'), 'came after Jazzy; `ros2 topic echo ACTION/_action/feedback`'),
        (('topic', 'echo'), 'the following arguments are required: topic_name'),
    ],
)
def test_a_wrong_word_is_refused_with_what_was_meant(
    ros2: Callable[..., Any], words: tuple[str, ...], message: str
) -> None:
    answer = ros2(*words)
    assert answer.status == 2
    assert message in answer.err


@pytest.fixture
def daemon(domain: int, ros2: Callable[..., Any]) -> Iterator[None]:
    yield
    ros2('daemon', 'stop')


@pytest.mark.usefixtures('daemon')
def test_the_daemon_answers_until_it_is_stopped(
    processes: Any, ros2: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    processes.node('talker', 'talker')
    (tmp_path / 'queue.py').write_text('raise SystemExit(3)')  # a student's own
    monkeypatch.chdir(tmp_path)
    for verb, told in (
        ('stop', 'is not running'),
        ('start', 'has been started'),
        ('start', 'is already running'),
        ('status', 'is running'),
    ):
        answer = ros2('daemon', verb)
        assert (answer.status, answer.out, answer.err) == (0, f'The daemon {told}\n', '')
    _attack(get_address())
    with NodeStrategy(None) as node:
        (info,) = node.get_publishers_info_by_topic('/chatter')
        assert (info.node_name, info.qos_profile.reliability.name) == ('talker', 'RELIABLE')
        assert ['/chatter', ['std_msgs/msg/String']] in node.get_topic_names_and_types()
        assert node.daemon_node is not None
        (listed,) = ros2('node', 'list', '--all').out.split()[:1]
        assert listed == f'/{node.get_name()}'
    assert ros2('daemon', 'stop').out == 'The daemon has been stopped\n'
    assert ros2('daemon', 'status').out == 'The daemon is not running\n'


def _attack(address: tuple[str, int]) -> None:
    """Say nothing, too little and too much, and speak as a page of a browser would."""
    stop = b'<methodCall><methodName>system.shutdown</methodName></methodCall>'
    silent, broken = socket.create_connection(address), socket.create_connection(address)
    broken.sendall(b'POST /ros2cli/ HTTP/1.0\r\nHost: localhost:1\r\nContent-Length: 50\r\n\r\n<')
    for headers, status in (
        ({'Origin': 'http://a.page'}, 403),
        ({'Host': 'a.page:11511'}, 403),
        ({'Content-Length': '999999999'}, 413),
        ({'Content-Length': 'many'}, 413),
    ):
        connection = http.client.HTTPConnection(*address, timeout=20.0)
        connection.request('POST', '/ros2cli/', stop, headers)
        assert connection.getresponse().status == status, headers
        connection.close()
    silent.close()
    broken.close()


def _complete(line: str, folder: Path) -> set[str]:
    """Ask argcomplete as bash does: by environment variables and file descriptor 8."""
    out = folder / 'completions'
    command = f'exec "{sys.executable}" -m ros2cli 8>"{out}" 9>/dev/null'
    environment = {
        **os.environ,
        '_ARGCOMPLETE': '1',
        'COMP_LINE': line,
        'COMP_POINT': str(len(line)),
        '_ARGCOMPLETE_COMP_WORDBREAKS': ' \t\n',
        'IFS': '\013',
    }
    subprocess.run(['bash', '-c', command], env=environment, check=True, timeout=20)
    return {word.strip() for word in out.read_text().split('\013')}


def test_tab_completes_commands_verbs_and_names(processes: Any, tmp_path: Path) -> None:
    processes.node('talker', 'talker')
    assert _complete('ros2 to', tmp_path) == {'topic'}
    assert _complete('ros2 topic ec', tmp_path) == {'echo'}
    assert _complete('ros2 topic echo /chat', tmp_path) == {'/chatter'}
    assert _complete('ros2 node info /t', tmp_path) == {'/talker'}
    assert _complete('ros2 pkg prefix rclp', tmp_path) == {'rclpy'}
    assert 'std_msgs/msg/String' in _complete('ros2 topic pub /x std_msgs/msg/S', tmp_path)
    assert '--once' in _complete('ros2 topic echo --on', tmp_path)


def test_a_disk_without_room_for_the_output_is_told_in_one_line() -> None:
    with Path('/dev/full').open('w') as full:
        command = [sys.executable, '-m', 'ros2cli', 'topic', 'hz', '/none']
        ended = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert ended.returncode == 1
    assert ended.stderr.count('No space left on device') == 1, ended.stderr
    assert 'ignored' not in ended.stderr, 'of what Python tries again at its end'


def test_a_reader_that_has_seen_enough_ends_the_command_quietly() -> None:
    process = subprocess.Popen(
        [sys.executable, '-m', 'ros2cli', 'interface', 'list'],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    _, err = process.communicate()
    assert (process.returncode, err) == (128 + signal.SIGPIPE, '')
