# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys
from typing import Any

from ros2cli import arguments
from ros2cli.verb import VerbExtension
from rosbag2_py import bag_files, info_text, service_calls, StorageOptions

from ros2bag.bag_argument import add_bag_argument
from ros2bag.refusals import refused_in_one_line

_KEYS: dict[str, Any] = {
    'name': lambda each: each.topic_metadata.name,
    'type': lambda each: each.topic_metadata.type,
    'count': lambda each: each.message_count,
}


class InfoVerb(VerbExtension):
    """Print information about a bag to the screen."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        add_bag_argument(parser)
        arguments.add_flags(
            parser,
            {
                '-t --topic-name': 'Only display topic names.',
                '-v --verbose': 'Count the requests and responses of services.',
            },
        )
        parser.add_argument(
            '--sort',
            choices=list(_KEYS),
            default='name',
            help='Sort topics by this key (default: %(default)s)',
        )

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        bag = bag_files.describe(args.bag_path, args.storage)
        topics = sorted(bag.topics_with_message_count, key=_KEYS[args.sort])
        if args.topic_name and args.verbose:
            print('hint: with --verbose, --topic-name is ignored', file=sys.stderr)
        elif args.topic_name:
            for topic in topics:
                if not info_text.is_service(topic):
                    print(topic.topic_metadata.name)
            return
        bag.topics_with_message_count = topics
        calls = None
        if args.verbose:
            options = StorageOptions(str(args.bag_path), args.storage)
            calls = service_calls.count(options, info_text.services_of(bag))
        print(info_text.describe(bag, calls))
