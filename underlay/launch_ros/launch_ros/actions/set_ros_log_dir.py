# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Set the log folder of the nodes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from launch.action import Action
from launch.frontend import expose_action
from launch.launch_context import LaunchContext
from launch.logging.log_folder import logging_directory
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_action('set_ros_log_dir')
class SetROSLogDir(Action):
    """Sets ROS_LOG_DIR of what is started afterwards.

    :param new_log_dir: a relative one is below the present one.
    """

    _attributes = {'new_log_dir': 'new_log_dir'}

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.log_dir = normalize_to_list_of_substitutions(new_log_dir)

    def execute(self, context: LaunchContext) -> None:
        folder = Path(logging_directory(), perform_substitutions(context, self.log_dir))
        context.environment['ROS_LOG_DIR'] = str(folder)
