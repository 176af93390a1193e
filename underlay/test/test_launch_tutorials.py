# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files in the manner of tutorials and demos: includes, namespaces, event handlers."""

from collections.abc import Callable
from pathlib import Path
import re
from typing import Any

import pytest

LaunchFile = Callable[..., Path]
Run = Callable[..., Any]

PROGRAM = """\
#!/bin/sh
echo "GOT $@"
"""
PAIR_PY = """
from launch import LaunchDescription
import launch_ros.actions

def generate_launch_description():
    return LaunchDescription([
        launch_ros.actions.Node(package='demo', executable='talker', output='screen'),
        launch_ros.actions.Node(package='demo', executable='listener', output='screen'),
    ])
"""
PAIR_XML = """<launch>
  <node pkg="demo" exec="talker" output="screen" />
  <node pkg="demo" exec="listener" output="screen" />
</launch>
"""
PAIR_YAML = """%YAML 1.2
---
launch:
- node:
    pkg: "demo"
    exec: "talker"
    output: "screen"
- node:
    pkg: "demo"
    exec: "listener"
    output: "screen"
"""
MAIN_XML = """<?xml version="1.0" encoding="UTF-8"?>
<launch>
  <arg name="ns" default="some/ns" />
  <arg name="red" default="0" />
  <include file="$(find-pkg-share demo)/launch/pair_launch.py" />
  <group>
    <push_ros_namespace namespace="$(var ns)" />
    <include file="$(find-pkg-share demo)/launch/pair_launch.xml" />
  </group>
  <group>
    <push-ros-namespace namespace="/other" />
    <include file="$(find-pkg-share demo)/launch/pair_launch.yaml" />
  </group>
  <node pkg="demo" exec="talker" name="sim" namespace="one" output="screen"
        args="--ros-args --log-level info" />
  <node pkg="demo" exec="talker" name="sim" namespace="two" output="screen"
        ros_args="--log-level warn">
    <param name="red" value="$(var red)" />
    <remap from="/in/pose" to="/one/pose" />
  </node>
</launch>
"""
MAIN_YAML = """%YAML 1.2
---
launch:
- arg:
    name: "ns"
    default: "some/ns"
- arg:
    name: "red"
    default: "0"
- include:
    file: "$(find-pkg-share demo)/launch/pair_launch.py"
- group:
    - push_ros_namespace:
        namespace: "$(var ns)"
    - include:
        file: "$(find-pkg-share demo)/launch/pair_launch.xml"
- group:
    - push_ros_namespace:
        namespace: "/other"
    - include:
        file: "$(find-pkg-share demo)/launch/pair_launch.yaml"
- node:
    pkg: "demo"
    exec: "talker"
    name: "sim"
    namespace: "one"
    output: "screen"
    args: "--ros-args --log-level info"
- node:
    pkg: "demo"
    exec: "talker"
    name: "sim"
    namespace: "two"
    output: "screen"
    ros_args: "--log-level warn"
    param:
    - name: "red"
      value: "$(var red)"
    remap:
    - from: "/in/pose"
      to: "/one/pose"
"""
MAIN_PY = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, TextSubstitution
from launch_ros.actions import Node, PushROSNamespace
from launch_ros.substitutions import FindPackageShare

def generate_launch_description():
    folder = PathJoinSubstitution([FindPackageShare('demo'), 'launch'])
    return LaunchDescription([
        DeclareLaunchArgument('ns', default_value='some/ns'),
        DeclareLaunchArgument('red', default_value=TextSubstitution(text='0')),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource([folder, '/pair_launch.py'])
        ),
        GroupAction(
            actions=[
                PushROSNamespace(LaunchConfiguration('ns')),
                IncludeLaunchDescription(PathJoinSubstitution([folder, 'pair_launch.xml'])),
            ]
        ),
        GroupAction(
            actions=[
                PushROSNamespace('/other'),
                IncludeLaunchDescription(PathJoinSubstitution([folder, 'pair_launch.yaml'])),
            ]
        ),
        Node(package='demo', namespace='one', executable='talker', name='sim', output='screen',
             arguments=['--ros-args', '--log-level', 'info']),
        Node(package='demo', namespace='two', executable='talker', name='sim', output='screen',
             ros_arguments=['--log-level', 'warn'],
             parameters=[{'red': LaunchConfiguration('red')}],
             remappings=[('/in/pose', '/one/pose')]),
    ])
"""


@pytest.fixture
def demo_package(ros_package: Path) -> Path:
    """Install a package whose nodes print their arguments."""
    share = ros_package / 'share'
    (share / 'ament_index' / 'resource_index' / 'packages' / 'demo').touch()
    (ros_package / 'lib' / 'demo').mkdir()
    for name in ('talker', 'listener'):
        program = ros_package / 'lib' / 'demo' / name
        program.write_text(PROGRAM)
        program.chmod(0o755)
    launch = share / 'demo' / 'launch'
    launch.mkdir(parents=True)
    for end, text in (('py', PAIR_PY), ('xml', PAIR_XML), ('yaml', PAIR_YAML)):
        (launch / f'pair_launch.{end}').write_text(text)
    return ros_package


@pytest.mark.parametrize(
    ('name', 'text'), [('py', MAIN_PY), ('xml', MAIN_XML), ('yaml', MAIN_YAML)]
)
def test_the_three_formats_do_the_same(
    name: str, text: str, launch_file: LaunchFile, run_launch: Run, demo_package: Path
) -> None:
    del demo_package
    launched = run_launch(launch_file(text, f'main_launch.{name}'), 'red:=7')
    assert launched.returncode == 0, launched.output
    got = dict(re.findall(r'^\[(\w+-\d+)\] GOT ?(.*)$', launched.output, re.M))
    last = got.pop('talker-8')
    assert got == {
        'talker-1': '--ros-args',
        'listener-2': '--ros-args',
        'talker-3': '--ros-args -r __ns:=/some/ns',
        'listener-4': '--ros-args -r __ns:=/some/ns',
        'talker-5': '--ros-args -r __ns:=/other',
        'listener-6': '--ros-args -r __ns:=/other',
        'talker-7': '--ros-args --log-level info --ros-args -r __node:=sim -r __ns:=/one',
    }
    assert re.fullmatch(
        r'--ros-args --log-level warn --ros-args -r __node:=sim -r __ns:=/two '
        r'--params-file /\S*/launch_params_\w+ -r /in/pose:=/one/pose',
        last,
    )


def test_a_chain_of_event_handlers(
    python_launch_file: LaunchFile, run_launch: Run, demo_package: Path
) -> None:
    del demo_package
    path = python_launch_file(
        """
        DeclareLaunchArgument('ns', default_value='one'),
        DeclareLaunchArgument('red', default_value='200'),
        NODE,
        RegisterEventHandler(OnProcessStart(
            target_action=NODE, on_start=[LogInfo(msg='started, spawning'), SPAWN])),
        RegisterEventHandler(OnProcessIO(
            target_action=SPAWN,
            on_stdout=lambda event: LogInfo(msg=f'it says "{event.text.decode().strip()}"'))),
        RegisterEventHandler(OnExecutionComplete(
            target_action=SPAWN,
            on_completion=[LogInfo(msg='spawned'),
                           TimerAction(period=0.05, actions=[CHANGE, LogInfo(msg='changed')])])),
        RegisterEventHandler(OnProcessExit(
            target_action=CHANGE,
            on_exit=[EmitEvent(event=Shutdown_(reason='Window closed'))])),
        RegisterEventHandler(OnShutdown(
            on_shutdown=[LogInfo(msg=['asked: ', LocalSubstitution('event.reason')])])),
        """,
        before="""
from launch.events import Shutdown as Shutdown_
from launch_ros.actions import Node
NODE = ExecuteProcess(cmd=['sleep', '30'])
SPAWN = ExecuteProcess(
    cmd=[[FindExecutable(name='echo'), ' call ', LaunchConfiguration('ns'), '/spawn']], shell=True)
CHANGE = ExecuteProcess(
    condition=IfCondition(PythonExpression([LaunchConfiguration('red'), ' == 200 and True'])),
    cmd=['true'])
""",
    )
    launched = run_launch(path)
    before = '[INFO] [launch.user]: '
    logged = [line[len(before) :] for line in launched.lines if line.startswith(before)]
    assert logged == [
        'started, spawning',
        'it says "call one/spawn"',
        'spawned',
        'changed',
        'asked: Window closed',
    ]


def test_executables_are_looked_up_through_ros2run(demo_package: Path) -> None:
    from ros2run.api import get_executable_path, get_executable_paths

    folder = demo_package / 'lib' / 'demo'
    paths = get_executable_paths(package_name='demo')
    assert paths == [str(folder / 'listener'), str(folder / 'talker')]
    path = get_executable_path(package_name='demo', executable_name='talker')
    assert path == str(folder / 'talker')
    assert get_executable_path(package_name='demo', executable_name='none') is None
