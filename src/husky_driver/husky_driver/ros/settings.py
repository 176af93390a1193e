# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of `follow_path`: the only place where their defaults live."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from difflib import get_close_matches
from typing import Any

ODOMETRY_TOPICS = {
    'filtered': 'odometry/filtered',
    'wheel': 'husky_velocity_controller/odom',
    'ground_truth': 'ground_truth/odom',
}
PROGRESS = ('auto', 'bar', 'lines', 'off')
NODE_PARAMETERS = ('use_sim_time', 'start_type_description_service')  # rclpy's own


def _setting(default: Any, description: str, **more: Any) -> Any:
    return field(default=default, metadata={'description': description, **more})


@dataclass(frozen=True)
class Settings:
    """What `--ros-args -p name:=value` can set."""

    waypoints: str = _setting('', 'file of waypoints to follow; empty: ask at the terminal')
    odometry: str = _setting(
        'filtered',
        'which pose to follow: filtered, wheel or ground_truth',
        choice=tuple(ODOMETRY_TOPICS),
    )
    odometry_timeout_sec: float = _setting(
        5.0, 'give up when no odometry comes for so long, wall time', span=(0.1, 600.0)
    )
    startup_timeout_sec: float = _setting(
        5.0, 'the same before the first odometry: while the simulator starts', span=(0.1, 600.0)
    )
    check: str = _setting(
        'warn',
        'a course that passes too near to obstacles: warn, refuse, or off',
        choice=('warn', 'refuse', 'off'),
    )
    world: str = _setting('', 'MJCF file with the obstacles to check against; empty: the playpen')
    start: tuple[float, ...] = _setting(
        (0.0, 0.0, 0.0), 'where the robot starts in that world: x m, y m, yaw rad'
    )
    slip: bool = _setting(True, 'count with the sliding in bends that odometry cannot see')
    imu: bool = _setting(True, 'give up when imu/data shows that something holds the robot')
    scan: bool = _setting(False, 'stop before what front/scan sees on the path')
    progress: str = _setting(
        'auto', 'how progress is shown: auto, bar, lines or off', choice=PROGRESS
    )

    def __post_init__(self) -> None:
        for item in fields(self):
            value, choice = getattr(self, item.name), item.metadata.get('choice')
            if choice and value not in choice:
                allowed = ', '.join(choice)
                raise ValueError(
                    f'parameter {item.name}: {value!r} is not allowed; allowed: {allowed}'
                )

        if len(self.start) != 3:
            raise ValueError(f'parameter start: {len(self.start)} numbers; write [x, y, yaw]')

    @property
    def odometry_topic(self) -> str:
        return ODOMETRY_TOPICS[self.odometry]


def refuse_unknown(names: Iterable[str]) -> None:
    """
    Refuse parameters that nobody declares: a typing mistake would go unnoticed.

    :raises ValueError: naming the first one and the nearest right spelling.
    """
    known = sorted(item.name for item in fields(Settings))
    for name in sorted(set(names) - set(known) - set(NODE_PARAMETERS)):
        if not name.startswith('qos_overrides.'):
            near = get_close_matches(name, known, n=1, cutoff=0.5)
            hint = f'did you mean {near[0]}? ' if near else ''
            allowed = ', '.join(known)
            raise ValueError(f'parameter {name} does not exist; {hint}allowed: {allowed}')
