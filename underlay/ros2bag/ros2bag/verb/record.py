# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from pathlib import Path
import time

from ros2cli import arguments, discovery
from ros2cli.errors import UsageError
from ros2cli.node.direct import command_node, CommandNode
from ros2cli.verb import VerbExtension
from rosbag2_py import CompressionMode, get_registered_compressors
from rosbag2_py.bag_writer import BagWriter, Limits
from rosbag2_py.last_messages import LastMessages
from rosbag2_py.selection import EVENTS
from rosbag2_py.storages import DEFAULT_ID, STORAGES
from rosbag2_py.storages.interface import Storage
from rtps_graph.graph import Graph

from ros2bag import choice, node_options, qos_overrides, split_events, without_effect
from ros2bag.keyboard import controls, Keyboard
from ros2bag.recorder import Recorder
from ros2bag.refusals import refused_in_one_line
from ros2bag.services import control_recorder

_PRESETS = 'it is for plugins in C++; --storage-preset-profile says how a bag is stored'
_NODE_NAME = 'rosbag2_recorder'
_SNAPSHOT = '`ros2 service call /{}/snapshot rosbag2_interfaces/srv/Snapshot`'


class RecordVerb(VerbExtension):
    """Record ROS data to a bag."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        choice.add_arguments(parser)
        arguments.add_flags(
            parser,
            {
                '--no-discovery': 'Disables topic auto discovery during recording: only topics '
                'present at startup will be recorded.',
                '--include-unpublished-topics': 'Subscribe to topics without a publisher as well.',
                '--ignore-leaf-topics': 'Leave out topics that nobody else subscribes to.',
            },
        )
        parser.add_argument(
            '--use-sim-time',
            action='store_true',
            help='Use simulation time for message timestamps by subscribing to the /clock topic.',
        )
        parser.add_argument(
            '-p',
            '--polling-interval',
            type=arguments.positive_int,
            default=300,
            metavar='MS',
            help='Look for new topics every so many milliseconds (default: %(default)s).',
        )
        qos_overrides.add_argument(parser)
        node_options.add_node_name(parser, _NODE_NAME)
        node_options.add_log_level(parser)
        _add_bag(parser)
        _add_limits(parser)
        _add_compression(parser)
        _add_snapshots(parser)
        _add_refused(parser)
        without_effect.add_numbers(
            parser,
            '--compression-queue-size',
            '--compression-threads',
            '--compression-threads-priority',
        )
        arguments.add_flags(
            parser,
            {
                '--start-paused': 'Start the recorder in a paused state.',
                '--disable-keyboard-controls': 'Leave the keys of the terminal alone.',
            },
        )

    @refused_in_one_line()
    def main(self, *, args: argparse.Namespace) -> None:
        selection = choice.selection(args)
        overrides = qos_overrides.read(args.qos_profile_overrides_path)
        if args.use_sim_time and args.no_discovery:
            raise UsageError('--use-sim-time needs /clock to be discovered: not --no-discovery')
        storage = _storage(args)
        folder = args.output or Path(time.strftime('rosbag2_%Y_%m_%d-%H_%M_%S'))
        with (
            BagWriter(
                folder,
                storage,
                preset=args.storage_preset_profile,
                limits=Limits(args.max_bag_size, args.max_bag_duration),
                compress=CompressionMode[args.compression_mode.upper()],
                custom_data=dict(args.custom_data),
            ) as writer,
            # Interrupted while it is written or closed, a bag would not be whole.
            command_node(args, name=args.node_name, may_spin_when_interrupted=True) as node,
        ):
            node_options.set_log_level(node, args.log_level)
            for line in choice.overridden(args):
                node.node.get_logger().warning(line)
            recorder = Recorder(
                node,
                writer,
                selection,
                overrides,
                is_paused=args.start_paused,
                last=LastMessages(writer, args.max_cache_size) if args.snapshot_mode else None,
                include_unpublished=args.include_unpublished_topics,
                ignore_leaves=args.ignore_leaf_topics,
            )
            control_recorder(node, recorder)
            writer.on_split = tell = split_events.of_recorder(node)
            keys = {'SPACE': recorder.toggle_paused}
            with controls(keys, disabled=args.disable_keyboard_controls) as keyboard:
                try:
                    _record(node, args, recorder, writer, keyboard)
                except KeyboardInterrupt:
                    writer.close()
                    tell(writer.file, None)
                    node.node.get_logger().info(
                        f"Recording stopped: {writer.message_count} messages in '{folder}'"
                    )


def _record(
    node: CommandNode,
    args: argparse.Namespace,
    recorder: Recorder,
    writer: BagWriter,
    keyboard: Keyboard,
) -> None:
    """Record until a signal comes."""
    log = node.node.get_logger()

    def never() -> bool:
        keyboard.serve()
        return False

    if args.use_sim_time:
        _wait_for_simulated_time(node, keyboard)
    log.info('Listening for topics...')
    graph = discovery.read_graph()
    recorder.subscribe_to_new_topics(graph)
    by_key = '; SPACE pauses and resumes' if keyboard.is_there else ''
    log.info(f'Recording...{" (paused)" if args.start_paused else ""}{by_key}')
    if args.snapshot_mode:
        how = _SNAPSHOT.format(args.node_name)
        log.info(f'Nothing is written before a snapshot is asked for: {how}')
    if missing := recorder.missing():
        log.info(f'Waiting for {", ".join(missing)}{_hint(missing, graph)}')
    elif not recorder.has_subscribed:
        log.info('Waiting: nothing that is there is chosen; `ros2 topic list` shows what is')
    while True:
        node.spin_until(never, args.polling_interval * 1e-3)
        writer.flush()
        if not args.no_discovery and recorder.knows_new_topics():
            recorder.subscribe_to_new_topics(discovery.read_graph(quiet=True))


def _wait_for_simulated_time(node: CommandNode, keyboard: Keyboard) -> None:
    """Wait for /clock; what came before it would be from 1970, and the bag last as long."""
    clock = node.node.get_clock()

    def has_begun() -> bool:
        keyboard.serve()
        return bool(clock.now().nanoseconds)

    node.node.get_logger().info('Waiting for /clock: nothing is recorded before it')
    node.spin_until(has_begun)


def _add_bag(parser: argparse.ArgumentParser) -> None:
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
        '-f',
        '--serialization-format',
        default='',
        choices=('cdr',),
        help='How messages are serialized: as they come, which is cdr.',
    )
    parser.add_argument(
        '--custom-data',
        type=_key_and_value,
        nargs='*',
        default=[],
        metavar='KEY=VALUE',
        help='Kept as custom_data in metadata.yaml.',
    )


def _add_limits(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '-b',
        '--max-bag-size',
        type=arguments.nonnegative_int,
        default=0,
        metavar='BYTES',
        help='Begin a new file after so many bytes; 0 for never, the default.',
    )
    parser.add_argument(
        '-d',
        '--max-bag-duration',
        type=arguments.nonnegative_int,
        default=0,
        metavar='SECONDS',
        help='Begin a new file after so many seconds; 0 for never, the default.',
    )


def _add_compression(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '--compression-mode',
        choices=[mode.name.lower() for mode in CompressionMode],
        default='none',
        help='Compress each file when it is complete, or each message (default: %(default)s).',
    )
    parser.add_argument(
        '--compression-format',
        choices=sorted(get_registered_compressors()),
        help='By what; need not be said, for there is only one.',
    )


def _add_snapshots(parser: argparse.ArgumentParser) -> None:
    arguments.add_flags(
        parser,
        {
            '--snapshot-mode': 'Keep the last messages in memory, and write them only when '
            f'somebody asks: {_SNAPSHOT.format(_NODE_NAME)}.'
        },
    )
    parser.add_argument(
        '--max-cache-size',
        type=arguments.nonnegative_int,
        default=100 * 1024 * 1024,
        metavar='BYTES',
        help='How much --snapshot-mode keeps (default: %(default)s); without effect else.',
    )


def _add_refused(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--storage-config-file', metavar='FILE', help=f'Refused: {_PRESETS}.')


def _storage(args: argparse.Namespace) -> Storage:
    """
    Return the storage that the options choose.

    :raises UsageError: it cannot do what they ask for.
    """
    storage = STORAGES[args.storage]
    if args.storage_preset_profile not in storage.presets:
        raise UsageError(
            f"--storage-preset-profile '{args.storage_preset_profile}' is none of {storage.id}, "
            f'which has {", ".join(storage.presets)}'
        )
    if 0 < args.max_bag_size < storage.smallest_file_bytes:
        raise UsageError(
            f'--max-bag-size {args.max_bag_size}: it is {storage.smallest_file_bytes} bytes at '
            f'least for {storage.id}, or 0 for no limit'
        )
    if args.compression_format and args.compression_mode == 'none':
        raise UsageError('--compression-format needs a --compression-mode: file or message')
    if args.storage_config_file:
        raise UsageError(f'--storage-config-file is not offered here: {_PRESETS}')
    if args.snapshot_mode and not args.max_cache_size:
        raise UsageError(
            '--snapshot-mode needs a --max-cache-size: so many bytes of the last messages are kept'
        )
    return storage


def _key_and_value(text: str) -> tuple[str, str]:
    key, separator, value = text.partition('=')
    if not (key and separator):
        raise argparse.ArgumentTypeError(f"'{text}' is no KEY=VALUE")
    return key, value


def _hint(missing: list[str], graph: Graph) -> str:
    """Say why a topic may be missing: its service does not tell, or another name was meant."""
    if any(topic.endswith(EVENTS) for topic in missing):
        return '; a service tells of its calls only while its introspection is on'
    known = graph.topics()
    if heard := [topic for topic in missing if topic in known]:
        return f'; nobody publishes {", ".join(heard)} yet'
    return next(filter(None, (discovery.near(each, known) for each in missing)), '')


def _presets() -> str:
    return '; '.join(f'{each.id}: {", ".join(each.presets)}' for each in STORAGES.values())
