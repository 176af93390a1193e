# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The packages of the ament index, and their programs."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ros2_diagnosis import PackageError, packages


class PackageNotFound(Exception):
    """Raised for a package that is not in the ament index."""

    def __init__(self, package_name: str) -> None:
        super().__init__(package_name)
        self.package_name = package_name


def get_package_names() -> Iterable[str]:
    return packages.installed().keys()


def get_prefix_path(package_name: str) -> str | None:
    """Return the prefix that a package is installed in; None where it is not."""
    prefix = packages.installed().get(package_name)
    return None if prefix is None else str(prefix)


def get_executable_paths(*, package_name: str) -> list[str]:
    """List the paths of a package's programs.

    :raises PackageNotFound: it is not installed.
    """
    try:
        return [str(path) for path in packages.executables(package_name)]
    except PackageError:
        raise PackageNotFound(package_name) from None


def package_name_completer(**_: Any) -> Iterable[str]:
    return get_package_names()
