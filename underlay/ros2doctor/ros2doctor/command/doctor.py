# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import os
import platform
import sys

from ros2_diagnosis import packages
from ros2cli import arguments, discovery
from ros2cli.command import CommandExtension

from ros2doctor import api


class DoctorCommand(CommandExtension):
    """Check ROS setup and other potential issues.

    Each fault is told in one line: where, what and why, and the command that mends it. The exit
    status is 0 where nothing is wrong, else 1.
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
                '--include-warnings -iw': 'Include warnings as failed checks. Warnings are '
                'ignored by default.'
            },
        )
        discovery.add_arguments(parser)

    def main(self, *, parser: argparse.ArgumentParser, args: argparse.Namespace) -> int:
        if args.report:
            _print_report(args)
            return 0
        failed = []
        checks = api.checks(args)
        for check in checks:
            result = check.check()
            if result.error or (args.include_warnings and result.warning):
                failed.append(check)
        if not failed:
            print(f'\nAll {len(checks)} checks passed\n')
            return 0
        print(f'\n{len(failed)}/{len(checks)} check(s) failed\n', file=sys.stderr)
        print('Failed modules:', *(check.category() for check in failed), file=sys.stderr)
        return 1


class WtfCommand(DoctorCommand):
    """Use `wtf` as alias to `doctor`."""


def _print_report(args: argparse.Namespace) -> None:
    settings = discovery.settings_from_environment()
    graph = discovery.read_graph(args)
    own = [f'{name}: {prefix}' for name, prefix in packages.installed().items()
           if packages.source_of(name)]  # fmt: skip
    sections = {
        'PLATFORM INFORMATION': [
            f'system: {platform.platform()}',
            f'python: {platform.python_version()} ({sys.executable})',
        ],
        'RMW MIDDLEWARE': [
            f'middleware name: {os.environ.get("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp")}'
        ],
        'ROS 2 INFORMATION': [
            f'distribution name: {os.environ.get("ROS_DISTRO", "jazzy")}',
            f'domain id: {settings.domain_id}',
            f'discovery range: {settings.discovery_range}',
            f'prefixes: {os.pathsep.join(map(str, packages.prefixes()))}',
            f'packages: {len(packages.installed())}',
        ],
        'WORKSPACE PACKAGES': own,
        'NODE LIST': [node.full_name for node in graph.nodes],
        'TOPIC LIST': [f'{name}: {", ".join(types)}' for name, types in graph.topics().items()],
        'SERVICE LIST': [
            f'{name}: {", ".join(types)}' for name, types in graph.services().items()
        ],
    }
    for title, lines in sections.items():
        print(f'\n   {title}', *(lines or ['none']), sep='\n')
