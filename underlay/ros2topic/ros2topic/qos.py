# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Quality of service at the command line: options, and what fits the other side."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import copy
import sys
from typing import Any

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
_NOT_BEFORE = (
    'but brings nothing that was published before; --qos-reliability reliable '
    '--qos-durability transient_local does'
)


def add_qos_arguments(
    parser: argparse.ArgumentParser, subscribe_or_publish: str, default_profile_str: str
) -> None:
    """Add upstream's QoS options.

    :param subscribe_or_publish: what the verb does, for the help.
    :param default_profile_str: the preset where none is asked for.
    """
    verb = subscribe_or_publish
    parser.add_argument(
        '--qos-profile',
        choices=QoSPresetProfiles.short_keys(),
        default=default_profile_str,
        help=f'Quality of service preset profile to {verb} with (default: %(default)s)',
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


def profile_configure_short_keys(
    profile: QoSProfile,
    reliability: str | None = None,
    durability: str | None = None,
    depth: int | None = None,
    history: str | None = None,
    liveliness: str | None = None,
    liveliness_lease_duration_s: float | None = None,
) -> None:
    """Change a profile where a setting is given."""
    for option, key in (
        ('history', history),
        ('reliability', reliability),
        ('durability', durability),
        ('liveliness', liveliness),
    ):
        if key:
            setattr(profile, option, _POLICIES[option][0].get_from_short_key(key))
    if liveliness_lease_duration_s is not None and liveliness_lease_duration_s >= 0:
        lease_ns = int(liveliness_lease_duration_s * 10**9)
        profile.liveliness_lease_duration = Duration(nanoseconds=lease_ns)
    if depth is not None and depth > 0:  # 0 is that of the preset, as upstream has it
        profile.depth = depth
    if profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and profile.depth == 0:
        profile.depth = 1


def qos_profile_from_short_keys(
    preset_profile: str,
    reliability: str | None = None,
    durability: str | None = None,
    depth: int | None = None,
    history: str | None = None,
    liveliness: str | None = None,
    liveliness_lease_duration_s: float | None = None,
) -> QoSProfile:
    """Build a profile from the name of a preset and what differs from it."""
    # A preset is shared by the process.
    built = copy.copy(QoSPresetProfiles.get_from_short_key(preset_profile))
    profile_configure_short_keys(
        built, reliability, durability, depth, history, liveliness, liveliness_lease_duration_s
    )
    return built


def profile(args: argparse.Namespace) -> QoSProfile:
    """Build the profile that the options ask for."""
    return qos_profile_from_short_keys(args.qos_profile, **_overrides(args))


def profile_for(args: argparse.Namespace, publishers: Sequence[Endpoint]) -> QoSProfile:
    """Build a subscription's profile that fits what is published, unless options ask otherwise.

    Where publishers differ a hint on stderr says what is chosen.
    """
    chosen = profile(args)
    if not publishers:
        return chosen
    reliable = [endpoint.qos.reliable for endpoint in publishers]
    latched = [endpoint.qos.transient_local for endpoint in publishers]
    manual = [endpoint.qos.manual_liveliness for endpoint in publishers]
    fitting = {
        'reliability': (
            ReliabilityPolicy.RELIABLE if all(reliable) else ReliabilityPolicy.BEST_EFFORT
        ),
        'durability': (
            DurabilityPolicy.TRANSIENT_LOCAL if all(latched) else DurabilityPolicy.VOLATILE
        ),
        'liveliness': (
            LivelinessPolicy.MANUAL_BY_TOPIC if all(manual) else LivelinessPolicy.AUTOMATIC
        ),
    }
    is_asked_for = any(value is not None for value in _overrides(args).values())
    for option, policy in fitting.items():
        # What the graph tells the node of the command has not heard yet: for BEST_AVAILABLE the
        # middleware would ask for the most that there is.
        is_best_available = getattr(chosen, option) == type(policy).BEST_AVAILABLE
        if is_best_available or (option != 'liveliness' and not is_asked_for):
            setattr(chosen, option, policy)
    if not is_asked_for:
        _hint_where_mixed(reliable, 'RELIABLE', 'BEST_EFFORT, which fits all')
        _hint_where_mixed(latched, 'TRANSIENT_LOCAL', f'VOLATILE, which fits all {_NOT_BEFORE}')
    return chosen


def _hint_where_mixed(offered: Sequence[bool], policy: str, chosen: str) -> None:
    if any(offered) and not all(offered):
        print(
            f'hint: not all publishers are {policy}, so that echo asks for {chosen}',
            file=sys.stderr,
        )


def _overrides(args: argparse.Namespace) -> dict[str, Any]:
    return {
        **{option: getattr(args, f'qos_{option}') for option in (*_POLICIES, 'depth')},
        'liveliness_lease_duration_s': args.qos_liveliness_lease_duration_seconds,
    }
