# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle nodes and timers of ROS time: what needs a ROS node in the launch."""

from collections.abc import Callable
from pathlib import Path
import re
import sys
from typing import Any

from launch_ros.events.lifecycle import ChangeState
from lifecycle_msgs.msg import Transition  # type: ignore[import-untyped]
import pytest

LaunchFile = Callable[..., Path]
Run = Callable[..., Any]

LIFECYCLE_NODE = """\
#!{python}
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

class Plain(LifecycleNode):
    def on_configure(self, state):
        print('is configured')
        return TransitionCallbackReturn.SUCCESS
    def on_activate(self, state):
        print('is activated')
        return super().on_activate(state)

rclpy.init()
try:
    rclpy.spin(Plain('unnamed'))
except (KeyboardInterrupt, ExternalShutdownException):
    pass
"""
BEFORE = """
from launch_ros.actions import *
from launch_ros.event_handlers import OnStateTransition
"""

AUTOSTARTED = """
NODE = LifecycleNode(package='some_pkg', executable='lifecycle_node', name='me', namespace='deep',
                     output='screen', autostart=True)
"""
UNTIL_ACTIVE = """
        NODE,
        RegisterEventHandler(OnStateTransition(
            target_lifecycle_node=NODE, goal_state='active',
            entities=[LogInfo(msg='it is active'), Shutdown()])),
"""

# As on a busy machine, where rmw_fastrtps has found the client too late.
LOSES_AN_ANSWER = """
from rclpy.service import Service

really_send, asked = Service.send_response, []

def send_response(service, *answer):
    if service.srv_name.endswith('get_state'):
        asked.append('answered' if asked else 'in vain,')
        if len(asked) == 1:
            return
    really_send(service, *answer)

Service.send_response = send_response
rclpy.init()
"""


@pytest.fixture
def lifecycle_package(ros_package: Path) -> Path:
    program = ros_package / 'lib' / 'some_pkg' / 'lifecycle_node'
    program.write_text(LIFECYCLE_NODE.format(python=sys.executable))
    program.chmod(0o755)
    return ros_package


def test_a_lifecycle_node_takes_the_asked_transitions(
    python_launch_file: LaunchFile, run_launch: Run, lifecycle_package: Path
) -> None:
    del lifecycle_package
    launched = run_launch(python_launch_file(UNTIL_ACTIVE, before=BEFORE + AUTOSTARTED))
    assert '[lifecycle_node-1] is configured' in launched.lines
    assert '[lifecycle_node-1] is activated' in launched.lines
    assert '[INFO] [launch.user]: it is active' in launched.lines
    assert launched.returncode == 0


def test_change_state_reaches_a_node_without_a_namespace(
    launch_file: LaunchFile, run_launch: Run, lifecycle_package: Path
) -> None:
    del lifecycle_package
    path = launch_file(
        """
        import launch, launch_ros.actions, launch_ros.events.lifecycle, launch_ros.event_handlers
        from launch.actions import EmitEvent, LogInfo, RegisterEventHandler, Shutdown
        from lifecycle_msgs.msg import Transition

        def generate_launch_description():
            node = launch_ros.actions.LifecycleNode(
                package='some_pkg', executable='lifecycle_node', name='me', namespace='')
            return launch.LaunchDescription([
                RegisterEventHandler(launch_ros.event_handlers.OnStateTransition(
                    target_lifecycle_node=node, start_state='configuring', goal_state='inactive',
                    entities=[LogInfo(msg='it is inactive'), Shutdown()])),
                node,
                EmitEvent(event=launch_ros.events.lifecycle.ChangeState(
                    lifecycle_node_matcher=launch.events.matches_action(node),
                    transition_id=Transition.TRANSITION_CONFIGURE)),
            ])
        """
    )
    launched = run_launch(path)
    assert '[INFO] [launch.user]: it is inactive' in launched.lines
    assert launched.returncode == 0


def test_a_node_is_changed_once_it_has_found_who_listens(
    python_launch_file: LaunchFile, run_launch: Run, lifecycle_package: Path
) -> None:
    program = lifecycle_package / 'lib' / 'some_pkg' / 'lifecycle_node'
    text = program.read_text().replace('rclpy.init()', LOSES_AN_ANSWER)
    program.write_text(text.replace("'is configured'", "'asked', *asked"))
    launched = run_launch(python_launch_file(UNTIL_ACTIVE, before=BEFORE + AUTOSTARTED))
    assert '[lifecycle_node-1] asked in vain, answered' in launched.output
    assert '[INFO] [launch.user]: it is active' in launched.lines


def test_a_ros_timer_rings_once(python_launch_file: LaunchFile, run_launch: Run) -> None:
    path = python_launch_file(
        # The end comes a while after the first ring, in which a second one would.
        'ROSTimer(period=0.1, actions=['
        "    LogInfo(msg='rang'), ROSTimer(period=0.5, actions=[Shutdown()])]), "
        "RosTimer(period=60.0, actions=[LogInfo(msg='never')]), ",
        before=BEFORE,
    )
    launched = run_launch(path)
    assert len(re.findall('rang', launched.output)) == 1
    assert 'never' not in launched.output
    assert launched.returncode == 0


def test_an_unknown_transition_is_refused() -> None:
    with pytest.raises(
        ValueError, match=r'transition_id=77 is none of .*1 \(TRANSITION_CONFIGURE\)'
    ):
        ChangeState(lifecycle_node_matcher=bool, transition_id=77)
    name = ChangeState.valid_transitions[Transition.TRANSITION_CONFIGURE]
    assert name == 'TRANSITION_CONFIGURE'


def test_a_ros_timer_follows_the_clock_that_is_set_after_it(
    python_launch_file: LaunchFile, run_launch: Run
) -> None:
    path = python_launch_file(
        """
        ROSTimer(period=60.0, actions=[LogInfo(msg='rang'), Shutdown()]),
        SetUseSimTime(True),
        ExecuteProcess(cmd=[sys.executable, '-c', CLOCK]),
        """,
        before=BEFORE
        + """
import sys
CLOCK = '''
import rclpy, time
from rosgraph_msgs.msg import Clock
rclpy.init()
node = rclpy.create_node('clock')
publisher = node.create_publisher(Clock, '/clock', 10)
message = Clock()
while rclpy.ok():
    message.clock.sec += 10
    publisher.publish(message)
    time.sleep(0.05)
'''
""",
    )
    assert 'rang' in run_launch(path).output
