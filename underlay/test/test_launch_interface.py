# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The names that launch files import from Jazzy's launch and launch_ros."""

import importlib
import inspect
import subprocess
import sys

from launch.actions import DeclareLaunchArgument, ExecuteProcess, GroupAction, TimerAction
from launch_ros.actions import LifecycleNode, Node
import pytest

NAMES = {
    'launch': 'Action Condition Event EventHandler LaunchContext LaunchDescription '
    'LaunchDescriptionEntity LaunchDescriptionSource LaunchIntrospector LaunchService '
    'SomeSubstitutionsType SomeSubstitutionsType_types_tuple Substitution actions conditions '
    'event_handlers events frontend launch_description_sources logging substitutions',
    'launch.actions': 'AppendEnvironmentVariable DeclareLaunchArgument EmitEvent ExecuteLocal '
    'ExecuteProcess GroupAction IncludeLaunchDescription LogInfo OpaqueCoroutine OpaqueFunction '
    'PopEnvironment PopLaunchConfigurations PushEnvironment PushLaunchConfigurations '
    'RegisterEventHandler ResetEnvironment ResetLaunchConfigurations SetEnvironmentVariable '
    'SetLaunchConfiguration Shutdown TimerAction UnregisterEventHandler '
    'UnsetEnvironmentVariable UnsetLaunchConfiguration',
    # where editors find names that upstream's modules import
    'launch.actions.execute_local': 'EmitEvent ExecuteLocal LaunchConfiguration OnProcessExit '
    'OnProcessStart PythonExpression TimerAction',
    'launch.launch_description': 'DeclareLaunchArgument LaunchDescription',
    'launch.conditions': 'IfCondition UnlessCondition LaunchConfigurationEquals '
    'LaunchConfigurationNotEquals InvalidConditionExpressionError evaluate_condition_expression',
    'launch.event_handlers': 'OnActionEventBase OnExecutionComplete OnProcessExit OnProcessIO '
    'OnProcessStart OnShutdown event_named',
    'launch.events': 'ExecutionComplete IncludeLaunchDescription Shutdown TimerEvent '
    'matches_action process',
    'launch.events.process': 'ProcessExited ProcessIO ProcessStarted ProcessStderr ProcessStdin '
    'ProcessStdout ProcessTargetedEvent RunningProcessEvent ShutdownProcess SignalProcess '
    'matches_executable matches_name matches_pid',
    'launch.frontend': 'Entity Parser InvalidFrontendLaunchFileError expose_action '
    'expose_substitution',
    'launch.launch_description_sources': 'AnyLaunchDescriptionSource '
    'FrontendLaunchDescriptionSource PythonLaunchDescriptionSource InvalidLaunchFileError '
    'InvalidPythonLaunchFileError InvalidFrontendLaunchFileError '
    'get_launch_description_from_any_launch_file get_launch_description_from_frontend_launch_file '
    'get_launch_description_from_python_launch_file load_python_launch_file_as_module',
    'launch.substitutions': 'AllSubstitution AndSubstitution AnonName AnySubstitution Command '
    'EnvironmentVariable EqualsSubstitution FileContent FindExecutable IfElseSubstitution '
    'LaunchConfiguration LaunchLogDir LocalSubstitution NotEqualsSubstitution NotSubstitution '
    'OrSubstitution PathJoinSubstitution PythonExpression SubstitutionFailure TextSubstitution '
    'ThisLaunchFile ThisLaunchFileDir',
    'launch.some_substitutions_type': 'SomeSubstitutionsType SomeSubstitutionsType_types_tuple',
    'launch.utilities': 'AsyncSafeSignalManager create_future ensure_argument_type is_a '
    'is_a_subclass isclassinstance '
    'normalize_to_list_of_entities normalize_to_list_of_substitutions perform_substitutions '
    'visit_all_entities_and_collect_futures',
    'launch.utilities.class_tools_impl': 'is_a is_a_subclass isclassinstance',
    'launch.utilities.type_utils': 'AllowedTypesType AllowedValueType NormalizedValueType '
    'ScalarTypesTuple SomeValueType StrSomeValueType coerce_list coerce_to_type extract_type '
    'get_typed_value is_instance_of is_instance_of_valid_type is_normalized_substitution '
    'is_substitution is_typing_list is_valid_scalar_type normalize_typed_substitution '
    'perform_typed_substitution',
    'launch.logging': 'get_logger get_output_loggers launch_config handlers reset',
    'launch_ros': 'actions descriptions event_handlers events substitutions '
    'get_default_launch_description',
    'launch_ros.actions': 'ComposableNodeContainer LifecycleNode LifecycleTransition '
    'LoadComposableNodes Node PushROSNamespace PushRosNamespace RosTimer ROSTimer SetParameter '
    'SetParametersFromFile SetRemap SetROSLogDir SetUseSimTime',
    'launch_ros.descriptions': 'ComposableNode Parameter ParameterFile ParameterValue',
    'launch_ros.event_handlers': 'OnStateTransition',
    'launch_ros.events.lifecycle': 'ChangeState StateTransition matches_node_name',
    'launch_ros.events.matchers': 'matches_node_name',
    'launch_ros.parameter_descriptions': 'Parameter ParameterFile ParameterValue',
    'launch_ros.ros_adapters': 'ROSAdapter get_ros_adapter get_ros_node',
    'launch_ros.substitutions': 'ExecutableInPackage FindPackage FindPackagePrefix '
    'FindPackageShare Parameter',
    'launch_ros.utilities': 'evaluate_parameters normalize_parameters normalize_remap_rules '
    'make_namespace_absolute prefix_namespace',
    'launch_xml.launch_description_sources': 'XMLLaunchDescriptionSource',
    'launch_yaml.launch_description_sources': 'YAMLLaunchDescriptionSource',
    'ros2launch.api': 'LaunchFileNameCompleter MultipleLaunchFilesError get_launch_file_paths '
    'get_share_file_path_from_package is_launch_file launch_a_launch_file '
    'parse_launch_arguments print_a_launch_file print_arguments_of_launch_description '
    'print_arguments_of_launch_file',
    'ros2launch.option': 'OptionExtension get_option_extensions',
    'ros2run.api': 'get_executable_path',
}


@pytest.mark.parametrize('module', NAMES)
def test_the_names_exist_where_launch_files_import_them(module: str) -> None:
    found = importlib.import_module(module)
    assert [name for name in NAMES[module].split() if not hasattr(found, name)] == []


@pytest.mark.parametrize(
    ('action', 'names'),
    [
        (DeclareLaunchArgument, 'name default_value description choices'),
        (
            ExecuteProcess.__mro__[1],
            'process_description shell sigterm_timeout sigkill_timeout emulate_tty output '
            'output_format cached_output log_cmd on_exit respawn respawn_delay '
            'respawn_max_retries',
        ),
        (ExecuteProcess, 'cmd prefix name cwd env additional_env'),
        (GroupAction, 'actions scoped forwarding launch_configurations'),
        (TimerAction, 'period actions cancel_on_shutdown'),
        (
            Node,
            'executable package name namespace exec_name parameters remappings ros_arguments '
            'arguments',
        ),
        (LifecycleNode, 'name namespace autostart'),
    ],
)
def test_the_arguments_have_upstreams_names(action: type, names: str) -> None:
    parameters = inspect.signature(action.__init__).parameters  # type: ignore[misc]
    assert [name for name in names.split() if name not in parameters] == []


def test_importing_launch_brings_no_ros() -> None:
    code = 'import sys, launch, launch_ros.actions; sys.exit("rclpy" in sys.modules)'
    subprocess.run([sys.executable, '-c', code], check=True)
