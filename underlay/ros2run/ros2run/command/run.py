# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import os
from pathlib import Path
import shlex
import signal
import sys
from typing import NoReturn

from interrupt_while_loading import takes_blocked_interrupt
from ros2_diagnosis import packages, workspaces
from ros2cli import arguments
from ros2cli.command import CommandExtension
from ros2cli.discovery import settings_from_environment
from ros2cli.errors import CommandError, UsageError


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

    def main(self, *, parser: argparse.ArgumentParser, args: argparse.Namespace) -> NoReturn:
        if args.executable_name is None:
            known = sorted(path.name for path in packages.executables(args.package_name))
            raise UsageError(
                f"ros2 run: the name of the executable is missing; package '{args.package_name}' "
                f'has '
                f'{", ".join(known) or "none"}'
            )
        settings_from_environment()  # refuses what a node would take without a word
        path = packages.find_executable(args.package_name, args.executable_name)
        try:
            prefix = shlex.split(args.prefix or '')
        except ValueError as error:
            raise UsageError(f'--prefix {args.prefix!r} is refused: {error}') from None
        workspaces.print_hints(args.package_name)
        replace_process([*prefix, str(path), *args.argv])


def replace_process(command: list[str]) -> NoReturn:
    """Become the command: signals, exit status and terminal are then its own.

    :raises CommandError: it cannot be started.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    if takes_blocked_interrupt(command[0]):
        signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
    try:
        os.execvp(command[0], command)
    except OSError as error:
        reason = error.strerror or str(error)
        shebang = _shebang(Path(command[0]))
        if isinstance(error, FileNotFoundError) and shebang:
            reason = f"its first line names '{shebang}', which does not exist; build it again"
        raise CommandError(f"'{command[0]}' cannot be run: {reason}") from None


def _shebang(path: Path) -> str:
    try:
        with path.open('rb') as file:
            line = file.readline(256)
    except OSError:
        return ''
    return line[2:].decode(errors='replace').strip() if line.startswith(b'#!') else ''
