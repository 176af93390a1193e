# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes: names, parameters, remappings, as the node itself sees them."""

from collections.abc import Callable
import json
import os
from pathlib import Path
import re
import sys
from typing import Any

from launch import InvalidLaunchFileError, LaunchContext, LaunchDescription, LaunchService
from launch.conditions import IfCondition
from launch.launch_description_sources import get_launch_description_from_any_launch_file
from launch.source_location import describe_error
from launch_ros.actions import (
    ComposableNodeContainer,
    PushRosNamespace,
    SetParametersFromFile,
    SetRemap,
)
from launch_ros.actions.load_composable_nodes import get_composable_node_load_request
from launch_ros.descriptions import ComposableNode
from launch_ros.substitutions import ExecutableInPackage, FindPackageShare
from launch_ros.utilities import (
    make_namespace_absolute,
    prefix_namespace,
)
import pytest

LaunchFile = Callable[..., Path]
Run = Callable[..., Any]

BEFORE = """
from launch_ros.actions import *
from launch_ros.descriptions import ParameterFile
from launch_ros.parameter_descriptions import Parameter, ParameterValue
from launch_ros.substitutions import FindPackageShare
def node(**kwargs):
    return Node(package='some_pkg', executable='plain_node', output='screen', **kwargs)
"""


def _nodes(output: str) -> dict[str, tuple[str, str, dict[str, Any]]]:
    """Return fully qualified name, topic and parameters of each process."""
    found = re.findall(r'^\[(plain_node-\d+)\] NODE (.*)$', output, re.M)
    return {process: tuple(json.loads(text)) for process, text in found}


def test_names_parameters_and_remappings_reach_real_nodes(
    python_launch_file: LaunchFile, launch_here: Run, ros_package: Path
) -> None:
    share = ros_package / 'share' / 'some_pkg'
    (share / 'plain.yaml').write_text('/**:\n  ros__parameters: {number: 1, own: [a, b]}\n')
    (share / 'own.yaml').write_text('/deep/space/me:\n  ros__parameters: {fraction: $(var f)}\n')
    path = python_launch_file(
        """
        DeclareLaunchArgument('f', default_value='0.5'),
        GroupAction([
            PushRosNamespace('deep'), SetRemap('chatter', '/elsewhere'),
            SetParameter('everywhere', '1'), SetParameter('use_sim_time', True),
            SetParametersFromFile(FindPackageShare('some_pkg') / 'plain.yaml'),
            node(
                name='me', namespace='space', arguments=['--plain', 'argument'],
                parameters=[
                    PathJoinSubstitution([FindPackageShare('some_pkg'), 'plain.yaml']),
                    {'number': 2, 'nested': {'flag': True}, 'text': '3', 'list': [1, 2.5],
                     'computed': LaunchConfiguration('f'), ('long', '_name'): ['a', 'b']},
                    ParameterFile(FindPackageShare('some_pkg') / 'own.yaml', allow_substs=True),
                    Parameter('single', [True, False]),
                    {'as_text': ParameterValue(LaunchConfiguration('f'), value_type=str)},
                ],
            ),
        ]),
        node(remappings=[('chatter', 'talk')], ros_arguments=['-p', 'given:=7']),
        node(namespace='/top', remappings={'chatter': 'x'}.items()),
        """,
        before=BEFORE,
    )
    launched = launch_here(path)
    nodes = _nodes(launched.output)
    name, topic, parameters = nodes['plain_node-1']
    assert (name, topic) == ('/deep/space/me', '/elsewhere')
    assert parameters == {
        'everywhere': 1,
        'use_sim_time': True,
        'number': 2,
        'own': ['a', 'b'],
        'nested.flag': True,
        'text': '3',
        'list': [1.0, 2.5],
        'computed': 0.5,
        'long_name': ['a', 'b'],
        'fraction': 0.5,
        'single': [True, False],
        'as_text': '0.5',
        **{key: value for key, value in parameters.items() if key.startswith('start_type')},
    }
    assert '[plain_node-1] ARGUMENTS ["--plain", "argument"]' in launched.lines
    assert nodes['plain_node-2'][:2] == ('/plain', '/talk')
    assert nodes['plain_node-2'][2]['given'] == 7
    assert nodes['plain_node-3'][:2] == ('/top/plain', '/top/x')
    assert re.search(r'^\[plain_node-1\] \[INFO\] \[\d+\.\d+\] \[deep.space.me\]: a log line$',
                     launched.output, re.M)  # fmt: skip


def test_nodes_of_xml_files_are_the_same(
    launch_file: LaunchFile, launch_here: Run, ros_package: Path
) -> None:
    (ros_package / 'share' / 'some_pkg' / 'p.yaml').write_text(
        '/**:\n  ros__parameters: {from_file: $(var n)}\n'
    )
    path = launch_file(
        """
        <launch>
          <arg name="n" default="4"/>
          <set_parameter name="everywhere" value="1.5"/>
          <set_parameter name="use_sim_time" value="true"/>
          <group>
            <push_ros_namespace namespace="deep"/>
            <set_remap from="chatter" to="talk"/>
            <node pkg="some_pkg" exec="plain_node" name="me" namespace="in" output="screen"
                  args="--number $(var n) 'two words'">
              <param name="number" value="$(var n)"/>
              <param name="text" value="$(var n)" type="str"/>
              <param name="outer"><param name="inner" value="true"/></param>
              <param name="list" value="a,b" value-sep=","/>
              <param name="numbers" value="1;2" value-sep=";"/>
              <param name="digits" value="'1'//'2'" value-sep="//"/>
              <param name="digit" value="'1'"/>
              <param name="quoted" value="\\'1\\'"/>
              <param from="$(find-pkg-share some_pkg)/p.yaml" allow_substs="true"/>
              <remap from="unused" to="other"/>
            </node>
          </group>
          <node pkg="some_pkg" exec="plain_node" output="screen" exec_name="renamed"/>
        </launch>
        """,
        'nodes.launch.xml',
    )
    launched = launch_here(path)
    name, topic, parameters = _nodes(launched.output)['plain_node-1']
    assert (name, topic) == ('/deep/in/me', '/deep/in/talk')
    wanted = {
        'everywhere': 1.5,
        'use_sim_time': True,
        'number': 4,
        'text': '4',
        'outer.inner': True,
        'list': ['a', 'b'],
        'numbers': [1, 2],
        'digits': ['1', '2'],
        'digit': '1',
        'quoted': "'1'",
        'from_file': 4,
    }
    assert {key: parameters.get(key) for key in wanted} == wanted
    assert '[plain_node-1] ARGUMENTS ["--number", "4", "two words"]' in launched.lines
    assert 'NODE ["/plain", "/chatter"' in launched.output
    assert '[renamed-2] ' in launched.output


def test_two_nodes_of_one_name_are_warned_about(
    python_launch_file: LaunchFile, launch_here: Run, ros_package: Path
) -> None:
    del ros_package
    path = python_launch_file(
        "node(name='same', namespace='/'), node(name='same', namespace='/'),", before=BEFORE
    )
    expected = 'there are now at least 2 nodes with the name /same created within this launch'
    assert expected in launch_here(path).output


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (
            "package='some_pkg', executable='plain_nod'",
            "'plain_nod' not found on the libexec dire",
        ),
        ("package='some_pkg', executable='plain_nod'", "is 'plain_node' meant?"),
        ("package='some_pkg', executable='still'", 'still is not executable: `chmod +x '),
        ("package='some_pk', executable='x'", "package 'some_pk' not found, searching: ["),
        ("package='some_pk', executable='x'", "did you mean 'some_pkg'?"),
        ("package='demo_nodes_cpp', executable='talker'", '`ros2 run demo_nodes_py talker`'),
        (
            "package='rclcpp_components', executable='component_container'",
            'it has no wheel; here nodes in Python share a process where one program adds them',
        ),
        ("package='some_pkg', executable='plain_node', name='a b'", "node name 'a b' is refused"),
        (
            "package='some_pkg', executable='plain_node', namespace='1'",
            "namespace '/1' is refused",
        ),
        (
            "package='some_pkg', executable='plain_node', parameters=[{'a': [1, 'b']}]",
            "for parameter 'a', got [1, 'b']",
        ),
        (
            "package='some_pkg', executable='plain_node', "
            "parameters=[{'a': TextSubstitution(text='<xml: {')}]",
            'Unable to parse the value of parameter a as yaml',
        ),
        (
            "package='some_pkg', executable='plain_node', "
            "parameters=[{'a': TextSubstitution(text='[1, 2.0]')}]",
            "for parameter 'a', got [1, 2.0]",
        ),
        (
            "package='some_pkg', executable='plain_node', remappings=[['a', 'b']]",
            "a remapping is a tuple as ('from', 'to'), got ['a', 'b']",
        ),
        ("package='some_pkg', executable='plain_node', output='scren'", "output 'scren' is not"),
        (
            "package='some_pkg', executable='plain_node', output_format='{lin}'",
            "output_format '{lin}' is refused: KeyError: 'lin'",
        ),
    ],
)
def test_a_wrong_node_is_one_line_with_its_place(
    arguments: str,
    message: str,
    python_launch_file: LaunchFile,
    launch_here: Run,
    ros_package: Path,
) -> None:
    (ros_package / 'lib/some_pkg/still').touch(0o644)
    path = python_launch_file(f'Node({arguments}),', before=BEFORE)
    launched = launch_here(path)
    assert launched.returncode == 1
    (line,) = [line for line in launched.lines if line.startswith('[ERROR]')]
    assert message in line
    assert f'(at {path}:' in line
    assert 'Traceback' not in launched.output


UNBUILT = """\
<package format="3">
  <name>some_package</name>
  <version>0.0.0</version>
  <description>for tests</description>
  <maintainer email="someone@example.org">someone</maintainer>
  <license>Apache-2.0</license>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""


def test_a_package_that_python_asks_for_is_explained(
    python_launch_file: LaunchFile,
    ros_package: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    del ros_package
    source = tmp_path / 'ws/src/some_package'
    source.mkdir(parents=True)
    (source / 'package.xml').write_text(UNBUILT)
    monkeypatch.chdir(tmp_path / 'ws')
    before = (
        f'{BEFORE}\nfrom ament_index_python.packages import get_package_share_directory as share\n'
    )
    for package, hint in {
        'some_package': f'it is in {source}, but not built; run `colcon build --packages-select',
        'rviz2': 'it has no wheel; here `ros2 launch husky_sim husky_playpen.launch.py`',
        'nav2_bringup': 'it has no wheel; here nothing does its job, but a sourced ROS 2 Jazzy',
        'some_pk': "did you mean 'some_pkg'?",
    }.items():
        path = python_launch_file(f"LogInfo(msg=share('{package}')),", before=before)
        with pytest.raises(InvalidLaunchFileError) as caught:
            get_launch_description_from_any_launch_file(str(path))
        said = describe_error(caught.value)
        assert f"package '{package}' not found, searching: [" in said
        assert said.count(hint) == 1
        assert f'(at {path}:' in said
    path = python_launch_file('', before=f'{before}from nav2_common.launch import RewrittenYaml\n')
    with pytest.raises(InvalidLaunchFileError) as caught:
        get_launch_description_from_any_launch_file(str(path))
    said = describe_error(caught.value)
    assert "No module named 'nav2_common': it has no wheel; here nothing does its job, but" in said


def test_a_file_that_the_package_has_not_installed_is_explained(
    python_launch_file: LaunchFile,
    launch_here: Run,
    ros_package: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    del ros_package
    prefix, source = tmp_path / 'ws/install/some_package', tmp_path / 'ws/src/some_package'
    index = prefix / 'share/ament_index/resource_index/packages/some_package'
    for file in (index, source / 'config/a b.yaml', source / 'urdf/arm.urdf'):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch()
    (source / 'package.xml').write_text(UNBUILT)
    prefixes = [str(prefix), os.environ['AMENT_PREFIX_PATH']]
    monkeypatch.setenv('AMENT_PREFIX_PATH', os.pathsep.join(prefixes))
    share = f'{prefix}/share/some_package'
    before = f'{BEFORE}\nfrom launch.substitutions import Command, FileContent\n'
    for action, missing in {
        f"node(parameters=['{share}/config/a b.yaml']),": 'config/a b.yaml',
        f"LogInfo(msg=open('{share}/config/a b.yaml').read()),": 'config/a b.yaml',
        f"LogInfo(msg=FileContent('{share}/urdf/arm.urdf')),": 'urdf/arm.urdf',
        f"LogInfo(msg=Command('cat {share}/urdf/arm.urdf')),": 'urdf/arm.urdf',
    }.items():
        said = launch_here(python_launch_file(action, before=before)).output
        folder = missing.partition('/')[0]
        assert (
            said.count(
                f'{source}/{missing} is not installed: write install(DIRECTORY {folder} DEST'
            )
            == 1
        )


def test_a_missing_parameter_file_is_warned_about(
    python_launch_file: LaunchFile, launch_here: Run, ros_package: Path
) -> None:
    del ros_package
    path = python_launch_file("node(parameters=['/no/such/file.yaml']),", before=BEFORE)
    launched = launch_here(path)
    assert 'Parameter file path is not a file: /no/such/file.yaml' in launched.output
    assert 'plain_node-1' in _nodes(launched.output)


def test_a_parameter_file_that_no_node_reads_is_warned_about(
    python_launch_file: LaunchFile, launch_here: Run, ros_package: Path, tmp_path: Path
) -> None:
    del ros_package
    file = tmp_path / 'tab.yaml'
    file.write_text('/**:\n\tros__parameters: {a: 1}\n')
    path = python_launch_file(f"node(parameters=['{file}']),", before=BEFORE)
    assert f'{file}: line 2 begins with a tab; YAML takes' in launch_here(path).output


def test_a_script_for_the_python_of_ubuntu_runs_by_this_one(
    python_launch_file: LaunchFile, launch_here: Run, ros_package: Path
) -> None:
    program = ros_package / 'lib' / 'some_pkg' / 'plain_node'
    program.write_text('#!/usr/bin/python3\nimport sys\nprint("runs in", sys.prefix)\n')
    launched = launch_here(python_launch_file('node(),', before=BEFORE))
    assert f'[plain_node-1] runs in {sys.prefix}\n' in launched.output


def test_a_script_with_line_ends_of_windows_is_warned_about(
    python_launch_file: LaunchFile, launch_here: Run, ros_package: Path
) -> None:
    program = ros_package / 'lib' / 'some_pkg' / 'plain_node'
    program.write_bytes(b'#!/usr/bin/env python3\r\n')
    launched = launch_here(python_launch_file('node(),', before=BEFORE))
    (line,) = [line for line in launched.lines if line.startswith('[WARNING] [launch_ros]')]
    assert f"executable '{program}' cannot be run: its lines end as those of Windows" in line


def test_component_containers_are_refused_in_one_line(
    launch_environment: None, capsys: pytest.CaptureFixture[str]
) -> None:
    del launch_environment
    composable = ComposableNode(package='a', plugin='a::B', parameters=[{'x': 1}])
    container = ComposableNodeContainer(
        name='box',
        namespace='',
        package='rclcpp_components',
        executable='component_container',
        composable_node_descriptions=[composable],
    )
    service = LaunchService()
    service.include_launch_description(LaunchDescription([container]))
    assert service.run() == 1
    (line,) = [text for text in capsys.readouterr().out.splitlines() if text.startswith('[ERROR]')]
    assert 'component containers are C++ programs' in line


def test_a_container_is_asked_for_what_the_scope_and_the_node_say(
    launch_environment: None, tmp_path: Path
) -> None:
    del launch_environment
    file = tmp_path / 'parameters.yaml'
    file.write_text(
        '/**: {ros__parameters: {all: 1, own: 2}}\n/deep: {me: {ros__parameters: {own: 3}}}\n'
        '/deep/other: {ros__parameters: {none: 4}}\n'
    )
    context = LaunchContext()
    actions = [PushRosNamespace('deep'), SetRemap('a', 'b'), SetParametersFromFile(str(file))]
    for action in actions:
        action.execute(context)
    node = ComposableNode(
        package='pkg', plugin='pkg::Me', name='me', remappings=[('c', 'd')],
        parameters=[{'text': '1'}], extra_arguments=[{'use_intra_process_comms': True}],
    )  # fmt: skip
    request = get_composable_node_load_request(node, context)
    assert (request.package_name, request.plugin_name) == ('pkg', 'pkg::Me')
    assert (request.node_namespace, request.node_name) == ('/deep', 'me')
    assert request.remap_rules == ['a:=b', 'c:=d']
    assert {item.name: item.value.integer_value for item in request.parameters[:2]} == {
        'all': 1,
        'own': 3,
    }
    assert request.parameters[2].value.string_value == '1'
    assert request.extra_arguments[0].value.bool_value
    never = ComposableNode(package='a', plugin='b', condition=IfCondition('false'))
    assert get_composable_node_load_request(never, context) is None


def test_an_extension_takes_part_in_the_start_of_nodes(
    python_launch_file: LaunchFile,
    run_launch: Run,
    ros_package: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    del ros_package
    folder = tmp_path / 'extensions' / 'some.dist-info'
    folder.mkdir(parents=True)
    (folder / 'entry_points.txt').write_text(
        '[launch_ros.node_action]\ngood = some_extension:Good\nbad = some_extension:Bad\n'
    )
    (folder.parent / 'some_extension.py').write_text(
        'from launch_ros.actions.node import NodeActionExtension\n'
        'class Good(NodeActionExtension):\n'
        '    def prepare_for_execute(self, context, ros_specific_arguments, node_action):\n'
        "        return ['-p', 'added:=1'], {**ros_specific_arguments, 'name': '__node:=other'}\n"
        'class Bad(NodeActionExtension):\n'
        "    EXTENSION_POINT_VERSION = '0.2'\n"
    )
    monkeypatch.setenv('PYTHONPATH', str(folder.parent), prepend=os.pathsep)
    launched = run_launch(python_launch_file("node(name='me'),", before=BEFORE))
    name, _, parameters = _nodes(launched.output)['plain_node-1']
    assert (name, parameters['added']) == ('/other', 1)
    assert "Failed to load the node extension 'bad': Extension point 0.2 is" in launched.output


def test_packages_are_found_and_their_parts(ros_package: Path) -> None:
    context = LaunchContext()
    share = ros_package / 'share' / 'some_pkg'
    assert FindPackageShare('some_pkg').perform(context) == str(share)
    assert (FindPackageShare('some_pkg') / 'a' / 'b').perform(context) == str(share / 'a' / 'b')
    program = ExecutableInPackage(package='some_pkg', executable='plain_node').perform(context)
    assert program == str(ros_package / 'lib' / 'some_pkg' / 'plain_node')


@pytest.mark.parametrize(
    ('base', 'namespace', 'result'),
    [
        (None, None, None),
        (None, 'a', '/a'),
        ('/a', None, '/a'),
        ('/a', 'b', '/a/b'),
        ('/a', '/b', '/b'),
        ('/', 'b', '/b'),
        ('/a', '', '/a'),
    ],
)
def test_namespaces_are_joined(base: str | None, namespace: str | None, result: str) -> None:
    assert make_namespace_absolute(prefix_namespace(base, namespace)) == result
