# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Lets colcon refuse, in one line, a package that it would misread or end amid.

It is installed with the wheels of ROS alone. What is wrong says ros2_diagnosis.package_files.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
import sys
from typing import Any

from colcon_core.event.output import StderrLine
from colcon_core.package_identification import PackageIdentificationExtensionPoint
from colcon_core.task import TaskExtensionPoint
from ros2_diagnosis import package_files, packages

_TYPE = 'refused'
_COPIED = b"['package.xml']"  # as `ros2 pkg create` writes it
_BESIDE = ('setup.py', 'setup.cfg', 'CMakeLists.txt')  # other systems have a package.xml, too
_IGNORED = ('AMENT_IGNORE', 'CATKIN_IGNORE')


class RefusedIdentification(PackageIdentificationExtensionPoint):
    """Take a package that cannot be built for one of the type `refused`."""

    PRIORITY = 160  # before colcon-ros, which passes over a package.xml that it cannot read

    def __init__(self) -> None:
        super().__init__()
        self._workspace = _workspace_around() if sys.argv[1:2] == ['build'] else None

    def identify(self, desc: Any) -> None:
        folder = Path(desc.path)
        manifest = folder / 'package.xml'
        if (
            desc.type is not None
            or not (_is_of_ros(folder) if manifest.is_file() else _asks_for_ros(folder))
            or any((folder / name).exists() for name in _IGNORED)
        ):
            return
        if self._workspace is not None:
            print(
                f'hint: {Path.cwd()}: `colcon build` is called among the sources, where it makes '
                f'build, install and log of its own; call it in {self._workspace}',
                file=sys.stderr,
            )
            self._workspace = None
        if package_files.why_refused(folder):
            desc.type = _TYPE
            desc.name = packages.name_in(folder) if manifest.is_file() else folder.name


def _workspace_around() -> Path | None:
    """Return the workspace in whose sources colcon is called, in src or in a package there."""
    here = Path.cwd()
    if here.name == 'src':
        return here.parent
    is_package = here.parent.name == 'src' and (here / 'package.xml').is_file()
    return here.parents[1] if is_package else None


def _is_of_ros(folder: Path) -> bool:
    """Return whether the package.xml of a folder is one for ROS, as far as can be seen."""
    if any((folder / name).is_file() for name in _BESIDE):
        return True
    try:
        return b'>ament_python</build_type>' in (folder / 'package.xml').read_bytes()
    except OSError:
        return False


def _asks_for_ros(folder: Path) -> bool:
    """Return whether a folder without package.xml was to be a package of ROS."""
    for name, part in (('CMakeLists.txt', b'find_package(ament_cmake'), ('setup.py', _COPIED)):
        with suppress(OSError):
            if part in (folder / name).read_bytes():
                return True
    return False


class RefusedTask(TaskExtensionPoint):
    """Say why."""

    async def build(self) -> int:
        package = self.context.pkg
        for reason in package_files.why_refused(Path(package.path)):
            self.context.put_event_into_queue(StderrLine(f'{package.name}: {reason}\n'.encode()))
        return 2

    test = build
