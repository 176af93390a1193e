# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 run` says which words behind a program ROS refuses or passes over, and why."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import sys
from typing import Any

import pytest
from ros2_diagnosis import parameter_files, ros_arguments

_STARTS = f"""#!{sys.executable}
import sys
import rclpy
try:
    rclpy.init()
except Exception as error:  # the traceback is that of any node, and not what is looked at here
    sys.exit(f'the node ended: {{error}}')
rclpy.create_node('talker').destroy_node()
rclpy.shutdown()
"""
_WRITE = 'write NODE: ros__parameters: NAME: VALUE, each on a line of its own, two blanks deeper'


@pytest.mark.parametrize(
    ('words', 'told'),
    [
        ('-r chatter=other', '-r chatter=other: there is no := in it; write `-r chatter:=other`'),
        ('-p use_sim_time=true', 'write `-p use_sim_time:=true`'),
        ('-p rate: 5.0', '-p rate:: there is no := in it; write `-p NAME:=VALUE`, in one word'),
        ('-p rate:=', '-p rate:=: nothing stands behind :=; write `-p NAME:=VALUE`'),
        ('-p start:=[1.0, 3.0]', "at each blank; write the whole in quotes, `-p 'start:=[A, B]'`"),
        ('-r', '-r: nothing stands behind it; write `-r OLD:=NEW`'),
        ('--log-level', '--log-level: nothing stands behind it'),
        ('-r __ns:=robot', 'a namespace begins with /; write `-r __ns:=/robot`'),
        ('-r talker:__ns:=robot', 'write `-r talker:__ns:=/robot`'),
        ('-r __node:=my-node', 'write `-r __node:=my_node`'),
        ('-r __node:=2nd', 'write `-r __node:=_2nd`'),
        ('-r chatter:=my-topic', "'my-topic' is no name for ROS, which takes letters"),
        ('__node:=other', '__node:=other: no option stands before it; write `-r __node:=other`'),
        ('rate:=5.0', 'write `-p rate:=5.0` for a parameter, `-r rate:=5.0` for another name'),
        ('--param-file x', "ROS has no such option; did you mean '--params-file' or '--param'?"),
        ('left', 'stands before --ros-args, or behind --'),
        ('--params-file none.yaml', '--params-file none.yaml: there is no such file in '),
    ],
)
def test_what_a_node_cannot_read_is_explained(
    installed_package: Callable[..., Path], ros2: Callable[..., Any], words: str, told: str
) -> None:
    installed_package('demo', talker=_STARTS)
    answer = ros2('run', 'demo', 'talker', '--ros-args', *words.split())
    hints = [line for line in answer.err.splitlines() if line.startswith('hint: ')]
    assert len(hints) == 1, answer
    assert told in hints[0]
    assert 'the node ended: ' in answer.err, 'it has read them'


@pytest.mark.parametrize(
    ('text', 'told'),
    [
        ('/a:\n\tros__parameters:\n\t\tb: 1\n', 'line 2 begins with a tab'),
        ('/a:\n  b: 1\n', f'line 2: b stands below no ros__parameters; {_WRITE}'),
        ('b: 1\n', 'line 1: b stands below no ros__parameters'),
        ('/a:\n  ros_parameters:\n    b: 1\n', 'b stands below ros_parameters; call that ros__p'),
        ('/a:\nros__parameters:\n  b: 1\n', 'line 1: nothing stands below /a'),
        ('/a:\n  ros__parameters:\n  b: 1\n', 'line 2: nothing stands below ros__parameters'),
        ('ros__parameters:\n  b: 1\n', 'line 1: ros__parameters stands below no node'),
        ('/a:\n  ros__parameters:\n    b:1\n', "line 3: 'b:1' is no NAME: VALUE"),
        ('/a:\n  ros__parameters:\n    b: [1, 2.0]\n', 'line 3: b has whole numbers and others'),
        (
            '/a:\n  ros__parameters:\n    c: {b: [1, true]}\n',
            'b has whole numbers and true or fal',
        ),
        ('/a:\n  ros__parameters:\n    b: ["1", 2]\n', 'write values of one type, texts in quo'),
        ('/a:\n  ros__parameters:\n    b:\n    c: 1\n', 'line 3: nothing stands behind b; wri'),
        ('/a-b:\n  ros__parameters:\n    c: 1\n', 'line 1: /a-b is no name of a node; call '),
        ('/a:\n  ros__parameters:\n    b: \xe4\n', 'it is no UTF-8; save it as UTF-8'),
        ('/a:\n  ros__parameters:\n    b: 1\n   c: 1\n', 'line 4 is no YAML: expected <block'),
        ('/a:\n  ros__parameters:\n    b: "1\n', 'is no YAML: found unexpected end of stream'),
    ],
)
def test_a_parameter_file_that_no_node_reads_is_explained(
    installed_package: Callable[..., Path],
    ros2: Callable[..., Any],
    tmp_path: Path,
    text: str,
    told: str,
) -> None:
    installed_package('demo', talker=_STARTS)
    file = tmp_path / 'parameters.yaml'
    file.write_text(text, encoding='latin-1')
    answer = ros2('run', 'demo', 'talker', '--ros-args', '--params-file', str(file))
    assert told in answer.err.splitlines()[0].removeprefix(f'hint: --params-file {file}: ')
    assert 'the node ended: ' in answer.err, 'it has read the file'


def test_what_a_node_takes_is_not_complained_of(
    installed_package: Callable[..., Path], ros2: Callable[..., Any], tmp_path: Path
) -> None:
    installed_package('demo', talker=_STARTS)
    files = []
    for number, text in enumerate(
        (
            '',
            '# nothing\n',
            '/a: {ros__parameters: {}}\n',
            '/**:\n  b:\n    ros__parameters:\n      c: {d: [1.0, 2.0], e: "", f: [1, 2]}\n',
            'a:\n ros__parameters:\n  a: [1.0, 1e5]\n  b:\n  - 12:30\n  - x\n  c: [on, y]\n  d: 1',
            'a: {ros__parameters: {a: 1}}\n---\nb: {ros__parameters: {a: 1}}\n',
            'talker: {ros__parameters: {a: 1}}\n/robot/b: {ros__parameters: {a: [u, v]}}\n',
        )
    ):
        file = tmp_path / f'{number}.yaml'
        file.write_text(text)
        files += ['--params-file', str(file)]
    words = (
        *('--ros-args', '-p', 'rate:=5', '-p', 'talker:text:=a=b', '--param', 'a.b:="x-y: z"'),
        *('-r', '__node:=me', '-r', 'talker:chatter:=/a/b', '--remap', '~/x:=y', '-r', '__ns:=/a'),
        *('-r', 'rosservice://a:=b', '--log-level', 'debug', '--disable-rosout-logs', *files),
        *('--', 'left', 'x:=y', '--ros-args', '-p', 'c:=1'),
    )
    answer = ros2('run', 'demo', 'talker', *words)
    assert answer.status == 0, answer
    assert 'hint: ' not in answer.err


@pytest.mark.parametrize(
    ('words', 'told'),
    [
        ('-p rate:=5.0', 'write `ros2 run demo talker --ros-args -p rate:=5.0`'),
        ('--ros-arg -r a:=b', 'write `ros2 run demo talker --ros-args -r a:=b`'),
        ('--params-file p.yaml', 'write `ros2 run demo talker --ros-args --params-file p.yaml`'),
        ('rate:=5', 'write `--ros-args -p rate:=5` for a parameter, `--ros-args -r rate:=5` for '),
        ('--ros-args -p a:=1 -- -p b:=1', 'write `ros2 run demo talker --ros-args -p b:=1`'),
        ('use_sim_time:=true', 'without --ros-args ROS takes this for another name, and never'),
        ('-r a:=/b/c', '-r a:=/b/c: without --ros-args ROS takes this for another name'),
        ('__node:=other', 'and never for a parameter; write `--ros-args -r __node:=other`\n'),
        ('__node:=2nd', 'ROS takes parameters and other names behind --ros-args alone; write `--'),
        ('-p 8080', ''),
        ('a b=c --name x', ''),
    ],
)
def test_what_stands_before_no_ros_args_is_told(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    words: str,
    told: str,
) -> None:
    index = tmp_path / 'install/demo/share/ament_index/resource_index/packages'
    index.mkdir(parents=True)
    (index / 'demo').touch()
    source = tmp_path / 'src' / 'demo'
    source.mkdir(parents=True)
    manifest = source / 'package.xml'
    manifest.write_text('<package><name>demo</name></package>')
    monkeypatch.setenv('AMENT_PREFIX_PATH', str(tmp_path / 'install/demo'))
    ros_arguments.print_hints('demo', 'talker', words.split())
    err = capsys.readouterr().err
    assert err.count('hint: ') == bool(told)
    assert told in err
    # The lab's own programs refuse such words themselves.
    manifest.write_text('<name>demo</name><exec_depend>husky_runtime</exec_depend>')
    ros_arguments.print_hints('demo', 'talker', words.split())
    assert capsys.readouterr().err == ''


@pytest.mark.parametrize('word', ['chatter:=other', 'a:=/b/c', 'use_sim_time:=true', '__ns:=/a'])
def test_what_is_said_to_be_taken_for_a_name_is(
    installed_package: Callable[..., Path], ros2: Callable[..., Any], word: str
) -> None:
    installed_package('demo', talker=_STARTS)
    answer = ros2('run', 'demo', 'talker', word)
    assert answer.status == 0, answer
    assert f"Found remap rule '{word}'" in answer.err


def test_a_near_name_is_offered_for_a_missing_file(tmp_path: Path) -> None:
    (tmp_path / 'husky.yaml').touch()
    why = parameter_files.why_refused(tmp_path / 'huksy.yaml')
    assert why == (
        f"there is no such file in {tmp_path}; did you mean 'husky.yaml'?",
        'mend its path',
    )
