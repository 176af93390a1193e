# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why a node has ended that was to go on."""

from __future__ import annotations

import re
import sys

from ros2_diagnosis import packages, setup_py

_COMMENT = re.compile(r'#.*')
_WAITS = re.compile(r'\.create_(subscription|timer|service)\(|\bActionServer\(')
# What serves callbacks, and what may go on without. Each program of the lab sheet has
# `rclpy.executors` among its imports.
_GOES_ON = re.compile(r'spin|Executor\b|\bexecutor\b|\bwhile\b|wait_for_message')


def print_hint(package: str, program: str) -> None:
    """Tell on stderr that a program that has ended well does not serve its callbacks."""
    source = packages.source_of(package)
    path = setup_py.module_of(source, program) if source is not None else None
    if path is None:
        return
    code = _COMMENT.sub('', path.read_text(encoding='utf-8', errors='replace'))
    waits = _WAITS.search(code)
    if waits is not None and _GOES_ON.search(code) is None:
        print(
            f'hint: {package}: {program} has ended, because {path} has a '
            f'{waits[1] or "action server"}, but calls no rclpy.spin(), without which no callback '
            'is ever called; write `rclpy.spin(node)` behind the line that makes the node',
            file=sys.stderr,
        )
