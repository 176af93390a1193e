# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Quality of service at the command line: options, and what fits the other side."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from rclpy.duration import Duration
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from ros2cli.arguments import nonnegative_float, nonnegative_int
from rtps_graph.graph import Endpoint

_CHOSEN = ('qos_profile', 'qos_depth', 'qos_history', 'qos_reliability', 'qos_durability',
           'qos_liveliness', 'qos_liveliness_lease_duration_seconds')  # fmt: skip


def add_arguments(
    parser: argparse.ArgumentParser, *, verb: str, default_preset: str = 'default'
) -> None:
    """Add upstream's QoS options."""
    parser.add_argument(
        '--qos-profile',
        choices=QoSPresetProfiles.short_keys(),
        help=f'Quality of service preset profile to {verb} with (default: {default_preset})',
    )
    parser.add_argument(
        '--qos-depth',
        metavar='N',
        type=nonnegative_int,
        help=f'Queue size setting to {verb} with (overrides depth value of --qos-profile option)',
    )
    for option, policy, text in (
        ('history', HistoryPolicy, 'History of samples'),
        ('reliability', ReliabilityPolicy, 'Quality of service reliability'),
        ('durability', DurabilityPolicy, 'Quality of service durability'),
        ('liveliness', LivelinessPolicy, 'Quality of service liveliness'),
    ):
        parser.add_argument(
            f'--qos-{option}',
            choices=policy.short_keys(),
            help=f'{text} setting to {verb} with (overrides {option} value of --qos-profile '
            'option)',
        )
    parser.add_argument(
        '--qos-liveliness-lease-duration-seconds',
        type=nonnegative_float,
        help=f'Quality of service liveliness lease duration setting to {verb} with (overrides '
        'liveliness lease duration value of --qos-profile option)',
    )


def profile(args: argparse.Namespace, *, default_preset: str = 'default') -> QoSProfile:
    """Build the profile that the options ask for."""
    preset = QoSPresetProfiles.get_from_short_key(args.qos_profile or default_preset)
    # A preset is shared by the process; the options change a copy.
    chosen = QoSProfile(**{name[1:]: getattr(preset, name) for name in QoSProfile.__slots__})
    if args.qos_depth is not None:
        chosen.depth = args.qos_depth
    if args.qos_history:
        chosen.history = HistoryPolicy.get_from_short_key(args.qos_history)
    if args.qos_reliability:
        chosen.reliability = ReliabilityPolicy.get_from_short_key(args.qos_reliability)
    if args.qos_durability:
        chosen.durability = DurabilityPolicy.get_from_short_key(args.qos_durability)
        if chosen.durability == DurabilityPolicy.TRANSIENT_LOCAL and chosen.depth == 0:
            chosen.depth = 1
    if args.qos_liveliness:
        chosen.liveliness = LivelinessPolicy.get_from_short_key(args.qos_liveliness)
    if args.qos_liveliness_lease_duration_seconds is not None:
        lease_ns = int(args.qos_liveliness_lease_duration_seconds * 10**9)
        chosen.liveliness_lease_duration = Duration(nanoseconds=lease_ns)
    return chosen


def profile_for(args: argparse.Namespace, publishers: Sequence[Endpoint]) -> QoSProfile:
    """Build a subscription's profile that fits what is published, unless options ask otherwise."""
    chosen = profile(args)
    if any(getattr(args, name) is not None for name in _CHOSEN[2:5]) or args.qos_profile:
        return chosen
    if publishers and not all(endpoint.qos.reliable for endpoint in publishers):
        chosen.reliability = ReliabilityPolicy.BEST_EFFORT
    if publishers and all(endpoint.qos.transient_local for endpoint in publishers):
        chosen.durability = DurabilityPolicy.TRANSIENT_LOCAL
    return chosen
