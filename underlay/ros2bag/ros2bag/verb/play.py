# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from rclpy.qos import ReliabilityPolicy
from ros2cli import arguments
from ros2cli.errors import CommandError, UsageError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension
import rosbag2_py
from rosbag2_py import bag_files
from rosgraph_msgs.msg import Clock
from rtps_graph import names

from ros2bag import player, qos_overrides, without_effect
from ros2bag.bag_argument import add_bag_argument
from ros2bag.refusals import refused_in_one_line

_DEFAULT_CLOCK_HZ = 40.0


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
        parser.add_argument(
            '--topics',
            nargs='+',
            default=[],
            metavar='topic',
            help='topics to replay (default: all)',
        )
        arguments.add_flags(parser, {'-l --loop': 'enables loop playback when playing a bagfile'})
        parser.add_argument(
            '--remap', '-m', nargs='+', default=[], help='list of topics to be remapped: old:=new'
        )
        parser.add_argument(
            '--clock',
            type=arguments.positive_float,
            nargs='?',
            const=_DEFAULT_CLOCK_HZ,
            metavar='Hz',
            help='Publish to /clock at this rate, to act as a ROS Time Source (default: off)',
        )
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
        without_effect.add_flags(parser, '--disable-keyboard-controls')
        qos_overrides.add_argument(parser)

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        bag = bag_files.describe(args.bag_path, args.storage)
        chosen = _chosen(bag, args.topics)
        remaps = _remaps(args.remap)
        overrides = qos_overrides.read(args.qos_profile_overrides_path)
        with command_node(args, name='rosbag2_player') as node:
            publishers = player.publishers_of(node, chosen, remaps, overrides)
            clock = node.node.create_publisher(Clock, '/clock', 10) if args.clock else None
            player.wait_for_subscriptions(node, list(publishers.values()))
            node.spin_until(lambda: False, args.delay)
            while True:
                player.play(node, args, bag, publishers, clock)
                if not args.loop:
                    break
            for publisher in publishers.values():
                if publisher.qos_profile.reliability == ReliabilityPolicy.RELIABLE:
                    publisher.wait_for_all_acked()


def _chosen(bag: rosbag2_py.BagMetadata, wanted: list[str]) -> list[rosbag2_py.TopicMetadata]:
    topics = [each.topic_metadata for each in bag.topics_with_message_count]
    # A program may have written them without the slash, as the tutorial's does.
    known = {names.expand(topic.name): topic for topic in topics}
    for name in map(names.expand, wanted):
        if name not in known:
            raise CommandError(f"The bag has no topic '{name}'; it has {', '.join(known)}")
    return [known[names.expand(name)] for name in wanted] if wanted else list(known.values())


def _remaps(rules: list[str]) -> dict[str, str]:
    found = {}
    for rule in rules:
        old, separator, new = rule.partition(':=')
        if not (old and separator and new):
            raise UsageError(f"'{rule}' is no remapping: old_topic:=new_topic")
        found[names.expand(old)] = names.expand(new)
    return found
