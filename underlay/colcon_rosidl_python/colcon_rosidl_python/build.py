# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Build packages of ament_cmake that need no compiler into a prefix.

    python -m colcon_rosidl_python.build [--symlink-install] PREFIX FOLDER...

What the definitions name is looked for in AMENT_PREFIX_PATH and in the prefix. Of a package with a
mistake nothing is installed; what was installed before stays.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
import gc
import hashlib
import os
from pathlib import Path
import sys
import tempfile

from ament_index_python import get_package_share_directory, PackageNotFoundError
from catkin_pkg.package import InvalidPackage, Package, parse_package
from rosidl_adapter.parser import is_valid_package_name

from colcon_rosidl_python.cmake_commands import CMakeListsError
from colcon_rosidl_python.cmake_package import CMakePackage, read_cmake_package
from colcon_rosidl_python.definitions import mistakes, SEPARATORS
from colcon_rosidl_python.files import install_files, install_interfaces, install_manifest

GROUP = 'rosidl_interface_packages'
# CMake finds them on every Jazzy, and takes nothing of them: they have no interfaces.
_WITHOUT_INTERFACES = {
    *('ament_cmake', 'ament_cmake_python', 'rclcpp'),
    *('rosidl_default_generators', 'rosidl_default_runtime'),
}


class BuildError(RuntimeError):
    """A package cannot be built; the message says why, a line for each reason."""


def main() -> int:
    arguments = _parser().parse_args()
    gc.disable()  # a fifth of the time, in a process that keeps what it reads and ends soon
    prefix = arguments.prefix.absolute()
    known = os.environ.get('AMENT_PREFIX_PATH')
    os.environ['AMENT_PREFIX_PATH'] = os.pathsep.join(filter(None, (str(prefix), known)))
    for folder in arguments.folders:
        try:
            build(folder.absolute(), prefix, link=arguments.symlink_install)
        except (BuildError, CMakeListsError, InvalidPackage) as error:
            for line in str(error).splitlines():
                print(f'{folder.name}: {line}', file=sys.stderr)
            return 2
        except KeyboardInterrupt:
            print(f'{folder.name}: interrupted', file=sys.stderr)
            return 130
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description='Build packages of ament_cmake into a prefix.')
    parser.add_argument('--symlink-install', action='store_true')
    parser.add_argument('prefix', type=Path)
    parser.add_argument('folders', type=Path, nargs='+')
    return parser


def build(folder: Path, prefix: Path, *, link: bool) -> None:
    """
    Install a package; of its interfaces only what has changed.

    :param link: to files instead of a copy of them.
    :raises BuildError: if a definition, or what it needs, is wrong.
    :raises CMakeListsError: if it asks for what cannot be done here.
    """
    manifest = parse_package(folder)
    package = read_cmake_package(folder)
    for path in _not_named(folder, package):
        print(
            f'{manifest.name}: {path}: is not built: no rosidl_generate_interfaces of '
            'CMakeLists.txt names it',
            file=sys.stderr,
        )
    if package.interfaces:
        _build_interfaces(folder, prefix, manifest, package)
    install_files(folder, prefix, package, link=link)
    install_manifest(manifest, prefix)


def _not_named(folder: Path, package: CMakePackage) -> Iterator[Path]:
    """Yield the definitions where they usually are that CMakeLists.txt does not name."""
    for suffix in SEPARATORS:
        for path in sorted((folder / suffix[1:]).glob(f'*{suffix}')):
            if path.relative_to(folder) not in package.interfaces:
                yield path.relative_to(folder)


def _build_interfaces(
    folder: Path, prefix: Path, manifest: Package, package: CMakePackage
) -> None:
    if not is_valid_package_name(manifest.name):
        raise BuildError(
            f'package.xml: {manifest.name!r} is no name of a package of interfaces: allowed are '
            'small letters, digits and single underscores, beginning with a letter'
        )
    shares = _shares(manifest, package)
    known = _Known(manifest.name, package, shares)
    reasons = list(_wrong_in_manifest(manifest))
    for path in package.interfaces:
        reasons += mistakes(manifest.name, folder, path, known)
    if reasons:
        raise BuildError('\n'.join(reasons))
    key = _key(folder, package, shares)
    stamp = prefix / 'share' / manifest.name / '.interfaces'
    if stamp.is_file() and stamp.read_text() == key:
        return
    # to import the generators takes longer than all else, where nothing has changed
    from colcon_rosidl_python.generator import generate, GenerationError

    with tempfile.TemporaryDirectory() as new:
        try:
            generate(manifest.name, package.interfaces, folder, Path(new), shares)
        except GenerationError as error:
            raise BuildError(str(error)) from None
        stamp.unlink(missing_ok=True)  # an interrupt leaves nothing that seems whole
        install_interfaces(manifest.name, Path(new), prefix)
    stamp.write_text(key)


def _shares(manifest: Package, package: CMakePackage) -> dict[str, Path]:
    """
    Find the packages whose messages definitions may name.

    They are those in DEPENDENCIES and those that these depend on, as in rosidl_cmake.
    """
    declared = {dependency.name for dependency in manifest.build_depends}
    shares: dict[str, Path] = {}
    found: dict[str, Path] = {}  # with what these look for themselves
    for name in package.found:
        _add_share(name, found)
    for name in package.dependencies:
        if name in _WITHOUT_INTERFACES:
            continue
        add = '' if name in declared else f'package.xml: add <depend>{name}</depend>'
        if not _add_share(name, shares):
            raise BuildError(
                f'CMakeLists.txt: DEPENDENCIES names {name}, which is not found: mend the name, '
                f'or put that package into the workspace{add and f"; {add}"}'
            )
        if name not in found:
            raise BuildError(
                f'CMakeLists.txt: DEPENDENCIES names {name}, which CMake does not know yet: write '
                f'find_package({name} REQUIRED) above it'
            )
        if add:  # CMake asks no manifest, but colcon does, for what to build first
            print(f'{manifest.name}: {add}; CMakeLists.txt names it', file=sys.stderr)
    kinds = {_kind(path) for path in package.interfaces}
    for kind, name in (('action', 'action_msgs'), ('srv', 'service_msgs')):
        if kind in kinds:
            _add_share(name, shares)
    return shares


def _add_share(name: str, shares: dict[str, Path]) -> bool:
    """Add a package of interfaces and those that it depends on; tell whether there is one."""
    if name in shares:
        return True
    try:
        share = Path(get_package_share_directory(name))
    except PackageNotFoundError:
        return False
    shares[name] = share
    for dependency in parse_package(share).build_export_depends:
        _add_share(dependency.name, shares)
    return True


def _wrong_in_manifest(manifest: Package) -> Iterator[str]:
    if not any(group.name == GROUP for group in manifest.member_of_groups):
        yield f'package.xml: add <member_of_group>{GROUP}</member_of_group>'


class _Known:
    """Says whether a message is one that definitions of a package may name."""

    def __init__(self, name: str, package: CMakePackage, shares: dict[str, Path]) -> None:
        self._name = name
        self._own = [path.stem for path in package.interfaces if _kind(path) == 'msg']
        self._shares = shares

    def __call__(self, package: str, message: str) -> str:
        if package == self._name:
            if message in self._own:
                return ''
            own = f'its messages are {", ".join(self._own)}' if self._own else 'it has no messages'
            return f'CMakeLists.txt names no msg/{message}.msg; {own}'
        if package not in self._shares:
            return f'of {package}: add {package} to DEPENDENCIES in CMakeLists.txt'
        folder = self._shares[package] / 'msg'
        if not (folder / f'{message}.json').is_file():
            names = ', '.join(sorted(path.stem for path in folder.glob('*.json')))
            return f'{package} has no such message; it has {names}'
        return ''


def _kind(path: Path) -> str:
    return path.parent.name if path.suffix == '.idl' else path.suffix[1:]


def _key(folder: Path, package: CMakePackage, shares: dict[str, Path]) -> str:
    """Name everything that what is installed depends on."""
    own = sorted(Path(__file__).parent.glob('*.py'))
    described = sorted(path for share in shares.values() for path in share.glob('*/*.json'))
    manifest = [folder / 'package.xml', folder / 'CMakeLists.txt']
    files = [*own, *described, *manifest, *(folder / path for path in package.interfaces)]
    digest = hashlib.sha256()
    for path in files:
        data = path.read_bytes()
        digest.update(f'{path} {len(data)}\n'.encode() + data)
    return digest.hexdigest()


if __name__ == '__main__':
    sys.exit(main())
