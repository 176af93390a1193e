# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of nodes in launch files: their types, and what is refused."""

import io
import os
from pathlib import Path
from typing import Any

from launch import LaunchContext
from launch.frontend import Parser
from launch.substitutions import LaunchConfiguration, TextSubstitution
from launch_ros.actions import Node, SetParameter, SetParametersFromFile
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
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


def test_a_set_parameter_tells_its_name_and_value() -> None:
    action = SetParameter('a', LaunchConfiguration('x'))
    described = [sub.describe() for sub in (*action.name, *action.value)]
    assert described == ["'a'", "LaunchConfig('x')"]


def test_quotes_keep_what_is_put_into_a_parameter_file_text(
    tmp_path: Path, launch_environment: None
) -> None:
    del launch_environment
    context = LaunchContext()
    context.launch_configurations['x'] = '1'
    file = tmp_path / 'parameters.yaml'
    file.write_text("{text: '$(var x)', number: $(var x)}")
    parameters = ParameterFile(file, allow_substs=True)
    path = parameters.evaluate(context)
    assert path.read_text() == "{text: '1', number: 1}"
    parameters.cleanup()
    assert not path.exists()


def test_a_missing_file_of_set_parameters_is_told_when_a_node_starts(
    launch_environment: None,
) -> None:
    del launch_environment
    context = LaunchContext()
    SetParametersFromFile('/no/such.yaml').execute(context)
    assert context.launch_configurations['global_params'] == ['/no/such.yaml']
    with pytest.raises(FileNotFoundError, match=r"'/no/such\.yaml' of SetParametersFromFile"):
        Node(executable='x')._perform_substitutions(context)


def test_text_that_no_node_starts_with_is_refused(launch_environment: None) -> None:
    del launch_environment
    context = LaunchContext()
    SetParameter('a', 'b: c').execute(context)
    with pytest.raises(ValueError, match="SetParameter 'a' has 'b: c', which is no value"):
        Node(executable='x')._perform_substitutions(context)
    context = LaunchContext()
    context.launch_configurations['x'] = '1,5'
    value = ParameterValue(LaunchConfiguration('x'), value_type=float)
    with pytest.raises(ValueError, match="parameter 'speed': could not convert string to float: "):
        Node(executable='x', parameters=[{'speed': value}])._perform_substitutions(context)


def test_a_relative_log_folder_is_below_the_present_one(launch_environment: None) -> None:
    del launch_environment
    before = os.environ['ROS_LOG_DIR']
    xml = '<launch><set_ros_log_dir new_log_dir="run"/></launch>'
    root, parser = Parser.load(io.StringIO(xml))
    (action,) = parser.parse_description(root).entities
    action.visit(LaunchContext())
    assert os.environ['ROS_LOG_DIR'] == f'{before}/run'


def test_set_parameter_refuses_what_no_parameter_can_have() -> None:
    with pytest.raises(TypeError, match='Unexpected type for parameter value None'):
        SetParameter('a', None)
