# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments
from ros2cli.verb import VerbExtension

from ros2bag import playing, qos_overrides, without_effect
from ros2bag.bag_argument import add_bag_argument
from ros2bag.refusals import refused_in_one_line
from ros2bag.verb.play import PlayVerb


class BurstVerb(VerbExtension):
    """Burst data from a bag."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        add_bag_argument(parser)
        lists = {'--topics': 'Topics to play.', '--services': 'Services whose events are played.'}
        for option, text in lists.items():
            parser.add_argument(option, nargs='+', default=[], help=text)
        qos_overrides.add_argument(parser)
        parser.add_argument(
            '--remap', '-m', nargs='+', default=[], help='list of topics to be remapped: old:=new'
        )
        parser.add_argument(
            '--start-offset',
            type=arguments.nonnegative_float,
            default=0.0,
            help='Start the playback player this many seconds into the bag file.',
        )
        parser.add_argument(
            '-n',
            '--num-messages',
            type=arguments.nonnegative_int,
            default=0,
            help='Burst the specified number of messages, then pause; 0 for all, the default.',
        )
        without_effect.add_numbers(parser, '--read-ahead-queue-size')
        without_effect.add_files(parser, '--storage-config-file')

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        # What else `play` has is as where it is not given there.
        parser = argparse.ArgumentParser()
        PlayVerb().add_arguments(parser, '')
        others = parser.parse_args(['--start-paused', '--', str(args.bag_path)])
        playing.play(argparse.Namespace(**{**vars(others), **vars(args)}), burst=args.num_messages)
