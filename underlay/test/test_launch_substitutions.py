# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Substitutions, from Python and from text."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from launch import LaunchContext
from launch.frontend import parse_if_substitutions, parse_substitution
from launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    LocalSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    PathSubstitution,
    PythonExpression,
    StringJoinSubstitution,
    SubstitutionFailure,
    TextSubstitution,
    ThisLaunchFileDir,
)
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch.utilities.type_utils import (
    coerce_to_type,
    normalize_typed_substitution,
    perform_typed_substitution,
)
import pytest

LaunchFile = Callable[..., Path]
Run = Callable[..., Any]

pytestmark = pytest.mark.usefixtures('launch_environment')


@pytest.fixture
def context() -> LaunchContext:
    return LaunchContext(argv=['x'])


def _perform(context: LaunchContext, value: Any) -> str:
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))


def test_a_configuration_may_default_to_substitutions(context: LaunchContext) -> None:
    context.launch_configurations['known'] = 'value'
    assert _perform(context, LaunchConfiguration('known')) == 'value'
    default = LaunchConfiguration('other', default=['a-', LaunchConfiguration('known')])
    assert _perform(context, default) == 'a-value'
    assert _perform(context, LaunchConfiguration('number', default=5)) == '5'


def test_an_unknown_configuration_is_refused_with_the_nearest(
    context: LaunchContext,
) -> None:
    context.launch_configurations['speed'] = '1'
    with pytest.raises(SubstitutionFailure, match=r"'sped' does not exist \(is 'speed' meant\?\)"):
        _perform(context, LaunchConfiguration('sped'))


def test_paths_and_joined_strings(context: LaunchContext) -> None:
    path = PathJoinSubstitution(['a', ['b', TextSubstitution(text='c')], 'd.txt'])
    assert _perform(context, path) == 'a/bc/d.txt'
    assert _perform(context, PathSubstitution('a') / 'b' / ['c', '.txt']) == 'a/b/c.txt'
    joined = StringJoinSubstitution(['a', ['b', 'c']], delimiter=', ')
    assert _perform(context, joined) == 'a, bc'


def test_environment_variables_are_read_when_performed(
    context: LaunchContext, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('A_TEST', 'x')
    assert _perform(context, EnvironmentVariable('A_TEST')) == 'x'
    assert _perform(context, EnvironmentVariable('NO_TEST', default_value='d')) == 'd'
    with pytest.raises(SubstitutionFailure, match="variable 'NO_TEST' does not exist"):
        _perform(context, EnvironmentVariable('NO_TEST'))


def test_executables_are_found_on_the_path(context: LaunchContext) -> None:
    assert Path(_perform(context, FindExecutable('sh'))).name == 'sh'
    with pytest.raises(SubstitutionFailure, match="executable 'no_such' not found on the PATH"):
        _perform(context, FindExecutable('no_such'))


def test_commands_give_their_output(context: LaunchContext) -> None:
    assert _perform(context, Command(['echo ', 'a b'])) == 'a b\n'
    with pytest.raises(SubstitutionFailure, match=r'executed command failed. Command: false'):
        _perform(context, Command('false'))
    with pytest.raises(SubstitutionFailure, match='file not found'):
        _perform(context, Command('no_such_program'))
    noisy = 'sh -c "echo out; echo err >&2"'
    with pytest.raises(SubstitutionFailure, match='showed stderr output'):
        _perform(context, Command(noisy))
    assert _perform(context, Command(noisy, on_stderr='ignore')) == 'out\n'
    assert _perform(context, Command(noisy, on_stderr='capture')) == 'out\nerr\n'
    with pytest.raises(SubstitutionFailure, match=r"'quiet', expected one of: fail, ignore, warn"):
        _perform(context, Command(noisy, on_stderr='quiet'))


def test_python_expressions_know_math_and_given_modules(context: LaunchContext) -> None:
    context.launch_configurations['n'] = '3'
    assert _perform(context, PythonExpression([LaunchConfiguration('n'), ' + floor(1.5)'])) == '4'
    words = PythonExpression(["os.path.join('a', 'b')"], python_modules=['os'])
    assert _perform(context, words) == 'a/b'
    with pytest.raises(SyntaxError, match=r"cannot evaluate .* '1 /': SyntaxError"):
        _perform(context, PythonExpression('1 /'))
    with pytest.raises(NameError, match=r"cannot evaluate .* 'floor\(1\)': NameError"):
        _perform(context, PythonExpression('floor(1)', python_modules=[]))


@pytest.mark.parametrize(
    ('substitution', 'expected'),
    [
        (NotSubstitution('true'), 'false'),
        (NotSubstitution('0'), 'true'),
        (AndSubstitution('true', '1'), 'true'),
        (AndSubstitution('true', 'off'), 'false'),
        (OrSubstitution('false', 'true'), 'true'),
        (AnySubstitution('false', 'no', 'yes'), 'true'),
        (AllSubstitution('true', 'false'), 'false'),
        (AllSubstitution(), 'true'),
        (EqualsSubstitution('1.0', '1'), 'true'),
        (EqualsSubstitution(True, '1'), 'true'),
        (EqualsSubstitution('a', 'A'), 'false'),
        (EqualsSubstitution(None, ''), 'true'),
        (NotEqualsSubstitution('a', 'b'), 'true'),
        (IfElseSubstitution('true', 'a', 'b'), 'a'),
        (IfElseSubstitution('false', 'a', 'b'), 'b'),
        (IfElseSubstitution('true', else_value='b'), ''),
        (IfElseSubstitution('false', if_value='a'), ''),
    ],
)
def test_logic(context: LaunchContext, substitution: Any, expected: str) -> None:
    assert _perform(context, substitution) == expected


def test_logic_refuses_what_is_neither_true_nor_false(context: LaunchContext) -> None:
    with pytest.raises(RuntimeError, match='One of if_value and else_value must be specified'):
        IfElseSubstitution('true')
    with pytest.raises(SubstitutionFailure, match='perhaps'):
        _perform(context, NotSubstitution('perhaps'))
    with pytest.raises(SubstitutionFailure, match='perhaps'):
        _perform(context, AnySubstitution('true', 'perhaps'))


def test_anonymous_names_are_unique_but_stay(context: LaunchContext) -> None:
    first = _perform(context, AnonName('a'))
    assert first.startswith('a_')
    assert _perform(context, AnonName('a')) == first
    assert _perform(LaunchContext(), AnonName('a')) != first


def test_files_and_folders(context: LaunchContext, tmp_path: Path) -> None:
    (tmp_path / 'file').write_text('content')
    assert _perform(context, FileContent(str(tmp_path / 'file'))) == 'content'
    with pytest.raises(SubstitutionFailure, match=r'File not found: .*none'):
        _perform(context, FileContent(str(tmp_path / 'none')))
    assert Path(_perform(context, LaunchLogDir())).parent == tmp_path / 'ros_log'
    with pytest.raises(SubstitutionFailure, match='used outside of a launch file'):
        _perform(context, ThisLaunchFileDir())
    context.extend_locals({'thing': ['x', 'y']})
    assert _perform(context, LocalSubstitution('thing[1]')) == 'y'


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('plain', 'plain'),
        ('', ''),
        ('a $(var x) b', 'a 1 b'),
        ('$(var x)$(var x)', '11'),
        ('$(var $(var name))', '1'),
        ('$(var missing $(var x)2)', '12'),
        ("$(eval '$(var x) + 1')", '2'),
        ("$(eval \"'$(var x)' == '1'\")", 'True'),
        (r'\$(var x)', '$(var x)'),
        (r'100\$', '100$'),
        ('5 $ and "quotes"', '5 $ and "quotes"'),
        ("$(env NO_SUCH_VARIABLE 'two words')", 'two words'),
        ('$(not $(equals $(var x) 1))', 'false'),
        ('$(if true yes no)', 'yes'),
        ('$(path-join a $(var x))', 'a/1'),
        ("$(string-join ', ' a b)", 'a, b'),
        ("$(command 'echo -n hi')", 'hi'),
        ("$(eval 'basename(\\'a/b\\')' posixpath)".replace('basename', 'posixpath.basename'), 'b'),
    ],
)
def test_text_with_substitutions(context: LaunchContext, text: str, expected: str) -> None:
    context.launch_configurations.update({'x': '1', 'name': 'x'})
    assert perform_substitutions(context, parse_substitution(text)) == expected


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('$(var x', r'missing \) at character 8 of: \$\(var x'),
        ('$(', 'expected the name of a substitution'),
        ('$(nothing_known x)', 'Unknown substitution: nothing_known'),
        ('$(vr x)', r"Unknown substitution: vr \(is 'var' meant\?\)"),
        ('$(var)', 'var substitution expects 1 or 2 arguments, got 0'),
        ("$(var 'x)", 'missing closing'),
        ('$(var a(b)', r'unexpected \('),
    ],
)
def test_text_that_is_not_well_formed_says_what_is_missing(text: str, message: str) -> None:
    with pytest.raises(Exception, match=message):
        parse_substitution(text)


@pytest.mark.parametrize(
    ('text', 'kind', 'value'),
    [
        ('1', int, 1),
        ('1', float, 1.0),
        ('1', bool, True),
        ('on', bool, True),
        ('1', str, '1'),
        ('[1, 2]', list[int], [1, 2]),
        ('[a, b]', list[str], ['a', 'b']),
        ('1.5', None, 1.5),
        ('', None, ''),
    ],
)
def test_text_becomes_the_wanted_type(text: str, kind: Any, value: Any) -> None:
    assert coerce_to_type(text, kind) == value


def test_a_list_of_whole_and_other_numbers_is_of_floats(context: LaunchContext) -> None:
    normalized = normalize_typed_substitution([1, 2.5, [TextSubstitution(text='3.0')]], None)
    assert perform_typed_substitution(context, normalized, list[float]) == [1.0, 2.5, 3.0]
    with pytest.raises(TypeError, match='expected list'):
        normalize_typed_substitution([1, 2], list[float])


def test_text_that_does_not_mean_the_type_is_refused(context: LaunchContext) -> None:
    with pytest.raises(ValueError, match='Cannot convert value'):
        coerce_to_type('maybe', bool)
    with pytest.raises(ValueError, match='yaml'):
        coerce_to_type('[1, ', None)
    with pytest.raises(ValueError, match='yaml'):
        coerce_to_type('[1, 2.0]', None)
    with pytest.raises(ValueError, match='not of one type, but float and int'):
        parse_if_substitutions(['$(var x)', 1, 2.0])
    with pytest.raises(TypeError, match='is not an instance of'):
        perform_typed_substitution(context, 1.0, int)
    with pytest.raises(ValueError, match='not of one type'):
        perform_typed_substitution(context, [1, 'a'], None)


def test_anything_else_than_text_is_refused() -> None:
    normalize: Callable[[Any], Any] = normalize_to_list_of_substitutions
    with pytest.raises(TypeError, match='5 of type int is neither text nor a Substitution'):
        normalize(['a', 5])


def test_a_substitution_in_an_f_string_is_told(launch_file: LaunchFile, run_launch: Run) -> None:
    path = launch_file(
        """
        from launch import LaunchDescription
        from launch.actions import LogInfo, OpaqueFunction
        from launch.substitutions import LaunchConfiguration

        def late(context):
            return [LogInfo(msg=[f'late {LaunchConfiguration("x").perform(context)}'])]

        def generate_launch_description():
            said = LogInfo(msg=f'x is {LaunchConfiguration("x", default="5")}')
            return LaunchDescription([said, OpaqueFunction(function=late)])
        """
    )
    output = run_launch(path, 'x:=1').output
    assert output.count('[WARNING]') == 1
    assert (
        f'[WARNING] [launch]: {path}:10: a LaunchConfiguration has no text before the launch, so '
        "that an f-string or str() does not help: write a list, ['text', LaunchConfiguration(...)]"
    ) in output
    assert 'late 1' in output
