# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What does the job of packages that tutorials name and the pip installation lacks."""

from __future__ import annotations

_GRAPH = '`ros2 run rqt_graph rqt_graph` shows the graph, and `ros2 doctor` what is wrong in it'
_LOG = '`ros2 topic echo /rosout` shows what all nodes log'
_CALL = f'`ros2 service call` calls a service, {_GRAPH}'
_HUSKY = '`ros2 launch husky_sim husky_playpen.launch.py` starts a robot in a world'
_TELEOP = '`ros2 run husky_driver teleop` drives by the keys'
_FRAMES = '`ros2 run tf2_tools view_frames --live` shows the tree of frames in the browser'
_VIEW = f'{_HUSKY}, and with `viewer:=true` shows it in the browser'
_URDF = (
    '`ros2 run robot_state_publisher robot_state_publisher FILE.urdf` publishes the frames of a '
    'robot, `ros2 run tf2_tools view_frames --live` shows them in the browser'
)
_CAMERA = (
    'with `camera_rate_hz` of `husky_sim` on, the page of its view shows what the camera sees'
)
_TALK = '`ros2 run demo_nodes_py talker` and `ros2 run demo_nodes_py listener` talk'
_ADD = (
    '`ros2 run demo_nodes_py add_two_ints_server` and `ros2 run demo_nodes_py add_two_ints_client`'
    ' add'
)
_COUNT = (
    '`ros2 run action_tutorials_py fibonacci_action_server` and '
    '`ros2 run action_tutorials_py fibonacci_action_client` count'
)
_JOINTS = (
    '`ros2 run joint_state_publisher joint_state_publisher --ros-args -p delta:=0.05` moves all '
    'joints, and `ros2 topic pub -r 10 /joint_states sensor_msgs/msg/JointState '
    '"{header: auto, name: [a], position: [0.5]}"` publishes one position'
)
_NOTHING = 'nothing does its job, but a sourced ROS 2 Jazzy has it'

BY_PACKAGE = {
    **dict.fromkeys(('rviz2', 'foxglove_bridge'), _VIEW),
    **dict.fromkeys(('rqt', 'rqt_gui', 'rqt_topic', 'rqt_common_plugins'), _CALL),
    'rqt_service_caller': '`ros2 service call` calls a service',
    'rqt_console': _LOG,
    'logging_demo': 'a node with `enable_logger_service=True` has the service '
    '`set_logger_levels`, and `--ros-args --log-level debug` sets its first level',
    'rqt_tf_tree': _FRAMES,
    **dict.fromkeys(('rqt_image_view', 'image_view'), _CAMERA),
    'rqt_plot': '`ros2 topic echo TOPIC --csv` prints the numbers',
    **dict.fromkeys(('gazebo_ros', 'ros_gz_sim', 'ros_gz_bridge', 'webots_ros2_driver'), _HUSKY),
    **dict.fromkeys(
        ('teleop_twist_keyboard', 'teleop_twist_joy', 'joy_teleop', 'rqt_robot_steering'), _TELEOP
    ),
    'joint_state_publisher_gui': _JOINTS,
    **dict.fromkeys(('urdf_tutorial', 'urdf_launch', 'dummy_robot_bringup'), _URDF),
    'turtle_tf2_cpp': '`ros2 launch turtle_tf2_py turtle_tf2_demo.launch.py` does the same, and '
    '`ros2 pkg executables turtle_tf2_py` lists its programs',
    'demo_nodes_cpp': f'{_TALK}, and `ros2 pkg executables demo_nodes_py` lists more',
    **dict.fromkeys(
        ('lifecycle', 'lifecycle_py'),
        'nodes in Python derive from `rclpy.lifecycle.LifecycleNode`, and `ros2 lifecycle` '
        'changes their states',
    ),
    **dict.fromkeys(
        ('quality_of_service_demo_py', 'quality_of_service_demo_cpp'),
        '`ros2 run demo_nodes_py talker_qos` and `ros2 run demo_nodes_py listener_qos` show '
        'reliability, and `ros2 doctor` names what does not match',
    ),
    'action_tutorials_cpp': _COUNT,
    'rclcpp_components': 'nodes in Python share a process where one program adds them to its '
    'executor',
    **{
        f'examples_{library}_minimal_{what}': clause
        for library in ('rclpy', 'rclcpp')
        for what, clause in {
            **dict.fromkeys(('publisher', 'subscriber'), _TALK),
            **dict.fromkeys(('service', 'client'), _ADD),
            **dict.fromkeys(('action_server', 'action_client'), _COUNT),
        }.items()
    },
    **dict.fromkeys(
        (
            *('composition', 'demo_nodes_cpp_native', 'intra_process_demo', 'image_tools'),
            *('examples_rclpy_executors', 'examples_rclpy_guard_conditions'),
            *('examples_rclpy_pointcloud_publisher', 'joy', 'controller_manager'),
            *('nav2_bringup', 'nav2_common', 'nav2_simple_commander', 'nav2_map_server'),
            *('nav2_amcl', 'nav2_lifecycle_manager', 'nav2_controller', 'nav2_planner'),
            *('slam_toolbox', 'robot_localization', 'cartographer_ros', 'depth_image_proc'),
        ),
        _NOTHING,
    ),
}
"""A clause for each package that has no wheel."""

_HERE_IN_PART = {'demo_nodes_cpp'}

_BY_PROGRAM = {
    **{
        ('demo_nodes_cpp', program): '`ros2 run demo_nodes_py introspection` is the service and '
        'its client in one, with the same parameters'
        for program in ('introspection_service', 'introspection_client')
    },
    **dict.fromkeys(
        (('demo_nodes_cpp', 'add_two_ints_server'), ('demo_nodes_cpp', 'add_two_ints_client')),
        _ADD,
    ),
}


def hint(package: str, program: str = '') -> str:
    """Say in one clause that a package has no wheel, and what does its job; '' for others.

    :param program: or launch file, the one of the package that is wanted, where it is known.
    """
    clause = _BY_PROGRAM.get((package, program)) or BY_PACKAGE.get(package)
    return f'it has no wheel; here {clause}' if clause else ''


def hint_of_missing_part(package: str, program: str) -> str:
    """Say the same of a program or launch file that is missing in a package that is here."""
    return hint(package, program) if package in _HERE_IN_PART else ''
