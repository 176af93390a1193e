# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments
from ros2cli.command import CommandWithVerbs


class TopicCommand(CommandWithVerbs):
    """Various topic related sub-commands."""

    VERB_GROUP = 'ros2topic.verb'

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_flags(parser, {'--include-hidden-topics': 'Consider hidden topics as well'})
        super().add_arguments(parser, cli_name)
