# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files through the launch package: its service and the declared arguments."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import launch
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.launch_introspector import format_substitutions
from ros2cli.errors import CommandError


def launch_file(
    path: Path,
    arguments: Sequence[tuple[str, str]],
    words: Sequence[str],
    *,
    noninteractive: bool,
    debug: bool,
) -> int:
    """Run a launch file to its end; return the exit status."""
    service = launch.LaunchService(argv=list(words), noninteractive=noninteractive, debug=debug)
    source = AnyLaunchDescriptionSource(str(path))
    include = IncludeLaunchDescription(source, launch_arguments=arguments)
    service.include_launch_description(launch.LaunchDescription([include]))
    return int(service.run())


def print_description(path: Path) -> int:
    print(launch.LaunchIntrospector().format_launch_description(_load(path)))
    return 0


def print_arguments(path: Path) -> int:
    """Print the arguments that a launch file and what it includes declare."""
    print("Arguments (pass arguments as '<name>:=<value>'):")
    declared = _load(path).get_launch_arguments()
    for argument in declared:
        print(f"\n    '{argument.name}':")
        lines = argument.description.splitlines() or ['no description given']
        for line in lines:
            print(f'        {line}')
        if argument.default_value is not None:
            print(f'        (default: {format_substitutions(argument.default_value)})')
    if not declared:
        print('\n  No arguments.')
    return 0


def _load(path: Path) -> launch.LaunchDescription:
    try:
        return AnyLaunchDescriptionSource(str(path)).get_launch_description(launch.LaunchContext())
    except Exception as error:
        raise CommandError(f"'{path}' cannot be loaded: {error}") from None
