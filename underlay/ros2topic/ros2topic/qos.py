# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Quality of service at the command line: options, and what fits the other side."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import copy

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

_POLICIES = {
    'history': (HistoryPolicy, 'History of samples'),
    'reliability': (ReliabilityPolicy, 'Quality of service reliability'),
    'durability': (DurabilityPolicy, 'Quality of service durability'),
    'liveliness': (LivelinessPolicy, 'Quality of service liveliness'),
}


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
    for option, (policy, text) in _POLICIES.items():
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
    chosen = copy.copy(preset)
    if args.qos_depth is not None:
        chosen.depth = args.qos_depth
    for option, (policy, _) in _POLICIES.items():
        if key := getattr(args, f'qos_{option}'):
            setattr(chosen, option, policy.get_from_short_key(key))
    if args.qos_durability == 'transient_local' and chosen.depth == 0:
        chosen.depth = 1
    if args.qos_liveliness_lease_duration_seconds is not None:
        lease_ns = int(args.qos_liveliness_lease_duration_seconds * 10**9)
        chosen.liveliness_lease_duration = Duration(nanoseconds=lease_ns)
    return chosen


def profile_for(args: argparse.Namespace, publishers: Sequence[Endpoint]) -> QoSProfile:
    """Build a subscription's profile that fits what is published, unless options ask otherwise."""
    chosen = profile(args)
    if args.qos_profile or args.qos_history or args.qos_reliability or args.qos_durability:
        return chosen
    if publishers and not all(endpoint.qos.reliable for endpoint in publishers):
        chosen.reliability = ReliabilityPolicy.BEST_EFFORT
    if publishers and all(endpoint.qos.transient_local for endpoint in publishers):
        chosen.durability = DurabilityPolicy.TRANSIENT_LOCAL
    return chosen
