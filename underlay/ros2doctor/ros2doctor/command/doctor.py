# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments
from ros2cli.command import add_subparsers_on_demand, CommandExtension

from ros2doctor import api
from ros2doctor.api.format import format_print


class DoctorCommand(CommandExtension):
    """Check ROS setup and other potential issues.

    Each fault is told in one line: where, what and why, and the command that mends it.
    """

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        group = parser.add_mutually_exclusive_group()
        arguments.add_flags(
            group,
            {
                '--report -r': 'Print all reports.',
                '--report-failed -rf': 'Print reports of failed checks only.',
            },
        )
        arguments.add_flags(
            parser,
            {
                '--exclude-packages -ep': 'Exclude package checks or report.',
                '--include-warnings -iw': 'Include warnings as failed checks. Warnings are '
                'ignored by default.',
            },
        )
        add_subparsers_on_demand(parser, cli_name, '_verb', 'ros2doctor.verb', required=False)

    def main(
        self, *, parser: argparse.ArgumentParser, args: argparse.Namespace
    ) -> int | str | None:
        if verb := getattr(args, '_verb', None):
            return verb.main(args=args)  # type: ignore[no-any-return]
        if args.report:
            _print_reports(api.generate_reports(exclude_packages=args.exclude_packages))
            return 0
        categories, failed, total = api.run_checks(
            include_warnings=args.include_warnings, exclude_packages=args.exclude_packages
        )
        if failed:
            print(f'\n{failed}/{total} check(s) failed\n')
            print('Failed modules:', *sorted(categories))
        else:
            print(f'\nAll {total} checks passed\n')
        if args.report_failed and failed:
            _print_reports(
                api.generate_reports(categories=categories, exclude_packages=args.exclude_packages)
            )
        return 0


class WtfCommand(DoctorCommand):
    """Use `wtf` as alias to `doctor`."""


def _print_reports(reports: list[api.Report]) -> None:
    for report in reports:
        format_print(report)
