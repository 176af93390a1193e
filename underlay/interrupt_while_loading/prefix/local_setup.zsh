# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
. "${COLCON_CURRENT_PREFIX:=${0:A:h}}/local_setup.sh"
. "$COLCON_CURRENT_PREFIX/share/ros2cli/environment/ros2-argcomplete.zsh"
