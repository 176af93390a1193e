# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
. "${COLCON_CURRENT_PREFIX:=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)}/local_setup.sh"
. "$COLCON_CURRENT_PREFIX/share/ros2cli/environment/ros2-argcomplete.bash"
