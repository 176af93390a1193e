# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from pathlib import Path
import shlex

from ros2_diagnosis import packages, programs, workspaces
from ros2cli import arguments
from ros2cli.command import CommandExtension
from ros2cli.discovery import settings_from_environment
from ros2cli.errors import CommandError, UsageError

from ros2run.api import run_executable


class RunCommand(CommandExtension):
    """Run a package specific executable."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        parser.add_argument(
            '--prefix',
            help='Prefix command, which should go before the executable. Command must be wrapped '
            'in '
            "quotes if it contains spaces (e.g. --prefix 'gdb -ex run --args').",
        )
        arguments.add_package(parser, help='Name of the ROS package')
        arguments.add_completed(
            parser,
            'executable_name',
            lambda args: [path.name for path in packages.executables(args.package_name)],
            nargs='?',
            help='Name of the executable',
        )
        parser.add_argument(
            'argv', nargs=argparse.REMAINDER, help='Pass arbitrary arguments to the executable'
        )

    def main(self, *, parser: argparse.ArgumentParser, args: argparse.Namespace) -> int:
        if args.executable_name is None:
            known = sorted(path.name for path in packages.executables(args.package_name))
            raise UsageError(
                f"ros2 run: the name of the executable is missing; package '{args.package_name}' "
                f'has {", ".join(known) or "none"}'
            )
        settings_from_environment()  # refuses what a node would take without a word
        path = packages.find_executable(args.package_name, args.executable_name)
        try:
            prefix = shlex.split(args.prefix or '')
        except ValueError as error:
            raise UsageError(f'--prefix {args.prefix!r} is refused: {error}') from None
        if why := workspaces.why_left(args.package_name, path):
            raise CommandError(f'No executable found: {why}')
        workspaces.print_hints(args.package_name)
        if args.argv:
            from ros2_diagnosis import ros_arguments  # most programs are given none

            ros_arguments.print_hints(args.package_name, args.executable_name, args.argv)
        status = _run(str(path), args.argv, prefix)
        if status == 0:
            from ros2_diagnosis import early_ends  # the program shall not wait for it

            early_ends.print_hint(args.package_name, args.executable_name)
        return status


def _run(path: str, words: list[str], prefix: list[str]) -> int:
    why = programs.why_unrunnable(Path(path))
    if why is not None and not prefix:  # `python3` would run it
        raise CommandError(f"'{path}' cannot be run: {why}")
    try:
        return run_executable(path=path, argv=words, prefix=prefix)
    except BrokenPipeError:  # how it ended can be told to nobody
        raise
    except OSError as error:
        program = (prefix or [path])[0]
        reason = error.strerror or str(error)
        named = programs.interpreter(Path(program))
        if isinstance(error, FileNotFoundError) and named:
            reason = f"its first line names '{named}', which does not exist; build it again"
        raise CommandError(f"'{program}' cannot be run: {reason}") from None
