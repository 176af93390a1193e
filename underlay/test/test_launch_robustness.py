# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Any text in launch files, arguments and parameter files: one line, never a traceback."""

import contextlib
from pathlib import Path
from typing import Any

from hypothesis import given, HealthCheck, note, settings, strategies
from launch import InvalidLaunchFileError, LaunchContext, LaunchDescription, LaunchService
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, LogInfo, OpaqueFunction
from launch.conditions import IfCondition
from launch.frontend import parse_substitution
from launch.launch_description_sources import get_launch_description_from_any_launch_file
from launch.substitutions import LaunchConfiguration
from launch_ros.descriptions import ParameterFile
from launch_ros.utilities import evaluate_parameters, normalize_parameters
import pytest
import yaml

_SETTINGS = settings(
    max_examples=250,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
_PIECES = [
    '$(',
    ')',
    '(',
    "'",
    '"',
    '\\',
    ' ',
    '$',
    'var',
    'env',
    'not',
    'x',
    'eval',
    '1',
    '{',
    ':',
]
_texts = strategies.lists(
    strategies.sampled_from(_PIECES) | strategies.text(max_size=3), max_size=12
).map(''.join)
_values = strategies.recursive(
    strategies.none()
    | strategies.booleans()
    | strategies.integers()
    | strategies.floats()
    | _texts,
    lambda inner: (
        strategies.lists(inner, max_size=3)
        | strategies.dictionaries(
            strategies.sampled_from(['node', 'arg', 'name', 'default', 'pkg', 'param', 'group'])
            | _texts,
            inner,
            max_size=3,
        )
    ),
    max_leaves=8,
)

pytestmark = pytest.mark.usefixtures('launch_environment')


def _run(capsys: pytest.CaptureFixture[str], *entities: Any) -> None:
    service = LaunchService()
    service.include_launch_description(LaunchDescription(entities))
    status = service.run()
    output = capsys.readouterr()
    assert status in (0, 1)
    assert 'Traceback' not in output.out + output.err
    assert (status == 1) == ('[ERROR] [launch]: Caught exception in launch' in output.out)


@_SETTINGS
@given(text=_texts)
def test_any_text_is_parsed_or_refused(text: str) -> None:
    with contextlib.suppress(ValueError, RuntimeError, TypeError, AttributeError):
        assert parse_substitution(text)


@_SETTINGS
@given(value=_values)
def test_any_yaml_is_a_launch_file_or_refused(value: Any, tmp_path: Path) -> None:
    path = tmp_path / 'any.launch.yaml'
    path.write_text(yaml.safe_dump({'launch': value}, allow_unicode=True))
    with contextlib.suppress(InvalidLaunchFileError):
        assert get_launch_description_from_any_launch_file(str(path)).entities is not None


@_SETTINGS
@given(data=strategies.binary(max_size=40) | _texts.map(str.encode))
def test_any_bytes_are_a_launch_file_or_refused(
    data: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ('any.launch.xml', 'any.launch.yaml', 'any.launch.py', 'any'):
        note(name)
        path = tmp_path / name
        path.write_bytes(data)
        _run(capsys, IncludeLaunchDescription(str(path)))


@_SETTINGS
@given(value=_texts)
def test_any_value_of_a_launch_argument_is_used_or_refused(
    value: str, capsys: pytest.CaptureFixture[str]
) -> None:
    def set_value(context: LaunchContext) -> None:
        context.launch_configurations['x'] = value

    _run(
        capsys,
        OpaqueFunction(function=set_value),
        DeclareLaunchArgument('x'),
        LogInfo(msg=LaunchConfiguration('x'), condition=IfCondition(LaunchConfiguration('x'))),
    )


@_SETTINGS
@given(value=_values, text=_texts)
def test_any_parameters_are_used_or_refused(
    value: Any, text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / 'any.yaml'
    path.write_text(text, encoding='utf-8', errors='replace')

    def evaluate(context: LaunchContext, parameters: Any) -> None:
        evaluate_parameters(context, normalize_parameters(parameters))

    for parameters in ([{'a': value}], [ParameterFile(str(path), allow_substs=True)]):
        _run(capsys, OpaqueFunction(function=evaluate, args=[parameters]))
