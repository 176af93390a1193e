# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `ros2 bag play` and `ros2 bag burst` do."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from typing import Any

from ros2cli import discovery
from ros2cli.errors import CommandError, UsageError
from ros2cli.node.direct import command_node
import rosbag2_py
from rosbag2_py import bag_files, selection
from rosbag2_py.selection import EVENTS
from rosgraph_msgs.msg import Clock
from rtps_graph import names

from ros2bag import choice, node_options, player, qos_overrides, service_requests
from ros2bag.keyboard import controls
from ros2bag.playback import Playback
from ros2bag.services import control_player

_RATE_STEP = 0.1
_KEYS = (
    ', SPACE pauses and resumes, CURSOR_RIGHT plays the next message while paused, CURSOR_UP '
    'and CURSOR_DOWN change the rate by 0.1'
)


def play(args: argparse.Namespace, *, burst: int | None = None) -> None:
    """
    Play a bag until it ends or is stopped.

    :param args: those of `ros2 bag play`.
    :param burst: how many messages to play at once at the beginning, 0 for all.
    """
    bag = bag_files.describe(args.bag_path, args.storage)
    chosen = _chosen(bag, args)
    remaps = _remaps(args.remap)
    overrides = qos_overrides.read(args.qos_profile_overrides_path)
    with command_node(args, name='rosbag2_player') as node:
        node_options.set_log_level(node, args.log_level)
        for line in _renaming_nothing(remaps, chosen):
            node.node.get_logger().warning(line)
        requests = service_requests.players_of(node, args, chosen, remaps)
        topics = [topic for topic in chosen if topic.name not in requests]
        publishers = player.publishers_of(node, topics, remaps, overrides, are_all=not requests)
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
                f'{args.rate:g}{_left_out(args, bag)}; Ctrl-C ends it'
                f'{_KEYS if keyboard.is_there else ""}'
            )
            while True:
                playback.wait(args.delay, keyboard.serve)
                if not (playback.play(keyboard.serve, burst) and args.loop):
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


def _left_out(args: argparse.Namespace, bag: rosbag2_py.BagMetadata) -> str:
    """Return a clause where the start is behind all that the bag has."""
    if not bag.message_count or args.start_offset * 1e9 <= bag.duration.nanoseconds:
        return ''
    return f', of which --start-offset {args.start_offset:g} leaves nothing'


def _renaming_nothing(
    remaps: dict[str, str], chosen: list[rosbag2_py.TopicMetadata]
) -> Iterator[str]:
    played = {names.expand(topic.name) for topic in chosen}
    played |= {name.removesuffix(EVENTS) for name in played}
    for old, new in remaps.items():
        if old not in played:
            hint = discovery.near(old, played)
            yield f'--remap {old}:={new} renames nothing: no such topic is played{hint}'


def _remaps(rules: list[str]) -> dict[str, str]:
    found = {}
    for rule in rules:
        old, separator, new = rule.partition(':=')
        if not (old and separator and new):
            raise UsageError(f"'{rule}' is no remapping: old_topic:=new_topic")
        found[names.expand(old)] = names.expand(new)
    return found
