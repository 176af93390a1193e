# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Node names that let one program run many times side by side."""

import os
import time


def unique_node_name(base: str) -> str:
    """
    Return a node name that no other process of this machine has.

    ROS 1 made such a name with ``anonymous=True``; ROS 2 accepts two nodes of one name, and then
    confuses them. A name given by the user (``--ros-args -r __node:=me``) wins.

    :param base: how the name begins.
    :returns: the base, the process id and the time in milliseconds, joined by underscores.
    """
    return f'{base}_{os.getpid()}_{time.time_ns() // 1_000_000}'
