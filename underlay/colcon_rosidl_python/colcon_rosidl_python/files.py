# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Puts the files that a package installs, and its marks, into a prefix."""

from __future__ import annotations

from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
import shutil
from types import SimpleNamespace

from catkin_pkg.package import Package
from colcon_core.task import install

from colcon_rosidl_python.cmake_commands import python_folder
from colcon_rosidl_python.cmake_package import CMakePackage, Install

_INDEX = 'share/ament_index/resource_index'
_DEFINITIONS = ('.action', '.idl', '.msg', '.srv')
_OF_A_PROGRAM = 0o755  # cmake-commands(7), install(PROGRAMS)


def install_files(folder: Path, prefix: Path, package: CMakePackage, *, link: bool) -> None:
    """Copy what install(...) and ament_python_install_package(...) name, or link to it."""
    modules = [
        Install(source, python_folder() / name, ('__pycache__', '*.pyc'))
        for name, source in package.modules.items()
    ]
    arguments = SimpleNamespace(path=folder, install_base=prefix, symlink_install=link)
    for wanted in (*package.installs, *modules):
        for source, target in _files(folder, wanted):
            install(arguments, source, target)
            if wanted.is_program and not link:
                (prefix / target).chmod(_OF_A_PROGRAM)


def _files(folder: Path, wanted: Install) -> Iterator[tuple[Path, Path]]:
    """Yield the source and the target of each file."""
    if not (folder / wanted.source).is_dir():
        yield wanted.source, wanted.target
        return
    for path in sorted((folder / wanted.source).rglob('*')):
        inside = path.relative_to(folder / wanted.source)
        is_left_out = any(fnmatch(part, name) for part in inside.parts for name in wanted.without)
        is_wanted = not wanted.only or any(fnmatch(path.name, name) for name in wanted.only)
        if path.is_file() and is_wanted and not is_left_out:
            yield path.relative_to(folder), wanted.target / inside


def install_interfaces(name: str, new: Path, prefix: Path) -> None:
    """
    Put what was made of definitions into a prefix, in place of what was there.

    :param new: the folder that has share/NAME and python/NAME.
    """
    share, site = prefix / 'share' / name, prefix / python_folder()
    site.mkdir(parents=True, exist_ok=True)
    for old in (site / name, *(share / kind for kind in ('msg', 'srv', 'action'))):
        shutil.rmtree(old, ignore_errors=True)
    shutil.move(new / 'python' / name, site / name)
    shutil.copytree(new / 'share' / name, share, dirs_exist_ok=True)
    definitions = [path for path in share.glob('*/*') if path.suffix in _DEFINITIONS]
    names = sorted(str(path.relative_to(share)) for path in definitions)
    _mark(prefix, 'rosidl_interfaces', name, '\n'.join(names))


def install_manifest(manifest: Package, prefix: Path) -> None:
    """Put package.xml, and the package's marks, into a prefix."""
    share = prefix / 'share' / manifest.name
    share.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(manifest.filename, share / 'package.xml')
    depends = sorted({dependency.name for dependency in manifest.exec_depends})
    _mark(prefix, 'packages', manifest.name, '')
    _mark(prefix, 'package_run_dependencies', manifest.name, ';'.join(depends))


def _mark(prefix: Path, index: str, name: str, content: str) -> None:
    mark = prefix / _INDEX / index / name
    mark.parent.mkdir(parents=True, exist_ok=True)
    mark.write_text(content)
