# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Options of `ros2 launch` that other packages add, in the entry point group ros2launch.option."""

from __future__ import annotations

import argparse
from collections.abc import Collection
from typing import Any, TYPE_CHECKING

import entry_point_index
from ros2cli.plugin_system import PLUGIN_SYSTEM_VERSION, satisfies_version

if TYPE_CHECKING:
    from launch import LaunchDescription


class OptionExtension:
    """Base of the extensions, each of which may do something before and after a launch."""

    NAME: str | None = None
    EXTENSION_POINT_VERSION = '0.1'

    def __init__(self) -> None:
        satisfies_version(PLUGIN_SYSTEM_VERSION, '^0.1')

    def add_arguments(
        self, parser: argparse.ArgumentParser, cli_name: str, *, argv: Any = None
    ) -> None:
        """Add arguments to those of `ros2 launch`."""

    def prestart(self, args: argparse.Namespace | None) -> None:
        """Do what comes before there is a launch service."""

    def prelaunch(
        self, launch_description: LaunchDescription, args: argparse.Namespace | None
    ) -> tuple[LaunchDescription, ...]:
        """Return, first in a tuple, the launch description to be launched instead."""
        return (launch_description,)

    def postlaunch(self, launch_return_code: int, args: argparse.Namespace | None) -> None:
        """Do what comes after the launch."""


def get_option_extensions(
    exclude_names: Collection[str] | None = None,
) -> dict[str, OptionExtension]:
    """Return an object of each extension by its name."""
    extensions: dict[str, OptionExtension] = {}
    for name, target in entry_point_index.entry_points('ros2launch.option').items():
        if name not in (exclude_names or ()):
            extensions[name] = entry_point_index.load(target)()
            extensions[name].NAME = name
    return extensions
