# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What does the job of packages that tutorials name and the pip installation lacks."""

from __future__ import annotations

_GRAPH = '`ros2 run rqt_graph rqt_graph` shows the graph, and `ros2 doctor` what is wrong in it'
_DEMO = '`ros2 run topic_demo publisher` and `ros2 run topic_demo subscriber` talk'
_HUSKY = '`ros2 launch husky_sim husky_playpen.launch.py` starts a robot in a world'
_TELEOP = '`ros2 run husky_driver teleop` drives by the keys'
_FRAMES = '`ros2 run tf2_tools view_frames --live` shows the tree of frames in the browser'
_VIEW = f'{_HUSKY}, and with `viewer:=true` shows it in the browser'

BY_PACKAGE = {
    **dict.fromkeys(('rviz2', 'foxglove_bridge'), _VIEW),
    **dict.fromkeys(('rqt', 'rqt_gui', 'rqt_topic', 'rqt_console', 'rqt_common_plugins'), _GRAPH),
    'rqt_tf_tree': _FRAMES,
    'rqt_plot': '`ros2 topic echo TOPIC --csv` prints the numbers',
    **dict.fromkeys(('gazebo_ros', 'ros_gz_sim', 'ros_gz_bridge'), _HUSKY),
    **dict.fromkeys(('teleop_twist_keyboard', 'teleop_twist_joy'), _TELEOP),
    **dict.fromkeys(('demo_nodes_py', 'demo_nodes_cpp'), _DEMO),
}
"""A clause for each package that has no wheel."""
