# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections.abc import Iterator
import time
from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from ros2cli import arguments, discovery, interfaces
from ros2cli.errors import CommandError, UsageError
from ros2cli.node.direct import command_node, CommandNode
from ros2cli.verb import VerbExtension
import rosbag2_py
from rosbag2_py import bag_files
from rosgraph_msgs.msg import Clock
from rtps_graph import names
from rtps_graph.graph import Role

from ros2bag.bag_argument import add_bag_argument
from ros2bag.refusals import refused_in_one_line

_MATCH_TIMEOUT_SEC = 2.0
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
        arguments.add_flags(parser, {'--disable-keyboard-controls': 'Accepted: there are none.'})

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        bag = bag_files.describe(args.bag_path, args.storage)
        chosen = _chosen(bag, args.topics)
        remaps = _remaps(args.remap)
        with command_node(args, name='rosbag2_player') as node:
            publishers = _publishers(node, chosen, remaps)
            clock = node.node.create_publisher(Clock, '/clock', 10) if args.clock else None
            _wait_for_subscriptions(node, list(publishers.values()))
            node.spin_until(lambda: False, args.delay)
            while True:
                _play(node, args, bag, publishers, clock)
                if not args.loop:
                    break
            for publisher in publishers.values():
                if publisher.qos_profile.reliability == ReliabilityPolicy.RELIABLE:
                    publisher.wait_for_all_acked()


def _play(
    node: CommandNode,
    args: argparse.Namespace,
    bag: rosbag2_py.BagMetadata,
    publishers: dict[str, Any],
    clock: Any,
) -> None:
    first_ns = bag.starting_time.nanoseconds + int(args.start_offset * 1e9)
    start = time.monotonic()
    tick_sec = 1.0 / args.clock if args.clock else None
    next_tick = 0.0
    for topic, data, time_ns in _messages(args, list(publishers)):
        if time_ns < first_ns:
            continue
        due = (time_ns - first_ns) * 1e-9 / args.rate
        while (left := due - (time.monotonic() - start)) > 0:
            if tick_sec is not None and time.monotonic() - start >= next_tick:
                _publish_clock(clock, first_ns + int((time.monotonic() - start) * 1e9 * args.rate))
                next_tick += tick_sec
            # Sleeping is exact; the executor serves what little there is besides.
            time.sleep(min(left, 0.01))
            if left > 0.01:
                node.spin_once(0.0)
        publishers[topic].publish(data)


def _messages(args: argparse.Namespace, topics: list[str]) -> Iterator[tuple[str, bytes, int]]:
    reader = rosbag2_py.SequentialReader()
    options = rosbag2_py.StorageOptions(str(args.bag_path), args.storage)
    reader.open(options, rosbag2_py.ConverterOptions())
    reader.set_filter(rosbag2_py.StorageFilter(topics=topics, services_events=topics))
    while reader.has_next():
        yield reader.read_next()


def _publish_clock(publisher: Any, now_ns: int) -> None:
    msg = Clock()
    msg.clock.sec, msg.clock.nanosec = divmod(now_ns, 10**9)
    publisher.publish(msg)


def _publishers(
    node: CommandNode, topics: list[rosbag2_py.TopicMetadata], remaps: dict[str, str]
) -> dict[str, Any]:
    """
    Return a publisher for each topic whose type is installed; say which are left out.

    :raises CommandError: there are topics, but no type of theirs is installed.
    """
    publishers, reasons = {}, []
    for topic in topics:
        name = remaps.get(names.expand(topic.name), topic.name)
        try:
            publishers[topic.name] = _publisher(node, topic, name)
        except CommandError as error:
            reasons.append(f"Topic '{topic.name}' is left out: {error}")
    if reasons and not publishers:
        raise CommandError('; '.join(reasons))
    for reason in reasons:
        node.node.get_logger().warning(reason)
    return publishers


def _publisher(node: CommandNode, topic: rosbag2_py.TopicMetadata, name: str) -> Any:
    qos = QoSProfile(depth=1000)
    offers = [
        rosbag2_py.convert_rclcpp_qos_to_rclpy_qos(each) for each in topic.offered_qos_profiles
    ]
    if any(each.reliability != ReliabilityPolicy.RELIABLE for each in offers):
        qos.reliability = ReliabilityPolicy.BEST_EFFORT
    if offers and all(each.durability == DurabilityPolicy.TRANSIENT_LOCAL for each in offers):
        qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
    return node.node.create_publisher(interfaces.message(topic.type), name, qos)


def _wait_for_subscriptions(node: CommandNode, publishers: list[Any]) -> None:
    """Wait until the subscriptions that exist are matched, so that they get the first message."""
    graph = discovery.read_graph()
    wanted = {p.topic_name: len(graph.with_role(Role.SUBSCRIPTION, p.topic_name))
              for p in publishers}  # fmt: skip
    node.spin_until(
        lambda: all(p.get_subscription_count() >= wanted[p.topic_name] for p in publishers),
        _MATCH_TIMEOUT_SEC,
    )


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
