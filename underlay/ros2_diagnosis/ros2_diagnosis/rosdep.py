# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The command rosdep, as tutorials call it before they build.

The real one has the package manager of the system install what a package.xml names. Here packages
are wheels, and nothing of the system is touched: it tells which of them are missing.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator
from contextlib import suppress
from importlib.metadata import distributions
from importlib.util import find_spec
from pathlib import Path
import sys

from ament_index_python import get_packages_with_prefixes
from catkin_pkg.package import InvalidPackage, Package
from catkin_pkg.packages import find_packages

from ros2_diagnosis.stand_ins import hint

_DEPENDENCIES = ('build', 'buildtool', 'build_export', 'exec', 'test')
# What builds and checks packages elsewhere; colcon does without it here.
_TOOLS = ('ament_', 'rosidl_default_')
_PIP = 'python3-'
_MODULES = {'opencv': 'cv2', 'pil': 'PIL'}  # of keys that are not named as their modules
# Of keys that are named as their modules, where pip has another name, and mostly another
# distribution of that name.
_DISTRIBUTIONS = {
    'bs4': 'beautifulsoup4',
    'can': 'python-can',
    'dateutil': 'python-dateutil',
    'git': 'GitPython',
    'opencv': 'opencv-python-headless',
    'pil': 'pillow',
    'serial': 'pyserial',
    'skimage': 'scikit-image',
    'sklearn': 'scikit-learn',
    'usb': 'pyusb',
    'websocket': 'websocket-client',
    'yaml': 'PyYAML',
    'zmq': 'pyzmq',
}


def main() -> int:
    """Do what the command line asks for; return the exit status."""
    parser = argparse.ArgumentParser(prog='rosdep', description=__doc__)
    parser.add_argument('command', choices=('init', 'update', 'check', 'install'))
    parser.add_argument('packages', nargs='*', help='names of packages, which must be here')
    parser.add_argument(
        '--from-paths', nargs='+', default=[], metavar='PATH', help='folders of packages'
    )
    parser.add_argument('--skip-keys', action='append', default=[], metavar='KEYS')
    for flags in (
        ('-i', '--ignore-packages-from-source', '--ignore-src'),
        *(('-y', '--default-yes'), ('-r',), ('-s', '--simulate'), ('-q', '--quiet')),
        *(('-v', '--verbose'), ('-a', '--all'), ('--reinstall',), ('--include-eol-distros',)),
    ):
        parser.add_argument(*flags, action='store_true', help='as in rosdep; of no effect here')
    for option in ('--rosdistro', '--os', '-t', '--dependency-types'):
        parser.add_argument(option, help='as in rosdep; of no effect here')
    arguments = parser.parse_args()
    if arguments.command in ('init', 'update'):
        print('nothing to do: the packages of this installation are wheels')
        return 0
    if not (arguments.packages or arguments.from_paths):
        parser.error('name packages, or folders of packages: --from-paths src')
    try:
        found = [each for path in arguments.from_paths for each in _packages_in(Path(path))]
    except ValueError as error:
        parser.error(str(error))
    skipped = {key for keys in arguments.skip_keys for key in keys.split()}
    missing = [*_missing(found, skipped), *_absent(arguments.packages)]
    for line in missing:
        print(f'rosdep: {line}', file=sys.stderr)
    if not missing:
        print('#All required rosdeps installed successfully')
    return 1 if missing else 0


def _packages_in(folder: Path) -> list[Package]:
    if not folder.is_dir():
        raise ValueError(f"given path '{folder}' does not exist")
    try:
        return list(find_packages(str(folder)).values())
    except InvalidPackage as error:
        raise ValueError(' '.join(str(error).split())) from None


def _missing(packages: Iterable[Package], skipped: set[str]) -> Iterator[str]:
    here = {package.name for package in packages} | get_packages_with_prefixes().keys() | skipped
    for package in packages:
        keys = {
            dependency.name
            for kind in _DEPENDENCIES
            for dependency in getattr(package, f'{kind}_depends')
            if dependency.evaluated_condition is not False
        }
        for key in sorted(keys - here):
            if not key.startswith(_TOOLS) and not _is_installed(key):
                yield f'{package.name} needs {key}, which is not here{_remedy(key)}'


def _absent(names: Iterable[str]) -> Iterator[str]:
    here = get_packages_with_prefixes()
    for name in names:
        if name not in here:
            yield f'{name} is not here{_remedy(name)}'


def _is_installed(key: str) -> bool:
    """Return whether a key names a module of Python that is there, as `python3-numpy` does."""
    name = key.removeprefix(_PIP).removesuffix('-pip').removesuffix('-modules')
    module = _MODULES.get(name, name.replace('-', '_'))
    known = {each.name.lower().replace('_', '-') for each in distributions()}
    if name in known:
        return True
    with suppress(ImportError, ValueError):  # no name, or nothing of that before its dot
        return find_spec(module) is not None
    return False


def _remedy(key: str) -> str:
    if instead := hint(key):
        return f': {instead}'
    if key.startswith(_PIP):
        name = key.removeprefix(_PIP).removesuffix('-pip')
        return f'; `pip install {_DISTRIBUTIONS.get(name, name)}` may bring it'
    return '; a package with C++ in it needs a sourced ROS 2 Jazzy'


if __name__ == '__main__':
    sys.exit(main())
