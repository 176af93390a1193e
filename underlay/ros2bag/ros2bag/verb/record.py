# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from pathlib import Path
import re
import signal
import time
from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from ros2cli import arguments, discovery, interfaces
from ros2cli.errors import CommandError, UsageError
from ros2cli.node.direct import command_node, CommandNode
from ros2cli.verb import VerbExtension
from rosbag2_py import TopicMetadata
from rosbag2_py.bag_writer import BagWriter, offered_qos
from rosbag2_py.storages import DEFAULT_ID, STORAGES
from rtps_graph import names
from rtps_graph.graph import Endpoint, Graph, Role

from ros2bag.refusals import refused_in_one_line

_POLL_SEC = 0.3
_QUEUE_DEPTH = 1000


class RecordVerb(VerbExtension):
    """Record ROS data to a bag."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_topic(
            parser, 'topics_positional', nargs='*', metavar='topics', help='Topics to be recorded'
        )
        parser.add_argument(
            '--topics', nargs='+', default=[], metavar='Topic', help='List of topics to record.'
        )
        parser.add_argument(
            '-a', '--all', action='store_true', help='Record all topics, hidden ones excluded.'
        )
        parser.add_argument('--all-topics', action='store_true', help='Record all topics.')
        parser.add_argument(
            '-e', '--regex', help='Record only topics matching the provided regular expression.'
        )
        parser.add_argument(
            '--exclude-regex', help='Exclude topics matching the provided regular expression.'
        )
        parser.add_argument(
            '--exclude-topics',
            nargs='+',
            default=[],
            metavar='Topic',
            help='Topics not to record.',
        )
        arguments.add_flags(
            parser,
            {
                '--include-hidden-topics': 'Discover and record hidden topics.',
                '--no-discovery': 'Disables topic auto discovery during recording: only topics '
                'present at startup will be recorded.',
            },
        )
        parser.add_argument(
            '-o',
            '--output',
            type=Path,
            help='Destination of the bag to create (default: a timestamp)',
        )
        parser.add_argument(
            '-s',
            '--storage',
            default=DEFAULT_ID,
            choices=sorted(STORAGES),
            help="Storage identifier to be used, defaults to '%(default)s'.",
        )
        parser.add_argument(
            '--storage-preset-profile',
            default='none',
            choices=sorted({name for each in STORAGES.values() for name in each.presets}),
            help=f'Select a preset of the storage ({_presets()}).',
        )
        parser.add_argument(
            '--use-sim-time',
            action='store_true',
            help='Use simulation time for message timestamps by subscribing to the /clock topic.',
        )

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        if not (
            args.topics_positional or args.topics or args.all or args.all_topics or args.regex
        ):
            raise UsageError(
                'Need to specify one option out of --all, --all-topics, --topics, --regex'
            )
        storage = STORAGES[args.storage]
        if args.storage_preset_profile not in storage.presets:
            raise UsageError(
                f"--storage-preset-profile '{args.storage_preset_profile}' is none of "
                f'{storage.id}, which has {", ".join(storage.presets)}'
            )
        folder = args.output or Path(time.strftime('rosbag2_%Y_%m_%d-%H_%M_%S'))
        with (
            BagWriter(folder, storage, preset=args.storage_preset_profile) as writer,
            # Interrupted while it is written or closed, a bag would not be whole.
            command_node(args, name='rosbag2_recorder', may_spin_when_interrupted=True) as node,
        ):
            _end_with_the_terminal()
            recorder = Recorder(node, writer, args)
            log = node.node.get_logger()
            log.info('Listening for topics...')
            recorder.subscribe_to_new_topics(discovery.read_graph())
            log.info('Recording...')
            if recorder.missing():
                log.info(f'Waiting for {", ".join(recorder.missing())}')
            try:
                while True:
                    node.spin_until(lambda: False, _POLL_SEC)
                    writer.flush()
                    if not args.no_discovery:
                        recorder.subscribe_to_new_topics(discovery.read_graph(quiet=True))
            except KeyboardInterrupt:
                writer.close()
                log.info(f"Recording stopped: {writer.message_count} messages in '{folder}'")


def _presets() -> str:
    return '; '.join(f'{each.id}: {", ".join(each.presets)}' for each in STORAGES.values())


def _end_with_the_terminal() -> None:
    """Let a terminal that is closed end the recording as SIGTERM does, but not under nohup."""
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGTERM))


class Recorder:
    """Subscribes to what is asked for, as it appears, and writes it down."""

    def __init__(self, node: CommandNode, writer: BagWriter, args: argparse.Namespace) -> None:
        self._node = node
        self._writer = writer
        self._chosen = {names.expand(t) for t in (*args.topics_positional, *args.topics)}
        self._all = args.all or args.all_topics
        self._regex = _pattern(args.regex)
        self._exclude_regex = _pattern(args.exclude_regex)
        self._excluded = {names.expand(t) for t in args.exclude_topics}
        self._hidden = args.include_hidden_topics
        self._seen: set[str] = set()

    def wants(self, topic: str) -> bool:
        if topic in self._excluded or (self._exclude_regex and self._exclude_regex.search(topic)):
            return False
        if topic in self._chosen:
            return True
        if names.is_hidden(topic) and not self._hidden:
            return False
        return self._all or bool(self._regex and self._regex.search(topic))

    def missing(self) -> list[str]:
        return sorted(self._chosen - self._seen)

    def subscribe_to_new_topics(self, graph: Graph) -> None:
        for name, types in graph.topics().items():
            if name in self._seen or not self.wants(name):
                continue
            publishers = graph.with_role(Role.PUBLISHER, name)
            if not publishers:
                continue
            self._seen.add(name)
            if len(types) > 1:
                self._log(f"Topic '{name}' has several types and is left out: {types}")
                continue
            self._subscribe(name, types[0], publishers)

    def _subscribe(self, name: str, type_name: str, publishers: list[Endpoint]) -> None:
        try:
            message_class = interfaces.message(type_name)
        except CommandError as error:
            self._log(f"Topic '{name}' is left out: {error}")
            return
        reliable = all(p.qos.reliable for p in publishers)
        transient_local = all(p.qos.transient_local for p in publishers)
        offered = offered_qos(reliable=reliable, transient_local=transient_local)
        type_hash = publishers[0].type_hash
        self._writer.add_topic(TopicMetadata(0, name, type_name, 'cdr', [offered], type_hash))
        qos = QoSProfile(depth=_QUEUE_DEPTH)
        if not reliable:
            qos.reliability = ReliabilityPolicy.BEST_EFFORT
        if transient_local:
            qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
        clock = self._node.node.get_clock()

        def on_message(data: bytes, info: dict[str, Any]) -> None:
            self._writer.write(name, data, clock.now().nanoseconds, info['source_timestamp'])

        self._node.node.create_subscription(message_class, name, on_message, qos, raw=True)
        self._log(f"Subscribed to topic '{name}'")

    def _log(self, text: str) -> None:
        self._node.node.get_logger().info(text)


def _pattern(text: str | None) -> re.Pattern[str] | None:
    if text is None:
        return None
    try:
        return re.compile(text)
    except re.error as error:
        raise UsageError(f"'{text}' is no regular expression: {error}") from None
