# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import contextlib
import getpass
import io
import os
from pathlib import Path
import re
import shutil
import subprocess
import sys

from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension

from ros2pkg.creation import cmake_package, licenses, python_package
from ros2pkg.creation.package import BUILD_TYPES, manifest, NewPackage


class CreateVerb(VerbExtension):
    """Create a new ROS 2 package."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        parser.add_argument('package_name', nargs='?', help='The package name')
        parser.add_argument(
            '--package-format',
            '--package_format',
            type=int,
            default=3,
            choices=[2, 3],
            help='The package.xml format.',
        )
        parser.add_argument(
            '--description',
            default='TODO: Package description',
            help='The description given in the package.xml',
        )
        parser.add_argument(
            '--license',
            default='TODO: License declaration',
            help='The license attached to this package; this can be an arbitrary string, but a '
            'LICENSE file will only be generated if it is one of the supported licenses (pass '
            "'?' to get a list)",
        )
        parser.add_argument(
            '--destination-directory',
            default=os.curdir,
            help='Directory where to create the package directory',
        )
        parser.add_argument(
            '--build-type',
            default='ament_cmake',
            choices=BUILD_TYPES,
            help='The build type to process the package with',
        )
        parser.add_argument('--dependencies', nargs='+', default=[], help='list of dependencies')
        parser.add_argument(
            '--maintainer-email', help='email address of the maintainer of this package'
        )
        parser.add_argument('--maintainer-name', help='name of the maintainer of this package')
        parser.add_argument('--node-name', help='name of the empty executable')
        parser.add_argument('--library-name', help='name of the empty library')

    def main(self, *, args: argparse.Namespace) -> int | None:
        if args.license == '?':
            print('Supported licenses:\n' + '\n'.join(licenses.known()))
            return 0
        if args.package_name is None:
            raise CommandError('ros2 pkg create: the name of the package is missing')
        package = _package(args)
        package.check()
        # Not as a Path, which drops the './' that upstream shows.
        root = f'{args.destination_directory}/{package.name}'
        if Path(root).exists():
            raise CommandError(
                f'Aborted!\nThe directory already exists: {root}\nEither remove the directory '
                'or choose a different destination directory or package name'
            )
        text = licenses.text(package.license)
        told = io.StringIO()  # after all is written, for whoever reads it may end: `| head -1`
        try:
            with contextlib.redirect_stdout(told):
                _announce(package, args.destination_directory)
                _write(package, root)
            if text is not None:
                Path(root, 'LICENSE').write_text(text, encoding='utf-8')
        except OSError as error:
            raise CommandError(f"'{error.filename}' cannot be written: {error.strerror}") from None
        finally:
            print(told.getvalue(), end='')
        if text is None:
            print(
                f"\n[WARNING]: Unknown license '{package.license}'.  This has been set in the "
                'package.xml, but no LICENSE file has been created.\nIt is recommended to use one '
                'of the ament license identifiers:\n' + '\n'.join(licenses.known())
            )
        return 0


def _package(args: argparse.Namespace) -> NewPackage:
    node_name = args.node_name
    if node_name is not None and node_name == args.library_name:
        node_name += '_node'
        print('[WARNING] node name can not be equal to the library name', file=sys.stderr)
        print(f'[WARNING] renaming node to {node_name}', file=sys.stderr)
    name = args.maintainer_name or _user()
    return NewPackage(
        name=args.package_name,
        build_type=args.build_type,
        package_format=args.package_format,
        description=args.description,
        license=args.license,
        maintainer_name=name,
        maintainer_email=args.maintainer_email or _email(name),
        dependencies=args.dependencies,
        node_name=node_name,
        library_name=args.library_name,
    )


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return 'user'  # A container may run as a user without a name.


def _email(name: str) -> str:
    """Return the e-mail address configured in git, or a placeholder that tools accept."""
    if shutil.which('git'):
        asked = subprocess.run(['git', 'config', 'user.email'], capture_output=True, text=True)
        if '@' in asked.stdout and '.' in asked.stdout.rpartition('@')[2]:
            return asked.stdout.strip()
    return f'{re.sub(r"[^A-Za-z0-9._-]", "", name) or "user"}@todo.todo'


def _announce(package: NewPackage, destination: str) -> None:
    print('going to create a new package')
    for label, value in (
        ('package name', package.name),
        ('destination directory', Path(destination).resolve()),
        ('package format', package.package_format),
        ('version', package.version),
        ('description', package.description),
        ('maintainer', [f'{package.maintainer_name} <{package.maintainer_email}>']),
        ('licenses', [package.license]),
        ('build type', package.build_type),
        ('dependencies', package.dependencies),
        ('node_name', package.node_name),
        ('library_name', package.library_name),
    ):
        if value is not None:
            print(f'{label}: {value}')


def _write(package: NewPackage, root: str) -> None:
    """Write the package below a folder, which is new, in the order in which upstream tells it."""
    _make_folder(root)
    _write_file(f'{root}/package.xml', manifest(package))
    if package.build_type == 'ament_python':
        print('creating source folder')
        folders, files = [package.name], python_package.files(package)
    else:
        print('creating source and include folder')
        folders, files = ['src', f'include/{package.name}'], cmake_package.files(package)
    for folder in folders:
        _make_folder(f'{root}/{folder}')
    for name, text in files.items():
        path = f'{root}/{name}'
        if not Path(path).parent.exists():
            _make_folder(path.rpartition('/')[0])
        _write_file(path, text)


def _make_folder(path: str) -> None:
    print(f'creating folder {path}')
    Path(path).mkdir(parents=True)


def _write_file(path: str, text: str) -> None:
    print(f'creating {path}')
    Path(path).write_text(text, encoding='utf-8')
