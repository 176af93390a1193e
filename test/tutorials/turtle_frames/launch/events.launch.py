# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What happens when a program starts, prints, ends, and when all ends."""

from typing import Any

from launch import LaunchContext, LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    LogInfo,
    RegisterEventHandler,
    TimerAction,
)
from launch.conditions import IfCondition
from launch.event_handlers import (
    OnExecutionComplete,
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
    OnShutdown,
)
from launch.events import Shutdown
from launch.substitutions import (
    EnvironmentVariable,
    FindExecutable,
    LaunchConfiguration,
    LocalSubstitution,
    PythonExpression,
)
from launch_ros.actions import Node


def _said(event: Any) -> LogInfo:
    return LogInfo(msg=f'spawning says: {event.text.decode().strip()}')


def _on_shutdown(event: Any, context: LaunchContext) -> list[LogInfo]:
    return [LogInfo(msg=['all ends: ', LocalSubstitution('event.reason')])]


def generate_launch_description() -> LaunchDescription:
    """Return a turtlesim, and what follows from it."""
    red = LaunchConfiguration('red')
    turtlesim = Node(package='turtlesim', executable='turtlesim_node', name='sim')
    ros2 = FindExecutable(name='ros2')
    spawn = ExecuteProcess(
        cmd=[[ros2, ' service call /spawn turtlesim/srv/Spawn "{x: 2, y: 2, theta: 0.2}"']],
        shell=True,
    )
    colour = ExecuteProcess(
        cmd=[[ros2, ' param set /sim background_r ', red]], shell=True, output='screen'
    )
    end = TimerAction(period=0.5, actions=[EmitEvent(event=Shutdown(reason='the turtle is red'))])
    return LaunchDescription(
        [
            DeclareLaunchArgument('red', default_value='200', description='Of the background'),
            turtlesim,
            RegisterEventHandler(
                OnProcessStart(target_action=turtlesim, on_start=[LogInfo(msg='started'), spawn])
            ),
            RegisterEventHandler(OnProcessIO(target_action=spawn, on_stdout=_said)),
            RegisterEventHandler(
                OnExecutionComplete(
                    target_action=spawn, on_completion=[LogInfo(msg='spawned'), colour]
                )
            ),
            RegisterEventHandler(
                OnProcessExit(
                    target_action=colour,
                    on_exit=[LogInfo(msg=[EnvironmentVariable('USER'), ' has set it']), end],
                )
            ),
            LogInfo(
                msg='that is very red', condition=IfCondition(PythonExpression([red, ' > 250']))
            ),
            RegisterEventHandler(OnShutdown(on_shutdown=_on_shutdown)),
        ]
    )
