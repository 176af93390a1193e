# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch arguments, conditions, groups and includes."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from launch import Condition, LaunchContext, LaunchDescription
from launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
)
from launch.conditions import IfCondition, LaunchConfigurationNotEquals
from launch.launch_description_sources import get_launch_description_from_any_launch_file
from launch.substitutions import LaunchConfiguration
import pytest

LaunchFile = Callable[..., Path]
Run = Callable[..., Any]


def _logged(output: str) -> list[str]:
    before = '[INFO] [launch.user]: '
    return [line[len(before) :] for line in output.splitlines() if line.startswith(before)]


def test_an_argument_has_its_default_or_what_is_given(
    python_launch_file: LaunchFile, run_launch: Run
) -> None:
    path = python_launch_file(
        """
        DeclareLaunchArgument('first', default_value='a'),
        DeclareLaunchArgument('second', default_value=[LaunchConfiguration('first'), 'b']),
        LogInfo(msg=[LaunchConfiguration('first'), ' ', LaunchConfiguration('second')]),
        """
    )
    assert _logged(run_launch(path).output) == ['a ab']
    assert _logged(run_launch(path, 'first:=x').output) == ['x xb']
    assert _logged(run_launch(path, 'first:=x', 'second:=').output) == ['x ']


def test_a_missing_argument_is_refused_before_anything_starts(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file(
        """
        ExecuteProcess(cmd=['echo', 'started']),
        DeclareLaunchArgument('speed', description='how fast'),
        """
    )
    launched = launch_here(path)
    assert launched.returncode == 1
    (line,) = [line for line in launched.lines if line.startswith('[ERROR]')]
    assert "missing required argument 'speed' (description: 'how fast'), given: []" in line
    assert 'process started' not in launched.output


def test_a_misspelt_argument_is_hinted_at(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file("DeclareLaunchArgument('viewer', default_value='on'),")
    launched = launch_here(path, 'viewr:=off', 'launch-prefix:=')
    (line,) = [line for line in launched.lines if 'WARNING' in line]
    assert line == (
        f"[WARNING] [launch]: launch argument 'viewr' is not declared in {path} "
        "(is 'viewer' meant?)"
    )


def test_an_argument_that_sets_nothing_is_told_of(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file(
        """
        DeclareLaunchArgument('lidar_rate_hz', default_value='0'),
        LogInfo(msg=LaunchConfiguration('undeclared')),
        """
    )
    launched = launch_here(path, 'undeclared:=here', 'sigterm_timeout:=5', 'lidar:=true')
    assert _logged(launched.output) == ['here']
    (line,) = [line for line in launched.lines if 'WARNING' in line]
    assert line == (
        f"[WARNING] [launch]: launch argument 'lidar' is not declared in {path} nor named there, "
        'so that it sets nothing (`--show-args` lists what does)'
    )
    outer = python_launch_file(f"IncludeLaunchDescription('{path}'),", 'outer.launch.py')
    assert 'WARNING' not in launch_here(outer, 'undeclared:=here').output


def test_a_file_that_starts_nothing_is_told_of(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file('')
    (line,) = [line for line in launch_here(path).lines if 'WARNING' in line]
    assert line == (
        f'[WARNING] [launch]: {path} starts nothing: no action has been added to its launch '
        'description'
    )


def test_a_file_that_includes_itself_is_told_of(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    again = """
        DeclareLaunchArgument('left', default_value='aaaa'),
        LogInfo(msg=LaunchConfiguration('left')),
        IncludeLaunchDescription(
            ThisLaunchFile(),
            launch_arguments={'left': PythonExpression(["'", left, "'[1:]"])}.items(),
            CONDITION
        ),
        """
    before = "left = LaunchConfiguration('left')"
    endless = python_launch_file(again.replace('CONDITION', ''), before=before)
    launched = launch_here(endless)
    assert launched.returncode == 1
    assert (
        f'a launch file includes itself without end: {endless} -> {endless}; ' in launched.output
    )
    condition = """condition=IfCondition(PythonExpression(["'", left, "' != ''"]))"""
    ends = python_launch_file(again.replace('CONDITION', condition), before=before)
    assert _logged(launch_here(ends).output) == ['aaaa', 'aaa', 'aa', 'a', '']


def test_a_value_outside_of_the_choices_is_refused_with_them(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file("DeclareLaunchArgument('mode', choices=['fast', 'slow']),")
    launched = launch_here(path, 'mode:=quick')
    assert launched.returncode == 1
    assert (
        'Argument "mode" provided value "quick" is not valid. Valid options are: '
        "['fast', 'slow']" in launched.output
    )
    assert launch_here(path, 'mode:=slow').returncode == 0


@pytest.mark.parametrize(
    ('value', 'ran'),
    [('true', 'if'), ('True', 'if'), ('1', 'if'), ('false', 'unless'), ('0', 'unless')],
)
def test_conditions_choose(
    value: str, ran: str, python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file(
        """
        LogInfo(msg='if', condition=IfCondition(LaunchConfiguration('on'))),
        LogInfo(msg='unless', condition=UnlessCondition(LaunchConfiguration('on'))),
        LogInfo(msg='equals', condition=LaunchConfigurationEquals('on', 'never')),
        LogInfo(msg='not equals', condition=LaunchConfigurationNotEquals('on', 'never')),
        """
    )
    assert _logged(launch_here(path, f'on:={value}').output) == [ran, 'not equals']


def test_a_condition_that_says_neither_is_refused(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file("LogInfo(msg='x', condition=IfCondition('maybe')),")
    launched = launch_here(path)
    assert launched.returncode == 1
    assert "expected one of [true, 1, false, 0] but got 'maybe'" in launched.output
    assert f'(at {path}:10)' in launched.output


INNER = """
DeclareLaunchArgument('name', default_value='inner'),
SetLaunchConfiguration('left_behind', 'yes'),
LogInfo(msg=['inside ', LaunchConfiguration('name'), ' ', ThisLaunchFile()]),
"""


def test_an_include_sets_arguments_and_knows_its_file(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    inner = python_launch_file(INNER, 'inner.launch.py')
    outer = python_launch_file(
        """
        IncludeLaunchDescription(
            [ThisLaunchFileDir(), '/inner.launch.py'], launch_arguments={'name': 'given'}.items()
        ),
        LogInfo(msg=['after ', LaunchConfiguration('name'), ' ',
                     LaunchConfiguration('left_behind'), ' ', ThisLaunchFile()]),
        """,
        'outer.launch.py',
    )
    launched = launch_here(outer)
    assert _logged(launched.output) == [f'inside given {inner}', f'after given yes {outer}']


def test_an_argument_of_an_include_is_refused_where_it_stands(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    python_launch_file(INNER, 'inner.launch.py')
    path = python_launch_file(
        """
        IncludeLaunchDescription(
            [ThisLaunchFileDir(), '/inner.launch.py'],
            launch_arguments={'name': LaunchConfiguration('unset')}.items(),
        ),
        """,
        'outer.launch.py',
    )
    line = path.read_text().split('\n').index('        IncludeLaunchDescription(') + 1
    told = f"launch configuration 'unset' does not exist (at {path}:{line})"
    assert told in launch_here(path).output


def test_a_group_keeps_an_include_to_itself(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    python_launch_file(INNER, 'inner.launch.py')
    outer = python_launch_file(
        """
        GroupAction([IncludeLaunchDescription([ThisLaunchFileDir(), '/inner.launch.py'])]),
        LogInfo(msg=[LaunchConfiguration('name', default='unset'), ' ',
                     LaunchConfiguration('left_behind', default='unset')]),
        """,
        'outer.launch.py',
    )
    assert _logged(launch_here(outer).output)[-1] == 'unset unset'


def test_scoping_and_forwarding_of_groups(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    show = (
        "LogInfo(msg=[LaunchConfiguration('a', default='-'), "
        "LaunchConfiguration('b', default='-'), EnvironmentVariable('V', default_value='-')])"
    )
    path = python_launch_file(
        f"""
        SetLaunchConfiguration('a', '1'), SetEnvironmentVariable('V', '1'),
        GroupAction([SetLaunchConfiguration('b', '2'), SetEnvironmentVariable('V', '2'), {show}]),
        {show},
        GroupAction([{show}], forwarding=False, launch_configurations={{'b': '3'}}),
        GroupAction([SetLaunchConfiguration('b', '4')], scoped=False),
        {show},
        UnsetLaunchConfiguration('b'), UnsetEnvironmentVariable('V'), {show},
        """
    )
    assert _logged(launch_here(path).output) == ['122', '1-1', '-3-', '141', '1--']


def test_a_condition_without_a_predicate_does_not_hold() -> None:
    assert Condition().evaluate(LaunchContext()) is False
    with pytest.warns(UserWarning, match='is deprecated: use IfCondition with EqualsSubst'):
        LaunchConfigurationNotEquals('mode', 'fast')


def test_appending_to_an_environment_variable(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file(
        """
        AppendEnvironmentVariable('LIST_OF', 'b'), AppendEnvironmentVariable('LIST_OF', 'c'),
        AppendEnvironmentVariable('LIST_OF', 'a', prepend=True),
        AppendEnvironmentVariable('LIST_OF', 'd', separator=';'),
        LogInfo(msg=EnvironmentVariable('LIST_OF')),
        """
    )
    assert _logged(launch_here(path).output) == ['a:b:c;d']
    action = AppendEnvironmentVariable('LIST_OF', 'a', prepend=True, separator=';')
    assert (action.prepend, action.separator[0].perform(LaunchContext())) == (True, ';')


def test_arguments_are_found_also_in_includes_and_groups(
    python_launch_file: LaunchFile,
) -> None:
    inner = python_launch_file(INNER, 'inner.launch.py')
    deep = python_launch_file("DeclareLaunchArgument('deep')", 'deep.launch.py')
    description = LaunchDescription(
        [
            DeclareLaunchArgument('top', description='at the top'),
            GroupAction(
                [DeclareLaunchArgument('maybe', default_value='x')],
                condition=IfCondition('true'),
            ),
            get_launch_description_from_any_launch_file(str(inner)),
            DeclareLaunchArgument('top', description='once more'),
            ExecuteProcess(cmd=['true'], on_exit=[DeclareLaunchArgument('after')]),
            *(
                IncludeLaunchDescription([*folder, '/deep.launch.py'])
                for folder in (
                    [LaunchConfiguration('folder', default=str(deep.parent))],
                    [LaunchConfiguration('folder')],  # not known before the launch
                    ['/no/such/folder'],
                )
            ),
        ]
    )
    arguments = description.get_launch_arguments()
    assert [argument.name for argument in arguments] == ['top', 'maybe', 'name', 'after', 'deep']
    assert arguments[0].description == 'at the top'
    assert arguments[1]._conditionally_included


def test_an_included_file_sees_the_environment_that_was_set_before(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    inner = python_launch_file(
        "LogInfo(msg=os.environ['MODEL_OF_ROBOT'])", 'inner.launch.py', 'import os'
    )
    path = python_launch_file(
        f"""
        SetEnvironmentVariable('MODEL_OF_ROBOT', 'burger'),
        IncludeLaunchDescription({str(inner)!r}),
        """
    )
    assert _logged(launch_here(path).output) == ['burger']


def test_a_missing_launch_file_is_one_line(launch_here: Run, tmp_path: Path) -> None:
    launched = launch_here(tmp_path / 'nothing.launch.py')
    assert launched.returncode == 1
    (line,) = [line for line in launched.lines if line.startswith('[ERROR]')]
    assert 'there is no such launch file' in line
    assert str(tmp_path / 'nothing.launch.py') in line
