# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Executables of packages: where they are, and how they are run."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import os
from pathlib import Path
import signal
from typing import Any

__all__ = [
    'ROS2RUN_MSG_PREFIX',
    'ExecutableNameCompleter',
    'MultipleExecutables',
    'get_executable_path',
    'get_executable_paths',
    'run_executable',
]

ROS2RUN_MSG_PREFIX = '[ros2run]:'


class MultipleExecutables(Exception):
    """Raised when a package has several executables of one name."""

    def __init__(self, paths: list[str]) -> None:
        super().__init__(f'multiple executables: {", ".join(paths)}')
        self.paths = paths


def get_executable_paths(*, package_name: str) -> list[str]:
    """Return the paths of all executables of a package."""
    from ament_index_python.packages import get_package_prefix

    folder = Path(get_package_prefix(package_name)) / 'lib' / package_name
    if not folder.is_dir():
        return []
    return sorted(
        str(path) for path in folder.rglob('*') if path.is_file() and os.access(path, os.X_OK)
    )


def get_executable_path(*, package_name: str, executable_name: str) -> str | None:
    """Return the path of an executable, None where there is none.

    :raises MultipleExecutables: there are several of that name.
    """
    paths = [
        path
        for path in get_executable_paths(package_name=package_name)
        if Path(path).name == executable_name
    ]
    if len(paths) > 1:
        raise MultipleExecutables(paths)
    return paths[0] if paths else None


def run_executable(*, path: str, argv: Sequence[str], prefix: Sequence[str] | None = None) -> int:
    """Run an executable to its end, say if that was not a good one, and return its exit status.

    :param prefix: words to go before the path.
    :returns: -N where signal N ended it.
    :raises OSError: it cannot be started.
    """
    from ros2run import child

    status = child.run([*(prefix or ()), path, *argv])
    if status < 0:
        print(ROS2RUN_MSG_PREFIX, signal.strsignal(-status))
    elif status > 0:
        print(ROS2RUN_MSG_PREFIX, f'Process exited with failure {status}')
    return status


class ExecutableNameCompleter:
    """Offers the executables of the package that the arguments name.

    :param package_name_key: where the arguments hold the package.
    """

    def __init__(self, *, package_name_key: str | None = None) -> None:
        self.package_name_key = package_name_key

    def __call__(self, prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        from ros2_diagnosis import packages

        package = getattr(parsed_args, self.package_name_key or '')
        return [path.name for path in packages.executables(package)]
