# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
#
# Makes a terminal know this ROS 2, as /opt/ros/jazzy/local_setup.sh does there. The setup files that
# colcon writes for a workspace source it, with COLCON_CURRENT_PREFIX set to this folder.

if [ ! -x "${COLCON_CURRENT_PREFIX:-}/bin/ros2" ]; then
    echo 'source the setup.bash of a workspace, or call ./lab shell' >&2
elif [ "${VIRTUAL_ENV:-}" != "$COLCON_CURRENT_PREFIX" ] || [ "${HUSKY_LAB_ROS:-}" != pip ]; then
    export VIRTUAL_ENV="$COLCON_CURRENT_PREFIX" HUSKY_LAB_ROS=pip PATH="$COLCON_CURRENT_PREFIX/bin:$PATH"
    export ROS_VERSION=2 ROS_PYTHON_VERSION=3 ROS_DISTRO=jazzy
    export AMENT_PREFIX_PATH="$VIRTUAL_ENV${AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}"
    # What the wheels would look up by executing Python a second time.
    export LD_LIBRARY_PATH="$VIRTUAL_ENV/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" _ROS_WHEELS_BOOTSTRAP_COMPLETE=1
    # File names and what stands in files are UTF-8, whatever the locale of the terminal.
    export PYTHONUTF8="${PYTHONUTF8:-1}"
    # Or `command.linear.x = 1` is sent as 5e-324; with it the error names field and line.
    export ROS_PYTHON_CHECK_FIELDS="${ROS_PYTHON_CHECK_FIELDS:-1}"
    # As ./lab: a classroom must not talk across desks, and nodes find each other at once.
    export ROS_AUTOMATIC_DISCOVERY_RANGE="${ROS_AUTOMATIC_DISCOVERY_RANGE:-LOCALHOST}"
    if [ -f "$VIRTUAL_ENV/../config/fastdds.xml" ]; then
        export FASTRTPS_DEFAULT_PROFILES_FILE="${FASTRTPS_DEFAULT_PROFILES_FILE:-$VIRTUAL_ENV/../config/fastdds.xml}"
    fi
fi
