# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from importlib.metadata import EntryPoint
from typing import Any

from ros2cli import arguments
from ros2cli.command import CommandExtension


class ListingCommand(CommandExtension):
    """Base of the commands that list entry points."""

    WHAT = ''
    INDENT = ''

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_flags(
            parser,
            {
                '-a --all': f"Also show {self.WHAT} that cannot be used, behind '- '",
                '-v --verbose': f'Show more information for each of the {self.WHAT}',
            },
        )

    def show(
        self,
        args: argparse.Namespace,
        entry_point: EntryPoint,
        *,
        make: bool = False,
        details: tuple[str, ...] = (),
    ) -> None:
        """Print one entry point.

        :param make: try to make an instance of it too.
        :param details: more lines for --verbose.
        """
        from ros2cli.entry_points import get_first_line_doc

        found: Any = None
        failure: Exception | None = None
        try:
            found = entry_point.load()
            if make:
                found()
        except Exception as error:
            failure = error
        if failure is not None and not args.all:
            return
        lead = self.INDENT if failure is None else '- '
        # None has a docstring from Python 3.13 on.
        line = '' if found is None else get_first_line_doc(found)
        print(f'{lead}{entry_point.name}: {line}')
        if args.verbose:
            print(f'    module_name: {entry_point.module}')
            print(f'    attributes: {entry_point.attr}')
            if hasattr(found, 'EXTENSION_POINT_VERSION'):
                print(f'    version: {found.EXTENSION_POINT_VERSION}')
            print(*(f'    {line}\n' for line in details), sep='', end='')
        if failure is not None:
            print(f'    reason: {failure}')


class ExtensionsCommand(ListingCommand):
    """List extensions."""

    WHAT = 'extensions'
    INDENT = '  '

    def main(self, *, parser: argparse.ArgumentParser, args: argparse.Namespace) -> None:
        from ros2cli.entry_points import get_all_entry_points

        for group, extensions in sorted(get_all_entry_points().items()):
            print(group)
            for _, (distribution, entry_point) in sorted(extensions.items()):
                name = f'distribution: {distribution.name} {distribution.version}'
                self.show(args, entry_point, make=True, details=(name,))
