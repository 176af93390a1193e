# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from ros2cli import arguments
from ros2cli.errors import CommandError, UsageError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension
import rosbag2_py
from rosbag2_py import bag_files, selection
from rosbag2_py.selection import EVENTS
from rosgraph_msgs.msg import Clock
from rtps_graph import names

from ros2bag import choice, node_options, player, qos_overrides, service_requests, without_effect
from ros2bag.bag_argument import add_bag_argument
from ros2bag.keyboard import controls
from ros2bag.playback import Playback
from ros2bag.refusals import refused_in_one_line
from ros2bag.services import control_player

_DEFAULT_CLOCK_HZ = 40.0
_DEFAULT_ACKNOWLEDGED_MS = 1000
_RATE_STEP = 0.1
_KEYS = (
    ', SPACE pauses and resumes, CURSOR_RIGHT plays the next message while paused, CURSOR_UP '
    'and CURSOR_DOWN change the rate by 0.1'
)


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
        qos_overrides.add_argument(parser)
        node_options.add_log_level(parser)

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        bag = bag_files.describe(args.bag_path, args.storage)
        chosen = _chosen(bag, args)
        remaps = _remaps(args.remap)
        overrides = qos_overrides.read(args.qos_profile_overrides_path)
        with command_node(args, name='rosbag2_player') as node:
            node_options.set_log_level(node, args.log_level)
            requests = service_requests.players_of(node, args, chosen, remaps)
            topics = [topic for topic in chosen if topic.name not in requests]
            publishers = player.publishers_of(node, topics, remaps, overrides)
            players = {**publishers, **requests}
            asks_for_clock = args.clock or args.clock_topics or args.clock_topics_all
            clock = node.node.create_publisher(Clock, '/clock', 10) if asks_for_clock else None
            heard = [*publishers.values(), *([clock] if clock else [])]
            playback = Playback(node, args, bag, players, clock)
            control_player(node, playback)
            with controls(_keys(playback), disabled=args.disable_keyboard_controls) as keyboard:
                player.wait_for_subscriptions(node, heard)
                node.node.get_logger().info(
                    f'Playing {len(players)} of {len(bag.topics_with_message_count)} topics in '
                    f"'{args.bag_path}', {bag.duration.nanoseconds * 1e-9:.1f} s long, at rate "
                    f'{args.rate:g}; Ctrl-C ends it{_KEYS if keyboard.is_there else ""}'
                )
                while True:
                    playback.wait(args.delay, keyboard.serve)
                    if not (playback.play(keyboard.serve) and args.loop):
                        break  # also where there is nothing to play again and again
            service_requests.wait_for_answers(node, requests)
            timeout_sec = args.wait_for_all_acked / 1000.0 or None
            player.wait_for_acknowledgements(node, heard, timeout_sec)


def _keys(playback: Playback) -> dict[str, Callable[[], Any]]:
    return {
        'SPACE': playback.toggle_paused,
        'CURSOR_RIGHT': playback.play_next,
        'CURSOR_UP': lambda: playback.change_rate(_RATE_STEP),
        'CURSOR_DOWN': lambda: playback.change_rate(-_RATE_STEP),
    }


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


def _chosen(
    bag: rosbag2_py.BagMetadata, args: argparse.Namespace
) -> list[rosbag2_py.TopicMetadata]:
    topics = [each.topic_metadata for each in bag.topics_with_message_count]
    # A program may have written them without the slash, as the tutorial's does.
    known = {names.expand(topic.name): topic for topic in topics}
    wanted = [names.expand(name) for name in args.topics]
    events = [*choice.event_topics(args.services), *(n for n in wanted if n.endswith(EVENTS))]
    for name in (*wanted, *events, *map(names.expand, args.clock_topics)):
        if name not in known:
            raise CommandError(f"The bag has no topic '{name}'; it has {', '.join(known)}")
    passes = selection.wanted(
        rosbag2_py.StorageFilter(
            topics=wanted,
            services_events=events,
            regex=args.regex,
            exclude_topics=[
                *map(names.expand, args.exclude_topics),
                *(['/clock'] if args.clock else []),
            ],
            exclude_service_events=choice.event_topics(args.exclude_services),
            regex_to_exclude=args.exclude_regex,
        )
    )
    chosen = [topic for name, topic in known.items() if passes(name)]
    if known and not chosen:
        raise CommandError(f'No topic of the bag is chosen; it has {", ".join(known)}')
    return chosen


def _remaps(rules: list[str]) -> dict[str, str]:
    found = {}
    for rule in rules:
        old, separator, new = rule.partition(':=')
        if not (old and separator and new):
            raise UsageError(f"'{rule}' is no remapping: old_topic:=new_topic")
        found[names.expand(old)] = names.expand(new)
    return found
