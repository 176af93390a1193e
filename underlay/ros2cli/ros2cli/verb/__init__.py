# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a verb of a command is."""

from __future__ import annotations

import argparse

from ros2cli.plugin_system import PLUGIN_SYSTEM_VERSION, satisfies_version


class VerbExtension:
    """Base of a verb: `ros2 COMMAND VERB`; its docstring is its help.

    A package registers its verb of `ros2 topic` in the entry point group 'ros2topic.verb'.
    """

    NAME: str | None = None
    EXTENSION_POINT_VERSION = '0.1'

    def __init__(self) -> None:
        satisfies_version(PLUGIN_SYSTEM_VERSION, '^0.1')

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        pass

    def main(self, *, args: argparse.Namespace) -> int | str | None:
        raise NotImplementedError()
