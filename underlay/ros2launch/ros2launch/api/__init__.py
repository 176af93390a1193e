# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files, found in packages, described and launched; for other programs too."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ament_index_python.packages import get_package_share_directory, PackageNotFoundError
import launch
from launch.actions import IncludeLaunchDescription
from launch.frontend import Parser
from launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
    get_launch_description_from_any_launch_file,
)
from launch.launch_introspector import format_substitutions
import launch_ros.substitutions  # noqa: F401 -- says why a package is missing, to any file
from ros2cli.errors import CommandError

from ..option import OptionExtension


class MultipleLaunchFilesError(Exception):
    """Raised when a package has several files of one name.

    ``paths`` names them.
    """

    def __init__(self, msg: str, paths: Sequence[str]) -> None:
        super().__init__(msg)
        self.paths = paths


def get_share_file_path_from_package(*, package_name: str, file_name: str) -> str:
    """Return the path of a file below the share folder of a package.

    :raises PackageNotFoundError: there is no such package.
    :raises FileNotFoundError: it has no such file.
    :raises MultipleLaunchFilesError: it has several.
    """
    share = get_package_share_directory(package_name)
    found = sorted(str(path) for path in Path(share).rglob('*') if path.name == file_name)
    if not found:
        raise FileNotFoundError(
            f"file '{file_name}' was not found in the share directory of package "
            f"'{package_name}' which is at '{share}'"
        )
    if len(found) > 1:
        raise MultipleLaunchFilesError(
            f"file '{file_name}' was found more than once in the share directory of package "
            f"'{package_name}': [{', '.join(map(repr, found))}]",
            found,
        )
    return found[0]


def is_launch_file(path: str) -> bool:
    """Return whether there is a file that has the name of a launch file of any kind."""
    endings = ('launch.py', *Parser.get_file_extensions_from_parsers())
    return path.endswith(endings) and Path(path).is_file()


def get_launch_file_paths(*, path: str) -> list[str]:
    """Return the launch files below a folder."""
    return [str(file) for file in sorted(Path(path).rglob('*')) if is_launch_file(str(file))]


class LaunchFileNameCompleter:
    """Completes the names of the launch files of the package that was typed before."""

    def __init__(self, *, package_name_key: str | None = None) -> None:
        self.package_name_key = package_name_key or 'package_name'

    def __call__(self, prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        del prefix
        try:
            share = get_package_share_directory(getattr(parsed_args, self.package_name_key))
        except PackageNotFoundError:
            return []
        return [Path(path).name for path in get_launch_file_paths(path=share)]


def parse_launch_arguments(launch_arguments: Iterable[str]) -> Iterable[tuple[str, str]]:
    """Split 'name:=value' words; of duplicates the last wins.

    :raises CommandError: a word has another form; upstream's RuntimeError is a base of it.
    """
    parsed: dict[str, str] = {}
    for word in launch_arguments:
        name, _, value = word.partition(':=')
        if not name or not value:
            raise CommandError(
                f"malformed launch argument '{word}', expected format '<name>:=<value>'"
            )
        parsed[name] = value
    return parsed.items()


def print_a_launch_file(*, launch_file_path: str) -> None:
    description = get_launch_description_from_any_launch_file(launch_file_path)
    print(launch.LaunchIntrospector().format_launch_description(description))


def print_arguments_of_launch_file(*, launch_file_path: str) -> None:
    description = get_launch_description_from_any_launch_file(launch_file_path)
    print_arguments_of_launch_description(launch_description=description)


def print_arguments_of_launch_description(*, launch_description: launch.LaunchDescription) -> None:
    """Print the arguments that a launch description and what it includes declare."""
    print("Arguments (pass arguments as '<name>:=<value>'):")
    declared = launch_description.get_launch_arguments()
    for argument in declared:
        print(f"\n    '{argument.name}':{'*' * argument._conditionally_included}")
        for line in argument.description.splitlines():
            print(f'        {line}')
        if argument.default_value is not None:
            print(f'        (default: {format_substitutions(argument.default_value)})')
    if not declared:
        print('\n  No arguments.')
    if any(argument._conditionally_included for argument in declared):
        print('\n* argument(s) which are only used if specific conditions occur')


def launch_a_launch_file(
    *,
    launch_file_path: str,
    launch_file_arguments: Sequence[str],
    noninteractive: bool = False,
    args: argparse.Namespace | None = None,
    option_extensions: Mapping[str, OptionExtension] | None = None,
    debug: bool = False,
) -> int:
    """Run a launch file to its end; return the exit status.

    :param args: of the command line: ``launch_prefix``, ``launch_prefix_filter``, and what the
        extensions know.
    """
    extensions = [extension for _, extension in sorted((option_extensions or {}).items())]
    for extension in extensions:
        extension.prestart(args)
    words = list(launch_file_arguments)
    if args is not None and args.launch_prefix:
        words.append(f'launch-prefix:={args.launch_prefix}')
    if args is not None and args.launch_prefix_filter:
        words.append(f'launch-prefix-filter:={args.launch_prefix_filter}')
    service = launch.LaunchService(argv=words, noninteractive=noninteractive, debug=debug)
    include = IncludeLaunchDescription(
        AnyLaunchDescriptionSource(launch_file_path),
        launch_arguments=parse_launch_arguments(words),
    )
    description = launch.LaunchDescription([include])
    for extension in extensions:
        description = extension.prelaunch(description, args)[0]
    service.include_launch_description(description)
    status = service.run()
    for extension in extensions:
        extension.postlaunch(status, args)
    return status
