# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files in XML and YAML."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from launch import InvalidLaunchFileError, LaunchContext
from launch.actions import LogInfo
from launch.launch_description_sources import get_launch_description_from_any_launch_file
from launch.source_location import describe_error
from launch.utilities import perform_substitutions
from launch_xml.launch_description_sources import XMLLaunchDescriptionSource
from launch_yaml.launch_description_sources import YAMLLaunchDescriptionSource
import pytest

LaunchFile = Callable[..., Path]
Run = Callable[..., Any]


def _logged(output: str) -> list[str]:
    before = '[INFO] [launch.user]: '
    return [line[len(before) :] for line in output.splitlines() if line.startswith(before)]


XML = """
    <launch>
      <!-- everything at once -->
      <arg name="mode" default="slow" description="how">
        <choice value="slow"/>
        <choice value="fast"/>
      </arg>
      <let name="greeting" value="hello $(var mode)"/>
      <log message="$(var greeting)"/>
      <group forwarding="false">
        <keep name="mode" value="kept $(var mode)"/>
        <log message="$(var mode) $(var greeting gone)"/>
      </group>
      <set_env name="COLOUR" value="red"/>
      <group if="$(equals $(var mode) fast)">
        <log message="quick"/>
      </group>
      <group unless="$(equals $(var mode) fast)" scoped="$(not false)">
        <let name="greeting" value="inside"/>
        <log message="$(var greeting)"/>
      </group>
      <log message="$(var greeting) $(env COLOUR) $(dirname)"/>
      <executable cmd="sh -c 'echo $COLOUR $SHAPE $(var mode)' $(var mode)ly"
                  output="screen" name="shell">
        <env name="SHAPE" value="round"/>
      </executable>
      <timer period="0.05" cancel_on_shutdown="$(not true)"><log message="later"/></timer>
      <include file="$(dirname)/inner.launch.yaml">
        <arg name="who" value="$(var mode)"/>
      </include>
      <for len="2" name="i">
        <log message="turn $(index i)"/>
        <timer period="0.1"><log message="later turn $(index i)"/></timer>
      </for>
      <for_each values="{x: a}; {x: b}"><log message="each $(for-var x)"/></for_each>
    </launch>
"""
YAML = """
    launch:
      - arg: {name: who, default: nobody}
      - log: {message: 'for $(var who) in $(filename)'}
      - group:
          - let: {name: who, value: changed}
          - log: {message: $(var who)}
      - group:
          scoped: true
          if: 'false'
          children:
            - log: {message: never}
      - executable:
          cmd: echo from yaml
          output: screen
          emulate_tty: true
          sigterm_timeout: 1.0
          respawn: 'false'
          respawn_delay: 1.0
          env:
            - {name: A, value: b}
"""


def test_xml_and_yaml_files_do_what_they_say(
    launch_file: LaunchFile, run_launch: Run, tmp_path: Path
) -> None:
    path = launch_file(XML, 'outer.launch.xml')
    inner = launch_file(YAML, 'inner.launch.yaml')
    launched = run_launch(path)
    assert launched.returncode == 0, launched.output
    assert _logged(launched.output) == [
        'hello slow',
        'kept slow gone',
        'inside',
        f'hello slow red {tmp_path}',
        f'for slow in {inner}',
        'changed',
        'turn 0',
        'turn 1',
        'each a',
        'each b',
        'later',
        'later turn 0',
        'later turn 1',
    ]
    assert '[shell-1] red round slow' in launched.lines
    assert '[echo-2] from yaml' in launched.lines
    fast = _logged(run_launch(path, 'mode:=fast').output)
    assert fast[:3] == ['hello fast', 'kept fast gone', 'quick']


def test_variables_of_a_turn_end_with_it(launch_file: LaunchFile, launch_here: Run) -> None:
    launched = launch_here(
        launch_file(
            """
            <launch>
              <for len="1" name="x">
                <for_each values="{x: a, y: 1}; {x: b}">
                  <log message="$(for-var x) $(for-var y none)"/>
                </for_each>
                <log message="$(index x)"/>
              </for>
              <log message="$(for-var x gone)"/>
            </launch>
            """,
            'test.launch.xml',
        )
    )
    assert _logged(launched.output) == ['a 1', 'b none', '0', 'gone']


def test_sources_of_xml_and_yaml_can_be_included(
    launch_file: LaunchFile, run_launch: Run, tmp_path: Path
) -> None:
    launch_file('<launch><log message="xml"/></launch>', 'a.xml')
    launch_file('launch:\n- log: {message: yaml}\n', 'b.yaml')
    path = launch_file(
        f"""
        from launch import LaunchDescription
        from launch.actions import IncludeLaunchDescription
        from launch_xml.launch_description_sources import XMLLaunchDescriptionSource
        from launch_yaml.launch_description_sources import YAMLLaunchDescriptionSource

        def generate_launch_description():
            return LaunchDescription([
                IncludeLaunchDescription(XMLLaunchDescriptionSource('{tmp_path}/a.xml')),
                IncludeLaunchDescription(YAMLLaunchDescriptionSource('{tmp_path}/b.yaml')),
            ])
        """
    )
    assert _logged(run_launch(path).output) == ['xml', 'yaml']
    assert XMLLaunchDescriptionSource('x').method == 'interpreted XML launch file'
    assert YAMLLaunchDescriptionSource('x').method == 'interpreted YAML launch file'


def test_arguments_of_markup_files_can_be_listed(launch_file: LaunchFile) -> None:
    path = launch_file(XML, 'outer.launch.xml')
    description = get_launch_description_from_any_launch_file(str(path))
    (mode,) = description.get_launch_arguments()
    assert (mode.name, mode.choices) == ('mode', ['slow', 'fast'])
    assert mode.description == "how. Valid choices are: ['slow', 'fast']"


@pytest.mark.parametrize(
    ('text', 'line', 'message'),
    [
        ('<launch>\n<nod/></launch>', 2, r"Unrecognized entity of the type: nod \(is 'node' mean"),
        ('<launch>\n\n<log/></launch>', 3, "Attribute 'message' of type 'str' not found in Enti"),
        ('<launch>\n<log message="" x=""/></launch>', 2, r'Unexpected attribute\(s\) .*`log`: x'),
        ('<launch>\n<log message=""><x/></log></launch>', 2, r'Unexpected nested tag\(s\) .* x'),
        ('<launch>\n<log>hi</log></launch>', 2, "Attribute 'message' of type 'str' not found in"),
        ('<launch>\n<log\n</launch>', 3, 'XML syntax error: not well-formed'),
        ('<launch>\n<log message="$(var"/></launch>', 2, 'missing \\)'),
        ('<launch>\n<group if="1" unless="1"/></launch>', 2, "can't be used simultaneously"),
        ('<launch>\n<executable cmd="x" respawn_delay="soon"/></launch>', 2, 'respawn_delay'),
        ('<launch>\n<rosparam/></launch>', 2, r'of ROS 1: write <param from="FILE"/> inside'),
        ('<launch>\n<log message="$(arg x)"/></launch>', 2, r'of ROS 1: write \$\(var NAME\)'),
        ('<launch>\n<node pkg="a" type="b"/></launch>', 2, 'type of ROS 1 is exec now'),
        ('<launch>\n<arg name="a" value="1"/></launch>', 2, 'value of ROS 1 is default now'),
        ('<launch>\n<group ns="a"/></launch>', 2, 'ns of ROS 1 is <push_ros_namespace namespace='),
        ('<launch>\n<include file="a" ns="b"/></launch>', 2, 'ns of ROS 1 is a <group> around it'),
        ('<launch>\n<node pkg="a" exec="b" required="1"/></launch>', 2, 'is on_exit="shutdown" n'),
        ('<start/>', 1, "Expected 'launch' as root tag, got 'start'"),
    ],
)
def test_errors_in_xml_name_file_and_line(
    text: str, line: int, message: str, launch_file: LaunchFile, run_launch: Run
) -> None:
    path = launch_file(text, 'bad.launch.xml')
    if 'respawn_delay' in text:  # its text may be a substitution, so that it is read when run
        launched = run_launch(path)
        assert "respawn_delay is 'soon': it is a time in seconds" in launched.output
        assert f'(at {path}:{line})' in launched.output
        return
    with pytest.raises(InvalidLaunchFileError, match=message) as caught:
        get_launch_description_from_any_launch_file(str(path))
    assert describe_error(caught.value).endswith(f'(at {path}:{line})')


def test_text_between_xml_elements_is_passed_over(
    launch_file: LaunchFile, run_launch: Run
) -> None:
    path = launch_file('<launch>\n<!-- a --> -->\n<log message="b"> c\nd</log></launch>', 'a.xml')
    output = run_launch(path).output
    assert _logged(output) == ['b']
    for where in ("2: text '-->' in element 'launch'", "3: text 'c' in element 'log'"):
        assert f'[WARNING] [launch]: {path}:{where} is passed over: values are attr' in output


def test_a_key_that_is_given_twice_is_told(launch_file: LaunchFile, run_launch: Run) -> None:
    path = launch_file('launch:\n- log: {message: a, message: b}', 'a.launch.yaml')
    output = run_launch(path).output
    assert _logged(output) == ['b']
    assert f"[WARNING] [launch]: {path}:2: 'message' is given twice: the last counts" in output


@pytest.mark.parametrize(
    ('text', 'line', 'message'),
    [
        ('launch:\n- arg: {name: a, default: 1}', 2, "type 'str', got 1: put it in quotes"),
        ('launch:\n- log: {message: a, mesage: b}', 2, r'Unexpected key\(s\) .*`log`: mesage'),
        ('launch:\n- log: {message: a}\n- node', 1, 'dictionaries with a single key'),
        ('launch:\n  log: {message: a}', 1, "to have 'children'"),
        ('launch:\n- log: {message: a', 2, 'YAML syntax error'),
        ('launch:\n- log: text', 2, "'log' is 'text', expected its attributes"),
        ('launch: []\nother: []', None, "one mapping, with the key 'launch:'"),
    ],
)
def test_errors_in_yaml_name_file_and_line(
    text: str, line: int | None, message: str, launch_file: LaunchFile
) -> None:
    path = launch_file(text, 'bad.launch.yaml')
    with pytest.raises(InvalidLaunchFileError, match=message) as caught:
        get_launch_description_from_any_launch_file(str(path))
    if line is not None:
        assert describe_error(caught.value).endswith(f'(at {path}:{line})')


@pytest.mark.parametrize(
    ('text', 'line', 'message'),
    [
        ('def generate_launch_description():\n    return [1 2]', 2, 'SyntaxError'),
        ('def generate_launch_description():\n    {}["x"]', 2, "KeyError: 'x'"),
        ('x = 1', None, "required function 'generate_launch_description"),
        ('def generate_launch_description():\n    pass', None, 'returns None, not a LaunchDescr'),
    ],
)
def test_errors_in_python_name_file_and_line(
    text: str, line: int | None, message: str, launch_file: LaunchFile
) -> None:
    path = launch_file(text, 'bad.launch.py')
    with pytest.raises(InvalidLaunchFileError, match=message) as caught:
        get_launch_description_from_any_launch_file(str(path))
    assert str(path) in describe_error(caught.value)
    if line is not None:
        assert describe_error(caught.value).endswith(f'(at {path}:{line})')


@pytest.mark.parametrize(
    ('text', 'name'),
    [
        ('<launch version="0.1.0"><log message="b"/></launch>', 'a.launch.xml'),
        ('<launch>stray><log message="b"/>></launch>', 'a.launch.xml'),
        ('launch:\n- log: &a {message: a}\n- log: {<<: *a, message: b}', 'a.launch.yaml'),
        ('launch:\n  version: 1\n  children: [{log: {message: b}}]', 'a.launch.yaml'),
    ],
)
def test_what_upstream_passes_over_is_no_error(
    text: str, name: str, launch_file: LaunchFile
) -> None:
    path = launch_file(text, name)
    log = get_launch_description_from_any_launch_file(str(path)).entities[-1]
    assert isinstance(log, LogInfo)
    assert perform_substitutions(LaunchContext(), log.msg) == 'b'


@pytest.mark.parametrize('name', ['a.launch.py', 'a.launch.xml', 'a.launch.yaml'])
def test_a_file_in_utf_16_is_told(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_text('launch:', encoding='utf-16')
    with pytest.raises(InvalidLaunchFileError, match='it is saved as UTF-16') as caught:
        get_launch_description_from_any_launch_file(str(path))
    assert describe_error(caught.value).endswith(f'save it as UTF-8 (at {path}:1)')


@pytest.mark.parametrize('encoding', ['ISO-8859-1', 'UTF-16', 'unknown'])
def test_an_xml_file_is_utf_8_whatever_it_declares(encoding: str, launch_file: LaunchFile) -> None:
    text = f'<?xml version="1.0" encoding="{encoding}"?><launch><log message="grün"/></launch>'
    path = launch_file(text, 'declared.launch.xml')
    (log,) = get_launch_description_from_any_launch_file(str(path)).entities
    assert isinstance(log, LogInfo)
    assert perform_substitutions(LaunchContext(), log.msg) == 'grün'


def test_a_file_of_no_known_name_is_tried_in_each_format(launch_file: LaunchFile) -> None:
    path = launch_file('launch:\n- log: {message: a}\n', 'whatever')
    assert len(get_launch_description_from_any_launch_file(str(path)).entities) == 1
    path = launch_file('launch:\n- log: {message: a}\n', 'yaml_inside.launch')
    assert len(get_launch_description_from_any_launch_file(str(path)).entities) == 1
    path = launch_file('launch: [', 'nothing')
    with pytest.raises(InvalidLaunchFileError, match='may have a syntax error, or its format is'):
        get_launch_description_from_any_launch_file(str(path))
