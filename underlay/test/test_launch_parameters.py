# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of nodes in launch files: their types, and what is refused."""

from pathlib import Path
from typing import Any

from launch import LaunchContext
from launch.substitutions import LaunchConfiguration, TextSubstitution
from launch_ros.actions import Node, SetParameter
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.utilities import evaluate_parameters, normalize_parameters
import pytest


def test_parameter_values_keep_or_get_their_types(launch_environment: None) -> None:
    del launch_environment
    context = LaunchContext()
    context.launch_configurations.update(x='1', empty='')
    x = LaunchConfiguration('x')
    given = {
        'plain': '1',
        'yaml': x,
        'joined': [x, '.5'],
        'list': [[x], [x, '0']],
        'typed': ParameterValue(x, value_type=bool),
        'typed_list': ParameterValue([x, 'a'], value_type=str),
        'text': [TextSubstitution(text='a'), TextSubstitution(text='b')],
        'bytes': b'x',
        'empty': LaunchConfiguration('empty'),
    }
    (values,) = evaluate_parameters(context, normalize_parameters([given]))
    assert values == {
        'plain': '1',
        'yaml': 1,
        'joined': 1.5,
        'list': (1, 10),
        'typed': True,
        'typed_list': '1a',
        'text': 'ab',
        'bytes': b'x',
        'empty': '',
    }


@pytest.mark.parametrize(
    'parameters',
    ['file.yaml', {'a': 1}, ({'a': 1},), [5], [{'a': None}], [{'a': {1}}], [{'a': Path('/a')}]],
)
def test_wrong_parameters_are_refused_when_written(parameters: Any) -> None:
    with pytest.raises(TypeError):
        Node(package='a', executable='b', parameters=parameters)


def test_set_parameter_refuses_what_no_parameter_can_have() -> None:
    with pytest.raises(TypeError, match='Unexpected type for parameter value None'):
        SetParameter('a', None)
