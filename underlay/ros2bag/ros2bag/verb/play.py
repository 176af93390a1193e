# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments
from ros2cli.verb import VerbExtension

from ros2bag import (
    choice,
    node_options,
    playing,
    qos_overrides,
    service_requests,
    without_effect,
)
from ros2bag.bag_argument import add_bag_argument
from ros2bag.refusals import refused_in_one_line

_DEFAULT_CLOCK_HZ = 40.0
_DEFAULT_ACKNOWLEDGED_MS = 1000


class PlayVerb(VerbExtension):
    """Play back ROS data from a bag."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        add_bag_argument(parser)
        parser.add_argument(
            '-r',
            '--rate',
            type=arguments.positive_float,
            default=1.0,
            help='rate at which to play back messages',
        )
        _add_choice(parser)
        arguments.add_flags(parser, {'-l --loop': 'enables loop playback when playing a bagfile'})
        parser.add_argument(
            '--remap', '-m', nargs='+', default=[], help='list of topics to be remapped: old:=new'
        )
        _add_clock(parser)
        parser.add_argument(
            '-d',
            '--delay',
            type=arguments.nonnegative_float,
            default=0.0,
            help='Sleep N seconds before play',
        )
        parser.add_argument(
            '--start-offset',
            type=arguments.nonnegative_float,
            default=0.0,
            help='Start the playback player this many seconds into the bag file.',
        )
        _add_end(parser)
        arguments.add_flags(
            parser,
            {
                '-p --start-paused': 'Start the playback player in a paused state.',
                '--disable-keyboard-controls': 'Leave the keys of the terminal alone.',
            },
        )
        parser.add_argument(
            '--wait-for-all-acked',
            type=arguments.nonnegative_int,
            default=_DEFAULT_ACKNOWLEDGED_MS,
            metavar='MILLISECONDS',
            help='At the end, wait so long at most until all that was published reliably has '
            'arrived; 0 for as long as it takes (default: %(default)s).',
        )
        service_requests.add_arguments(parser)
        without_effect.add_numbers(parser, '--read-ahead-queue-size')
        without_effect.add_flags(parser, '--disable-loan-message')
        without_effect.add_files(parser, '--storage-config-file')
        qos_overrides.add_argument(parser)
        node_options.add_log_level(parser)

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        playing.play(args)


def _add_clock(parser: argparse.ArgumentParser) -> None:
    group = parser.add_mutually_exclusive_group()
    group.add_argument(
        '--clock',
        type=arguments.positive_float,
        nargs='?',
        const=_DEFAULT_CLOCK_HZ,
        metavar='Hz',
        help='Publish to /clock at this rate, to act as a ROS Time Source (default: off)',
    )
    group.add_argument(
        '--clock-topics',
        nargs='+',
        default=[],
        metavar='topic',
        help='Publish to /clock before each message of these topics.',
    )
    arguments.add_flags(group, {'--clock-topics-all': 'Publish to /clock before each message.'})


def _add_choice(parser: argparse.ArgumentParser) -> None:
    lists = {
        '--topics': ('topic', 'Topics to play; of services, --services tells which.'),
        '--services': ('service', 'Services whose events are played.'),
        '--exclude-topics': ('topic', 'Topics not to play.'),
        '--exclude-services': ('service', 'Services whose events are not played.'),
    }
    for option, (metavar, text) in lists.items():
        parser.add_argument(option, nargs='+', default=[], metavar=metavar, help=text)
    choice.add_expression(
        parser,
        '-e',
        '--regex',
        help='Play what has a name that matches this as a whole.',
    )
    choice.add_expression(
        parser, '-x', '--exclude-regex', help='Leave out what has a name that matches as a whole.'
    )


def _add_end(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '--playback-duration',
        type=arguments.finite_float,
        default=-1.0,
        metavar='SECONDS',
        help='End so many seconds of the bag after the start; below 0 for its end, the default. '
        'With --playback-until-sec or -nsec, the later counts.',
    )
    group = parser.add_mutually_exclusive_group()
    group.add_argument(
        '--playback-until-sec',
        type=arguments.finite_float,
        default=-1.0,
        metavar='SECONDS',
        help='End with the last message up to this time, in seconds since 1970; below 0 for the '
        'end of the bag, the default.',
    )
    group.add_argument(
        '--playback-until-nsec',
        type=int,
        default=-1,
        metavar='NANOSECONDS',
        help='The same, in nanoseconds.',
    )
