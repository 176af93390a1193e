# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
import os
from pathlib import Path
from typing import Any

from ros2_diagnosis import nearest, packages, stand_ins, workspaces
from ros2cli.arguments import add_completed, add_package
from ros2cli.command import CommandExtension
from ros2cli.discovery import settings_from_environment
from ros2cli.errors import CommandError

from ..option import get_option_extensions

_SUFFIXES = (*packages.LAUNCH_SUFFIXES, '.py', '.xml', '.yaml', '.yml', '.launch')


class LaunchCommand(CommandExtension):
    """Run a launch file."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        parser.add_argument(
            '-n',
            '--noninteractive',
            action='store_true',
            help='Run the launch system noninteractively',
        )
        parser.add_argument(
            '-d',
            '--debug',
            action='store_true',
            help='Put the launch system in debug mode, provides more verbose output.',
        )
        either = parser.add_mutually_exclusive_group()
        either.add_argument(
            '-p',
            '--print',
            '--print-description',
            dest='print_description',
            action='store_true',
            help='Print the launch description to the console without launching it.',
        )
        either.add_argument(
            '-s',
            '--show-args',
            '--show-arguments',
            dest='show_arguments',
            action='store_true',
            help='Show arguments that may be given to the launch file.',
        )
        parser.add_argument(
            '-a',
            '--show-all-subprocesses-output',
            action='store_true',
            help="Show all launched subprocesses' output by overriding their output configuration "
            'using the OVERRIDE_LAUNCH_PROCESS_OUTPUT envvar.',
        )
        parser.add_argument(
            '--launch-prefix',
            help='Prefix command, which should go before all executables. Command must be wrapped '
            'in '
            "quotes if it contains spaces (e.g. --launch-prefix 'xterm -e gdb -ex run --args').",
        )
        parser.add_argument(
            '--launch-prefix-filter',
            help='Regex pattern for filtering which executables the --launch-prefix is applied to '
            'by matching the executable name.',
        )
        add_package(parser, help='Name of the ROS package which contains the launch file')
        add_completed(
            parser, 'launch_file_name', _launch_files, nargs='?', help='Name of the launch file'
        )
        parser.add_argument(
            'launch_arguments',
            nargs='*',
            help="Arguments to the launch file; '<name>:=<value>' (for duplicates, last one wins)",
        )
        self._option_extensions = get_option_extensions()
        for _, extension in sorted(self._option_extensions.items()):
            extension.add_arguments(parser, cli_name)

    def main(self, *, parser: argparse.ArgumentParser, args: argparse.Namespace) -> int:
        path, words = find_launch_file(
            args.package_name, args.launch_file_name, args.launch_arguments
        )
        if args.launch_prefix_filter is not None and args.launch_prefix is None:
            raise CommandError('--launch-prefix-filter is given, but no --launch-prefix')
        api = _api()
        api.parse_launch_arguments(words)  # refuses a malformed one before anything is loaded
        if args.show_arguments:
            return _print(api.print_arguments_of_launch_file, path)
        if args.print_description:
            return _print(api.print_a_launch_file, path)
        settings_from_environment()  # refuses what a node would take without a word
        if args.show_all_subprocesses_output:
            os.environ['OVERRIDE_LAUNCH_PROCESS_OUTPUT'] = 'both'
        if args.package_name in packages.installed():
            workspaces.print_hints(args.package_name)
        return int(
            api.launch_a_launch_file(
                launch_file_path=str(path),
                launch_file_arguments=words,
                noninteractive=args.noninteractive,
                args=args,
                option_extensions=self._option_extensions,
                debug=args.debug,
            )
        )


def _api() -> Any:
    """Import what launches; `ros2 --help` does without."""
    try:
        from ros2launch import api
    except ModuleNotFoundError as error:
        raise CommandError(f"`ros2 launch` needs the module '{error.name}'") from None
    return api


def _print(what: Callable[..., None], path: Path) -> int:
    try:
        what(launch_file_path=str(path))
    except Exception as error:
        raise CommandError(f"'{path}' cannot be loaded: {error}") from None
    return 0


def _launch_files(args: argparse.Namespace) -> list[str]:
    return [path.name for path in packages.launch_files(packages.share_of(args.package_name))]


def find_launch_file(
    package: str, file_name: str | None, words: Sequence[str]
) -> tuple[Path, list[str]]:
    """Tell which file is meant, and which words are left as launch arguments.

    :raises CommandError: there is no such file, package or file in the package.
    """
    path = Path(package)
    is_path = os.sep in package or (path.is_file() and package not in packages.installed())
    if is_path:
        if not path.is_file():
            raise CommandError(f"'{package}' is no file: a launch file or a package is expected")
        return path, [*([file_name] if file_name is not None else []), *words]
    if file_name is None and package.endswith(_SUFFIXES):
        raise CommandError(f"'{package}' is no file in this folder ({Path.cwd()})")
    share = packages.share_of(package, file_name or '')
    known = packages.launch_files(share)
    if file_name is None:
        raise CommandError(
            'A launch file name is required in case a package name is given'
            f"; package '{package}' has {', '.join(sorted(p.name for p in known)) or 'none'}"
        )
    api = _api()
    try:
        found = api.get_share_file_path_from_package(package_name=package, file_name=file_name)
    except FileNotFoundError as error:
        why = packages.why_not_installed(package, file_name)
        if why is not None:
            raise CommandError(f'{error}; {why}') from None
        instead = stand_ins.hint_of_missing_part(package, file_name)
        hint = f': {instead}' if instead else nearest.hint(file_name, (p.name for p in known))
        raise CommandError(f'{error}{hint}') from None
    except api.MultipleLaunchFilesError as error:
        raise CommandError(str(error)) from None
    return Path(found), list(words)
