# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why colcon cannot build a package, from what stands in its package.xml, setup.cfg and setup.py.

colcon takes a package whose package.xml it cannot read for a plain Python one: it builds that, and
ROS never finds it. At the other two files it ends with a traceback of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from configparser import Error, RawConfigParser
import importlib
import os
from pathlib import Path
import re
import sys

from ros2_diagnosis import setup_py

# catkin is what colcon takes a package for that names none; its CMake modules are of ROS 1.
_BUILD_TYPES = ('ament_python', 'ament_cmake', 'cmake')

# A colon parts lists of folders: what is built goes to the Python that colcon runs by. The next
# three are words of the shell in colcon's setup files, the last variables for setuptools.
_NOT_IN_A_PLACE = ':;"`${}'


def why_refused(folder: Path) -> list[str]:
    """Say, a line each, why colcon cannot build the package in a folder; [] where it can."""
    try:
        _check_place(folder)
        build_type = _build_type(folder)
        if build_type != 'ament_python':
            return []
        _check_settings(folder / 'setup.cfg')
        _check_text(folder / 'setup.py', f'there is none; package.xml says {build_type}')
        _check_modules(folder)
    except _RefusedError as error:
        return [str(error)]
    return list(setup_py.faults(folder))


def is_of_cmake(folder: Path) -> bool:
    """Tell whether CMakeLists.txt builds a package, so that colcon reads no setup.py of it."""
    try:
        text = (folder / 'package.xml').read_bytes()
    except OSError:
        return False
    return re.search(rb'<build_type>\s*ament_cmake', text) is not None


def why_not_run(folder: Path, package: str) -> str | None:
    """Say why `ros2 run` finds no program of a built package; None where nothing is wrong."""
    refused = why_refused(folder)
    if refused:
        return f'but colcon cannot build it: {"; ".join(refused)}'
    if not setup_py.has_console_scripts(folder):
        return "but not under 'console_scripts' of entry_points; put it there, and build again"
    called = setup_py.package_called(folder)
    if called is not None and called != package:
        return (
            f'but package.xml calls the package {package!r}, and {folder / "setup.py"} '
            f'{called!r}: write one name in both, and build again'
        )
    settings = RawConfigParser()
    settings.read(folder / 'setup.cfg', encoding='utf-8')
    wanted = f'lib/{package}'
    for section, option in (('develop', 'script_dir'), ('install', 'install_scripts')):
        place = settings.get(section, option, fallback='') or settings.get(
            section, option.replace('_', '-'), fallback=''
        )
        if not place.endswith(wanted):
            return (
                f'but {folder / "setup.cfg"} does not put programs where `ros2 run` looks: write '
                f'{option}=$base/{wanted} below [{section}] and build again'
            )
    return None


class _RefusedError(Exception):
    pass


def _check_place(folder: Path) -> None:
    place = str(folder.resolve())
    for letter in place:
        if letter in _NOT_IN_A_PLACE:
            raise _RefusedError(
                f'{place}: colcon cannot build in a folder with {letter} in its name; rename it'
            )


def _build_type(folder: Path) -> str:
    # It takes its time, and most commands need not know.
    from catkin_pkg.package import InvalidPackage, parse_package

    like = sorted(path.name for path in folder.glob('[Pp]ackage.[Xx]*') if path.is_file())
    remedy = f'rename {like[0]}, if that is it' if like else 'copy that of another'
    _check_text(folder / 'package.xml', f'there is none, by which ROS knows a package; {remedy}')
    try:
        package = parse_package(str(folder), warnings=[])  # colcon shows those
        package.evaluate_conditions({**os.environ, 'DISABLE_GROUPS_WORKAROUND': '1'})
        build_type = str(package.get_build_type())
    except (AssertionError, InvalidPackage) as error:
        raise _RefusedError(f'package.xml: {"; ".join(_reasons(str(error)))}') from None
    if build_type not in _BUILD_TYPES:
        if any(each.name == 'catkin' for each in package.buildtool_depends):
            raise _RefusedError(
                'package.xml is that of a package of ROS 1, which builds with catkin: take the '
                'branch of its repository that is for ROS 2, or port the package '
                '(https://docs.ros.org/en/jazzy/How-To-Guides/Migrating-from-ROS1.html)'
            )
        named = any(export.tagname == 'build_type' for export in package.exports)
        wanted = 'ament_python' if (folder / 'setup.py').is_file() else 'ament_cmake'
        raise _RefusedError(
            f'package.xml has {f"the build type {build_type!r}" if named else "no build type"}: '
            f'write <export><build_type>{wanted}</build_type></export>, that of ROS 2'
        )
    return build_type


def _reasons(text: str) -> Iterator[str]:
    """Return what catkin_pkg has against a file, without the lines around it."""
    for line in text.splitlines():
        reason = line.strip().removeprefix('- ')
        if reason and not reason.startswith(('Error(s)', 'The manifest contains invalid XML')):
            yield reason


def _check_settings(path: Path) -> None:
    if not path.is_file():
        return
    text = _check_text(path, '')
    if text.startswith('\ufeff'):
        raise _RefusedError(
            f'{path.name} begins with a byte order mark, which setuptools does not read: save it '
            f"as UTF-8 without BOM, or `sed -i '1s/^\\xEF\\xBB\\xBF//' {path}`"
        )
    try:
        RawConfigParser().read_string(text, path.name)
    except Error as error:
        raise _RefusedError(f'{path.name}: {" ".join(str(error).split())}') from None


def _check_modules(folder: Path) -> None:
    """Refuse a module by whose name setuptools and `ros2` import one of Python.

    setup.py looks in its own folder first, and a terminal in what is sourced there.
    """
    for path in sorted(folder.iterdir()):
        name = path.name.removesuffix('.py')
        is_module = (path / '__init__.py').is_file() or (path.suffix == '.py' and path.is_file())
        if not is_module or name not in sys.stdlib_module_names:
            continue
        importlib.import_module('setuptools.dist')  # takes its time, and such names are rare
        if name in sys.modules:
            raise _RefusedError(
                f'{path.name} hides the module {name!r} of Python, which setuptools and ros2 '
                f'import: give it another name, such as my_{path.name}, and a package of that '
                'name, too'
            )


def _check_text(path: Path, absent: str) -> str:
    """Return what a file says.

    :raises _RefusedError: it is not there, or no text in UTF-8.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise _RefusedError(f'{path.name}: {absent or error.strerror}') from None
    if b'\0' in data:
        raise _RefusedError(f'{path.name} is saved as UTF-16 (Windows: Unicode): save it as UTF-8')
    conflict = re.search(rb'^<{7} ', data, re.MULTILINE)
    if conflict is not None:
        line = data.count(b'\n', 0, conflict.start()) + 1
        raise _RefusedError(
            f'{path.name}:{line}: a merge conflict of git begins here: keep one of its two sides, '
            'and remove the lines that begin with <<<<<<<, ======= and >>>>>>>'
        )
    try:
        return data.decode()
    except UnicodeDecodeError as error:
        line = data.count(b'\n', 0, error.start) + 1
        raise _RefusedError(
            f'{path.name}:{line}: byte {data[error.start]:#x} is no UTF-8: save the file as UTF-8'
        ) from None
