# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why a node has ended that was to go on, or too soon."""

from __future__ import annotations

from pathlib import Path
import re
import sys

from ros2_diagnosis import packages, setup_py

_COMMENT = re.compile(r'#.*')
_WAITS = re.compile(r'\.create_(subscription|timer|service)\(|\bActionServer\(')
_PUBLISHES, _CALLS = re.compile(r'\.publish\('), re.compile(r'\.call_async\(')
_LETS_OTHERS_FIND_IT = re.compile(r'sleep|wait|get_subscription_count|count_subscribers|input\(')
# What serves callbacks, and what may go on without. Each program of the lab sheet has
# `rclpy.executors` among its imports.
_GOES_ON = re.compile(r'spin|Executor\b|\bexecutor\b|\bwhile\b|wait_for_message')


def print_hint(package: str, program: str) -> None:
    """Tell on stderr why a program that has ended well may have done nothing."""
    source = packages.source_of(package)
    path = setup_py.module_of(source, program) if source is not None else None
    if path is None:
        return
    code = _COMMENT.sub('', path.read_text(encoding='utf-8', errors='replace'))
    if why := _why(code, path):
        print(f'hint: {package}: {program} has ended, {why}', file=sys.stderr)


def _why(code: str, path: Path) -> str:
    if _GOES_ON.search(code):
        return ''
    if waits := _WAITS.search(code):
        return (
            f'because {path} has a {waits[1] or "action server"}, but calls no rclpy.spin(), '
            'without which no callback is ever called; write `rclpy.spin(node)` behind the line '
            'that makes the node'
        )
    if _CALLS.search(code):
        return (
            f'because {path} calls a service, but no rclpy.spin...(), without which no answer is '
            'taken; write `rclpy.spin_until_future_complete(node, future)` behind the call'
        )
    if _PUBLISHES.search(code) and not _LETS_OTHERS_FIND_IT.search(code):
        return (
            f'and {path} publishes before any subscription can have found it, so that nobody got '
            'it; publish in a timer and `rclpy.spin(node)`, or wait until the publisher has a '
            'get_subscription_count()'
        )
    return ''
