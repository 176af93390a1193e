# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Drive one course in the playpen: the simulator and follow_path, until one of them ends."""

from typing import Any

from launch import LaunchContext, LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    OpaqueFunction,
    RegisterEventHandler,
    Shutdown,
    TimerAction,
)
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnProcessExit, OnProcessIO
from launch.events.process import ProcessExited, ProcessIO
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

# Arguments that are handed on to the simulator: name, default, description. What only it knows,
# such as floor, reaches its launch file without.
OF_SIMULATOR = (
    ('record', '', 'where the simulator writes the run'),
    ('limit_sec', '0.0', 'most simulated time; 0.0: any'),
    ('real_time_factor', '1.0', '1.0 keeps pace with the wall, 0.0 is as fast as possible'),
    ('interface', 'lab', "lab, or clearpath: driven by a real A200's topics"),
    ('lockstep', 'false', 'true: the simulator waits for each command, so that a run repeats'),
    ('viewer', 'false', 'true: a live view in the browser'),
    ('viewer_port', '8080', 'port of the view; the next free one if it is taken'),
)

SERVED, FIRST_TAB = b'look at http://', b'the page is open'  # the view prints them
SERVED_SEC, FIRST_TAB_SEC = 30.0, 8.0
"""A driver that waits for a tab waits no longer: nobody knows whether a browser opens."""


def _end_all(event: ProcessExited, context: LaunchContext) -> Shutdown | None:
    return None if context.is_shutdown else Shutdown(reason=f'{event.process_name} has ended')


class Held:
    """
    A node that is started once, by whichever comes first.

    :param node: what is started.
    """

    def __init__(self, node: Node) -> None:
        self._left = [node]

    def start(self, *_: object) -> list[Node]:
        """Return the node when called first, whatever with, and nothing later."""
        left, self._left = self._left, []
        return left

    def start_after(self, period_sec: float, **options: Any) -> TimerAction:
        """Return what starts it after a time of the wall."""
        return TimerAction(
            period=period_sec, actions=[OpaqueFunction(function=self.start)], **options
        )

    def on_output(self, event: ProcessIO) -> list[Node] | TimerAction | None:
        """Start it when the view has its first tab, or some time after it could have one."""
        if FIRST_TAB in event.text:
            return self.start()
        return self.start_after(FIRST_TAB_SEC) if SERVED in event.text else None


def generate_launch_description() -> LaunchDescription:
    """Return the simulator, the driver, and the end of all when one has ended, however it did."""
    simulator = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution(
                [FindPackageShare('husky_sim'), 'launch', 'husky_playpen.launch.py']
            )
        ),
        launch_arguments={name: LaunchConfiguration(name) for name, _, _ in OF_SIMULATOR}.items(),
    )
    driver = Held(
        Node(
            package='husky_driver',
            executable='follow_path',
            # No use_sim_time: the driver's clock is the stamps of the odometry.
            parameters=[
                {'startup_timeout_sec': 60.0, 'interface': LaunchConfiguration('interface')}
            ],
            arguments=['--waypoints', LaunchConfiguration('waypoints')],
            output='screen',
        )
    )
    waits = LaunchConfiguration('wait_for_tab')
    return LaunchDescription(
        [
            DeclareLaunchArgument('waypoints', description='the waypoint file to drive'),
            DeclareLaunchArgument(
                'wait_for_tab',
                default_value='false',
                description='true: the driver waits some seconds until a browser shows the view',
            ),
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, default, description in OF_SIMULATOR
            ),
            RegisterEventHandler(OnProcessIO(on_stdout=driver.on_output)),
            simulator,
            OpaqueFunction(function=driver.start, condition=UnlessCondition(waits)),
            driver.start_after(SERVED_SEC, condition=IfCondition(waits)),
            RegisterEventHandler(OnProcessExit(on_exit=_end_all)),
        ]
    )
