# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.verb import VerbExtension
from rosbag2_py import Reindexer, StorageOptions

from ros2bag.bag_argument import add_bag_argument
from ros2bag.refusals import refused_in_one_line


class ReindexVerb(VerbExtension):
    """Reconstruct metadata file for a bag."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        add_bag_argument(parser)

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        Reindexer().reindex(StorageOptions(str(args.bag_path), args.storage))
