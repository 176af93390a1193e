# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from datetime import datetime
import math
from pathlib import Path

from ros2cli import arguments
from ros2cli.verb import VerbExtension

from ros2bag import metadata, reader


class InfoVerb(VerbExtension):
    """Print information about a bag to the screen."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        parser.add_argument('bag_path', type=Path, help='Bag to open')
        arguments.add_flags(parser, {'-t --topic-name': 'Only display topic names.'})
        parser.add_argument(
            '-s',
            '--storage',
            choices=['mcap'],
            default='mcap',
            help='Storage implementation of bag.',
        )
        parser.add_argument(
            '--sort',
            choices=['name', 'type', 'count'],
            default='name',
            help='Sort topics by this key (default: %(default)s)',
        )

    def main(self, *, args: argparse.Namespace) -> None:
        bag = reader.read_record(args.bag_path)
        topics = sorted(bag.topics, key=lambda topic: getattr(topic, args.sort))
        if args.topic_name:
            for topic in topics:
                print(topic.name)
            return
        size = sum(file.stat().st_size for file in metadata.bag_files(args.bag_path))
        described = [
            f'Topic: {t.name} | Type: {t.type} | Count: {t.count} | Serialization Format: cdr'
            for t in topics
        ]
        print(
            f'\nFiles:             {bag.file}\n'
            f'Bag size:          {_size(size)}\n'
            'Storage id:        mcap\n'
            f'ROS Distro:        {metadata.ROS_DISTRO}\n'
            f'Duration:          {bag.duration_ns / 1e9:.9f}s\n'
            f'Start:             {_time(bag.start_ns)}\n'
            f'End:               {_time(bag.end_ns)}\n'
            f'Messages:          {bag.count}\n'
            f'Topic information: {(chr(10) + " " * 19).join(described)}\n'
        )


def _size(number: int) -> str:
    if number < 1024:
        return f'{number} B'
    exponent = min(int(math.log2(number)) // 10, 3)
    return f'{number / 1024**exponent:.1f} {("KiB", "MiB", "GiB")[exponent - 1]}'


def _time(nanoseconds: int) -> str:
    moment = datetime.fromtimestamp(nanoseconds // 10**9)
    fraction = nanoseconds % 10**9
    return f'{moment:%b %e %Y %H:%M:%S}.{fraction:09} ({nanoseconds // 10**9}.{fraction:09})'
