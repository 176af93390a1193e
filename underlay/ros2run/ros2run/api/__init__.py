# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Executables of packages, as some launch files look them up."""

from __future__ import annotations

import os
from pathlib import Path

__all__ = ['MultipleExecutables', 'get_executable_path', 'get_executable_paths']


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
