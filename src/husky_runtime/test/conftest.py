# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What these tests need of the ROS that they run on."""

from playpen_testing.which_ros import lacks

# Only Fast DDS puts messages into shared memory; a small Jazzy may have another alone.
collect_ignore = ['test_shared_memory.py'] if lacks('rmw_fastrtps_cpp') else []
