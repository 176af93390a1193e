# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.errors import UsageError
from ros2cli.verb import VerbExtension
from rosbag2_py import bag_rewrite, StorageOptions

from ros2bag.refusals import refused_in_one_line


class ConvertVerb(VerbExtension):
    """Given an input bag, write out a new bag with different settings."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        parser.add_argument(
            '-i',
            '--input',
            required=True,
            action='append',
            nargs='+',
            metavar=('uri', 'storage_id'),
            help='Bag to read, and its storage if that is to be checked; several are merged',
        )
        parser.add_argument(
            '-o',
            '--output-options',
            required=True,
            metavar='FILE',
            help='YAML with the list output_bags: for each bag to write its uri, and which topics',
        )

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        for words in args.input:
            if len(words) > 2:
                raise UsageError(
                    f'--input takes a bag and its storage, not {" ".join(words)}; several bags '
                    'have an --input each'
                )
        bag_rewrite([StorageOptions(*words) for words in args.input], args.output_options)
