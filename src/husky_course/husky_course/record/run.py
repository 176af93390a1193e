# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The run of one robot in a record, in the robot's own frame `odom`.

Its time begins with the drive, which begins with the first command: what the robot waited before
has negative times.
"""

from dataclasses import dataclass
import hashlib
import math

import numpy as np

from husky_course.frames import Array, Indices, Pose, to_odom, to_world
from husky_course.outline import Outline
from husky_course.record.contents import Collision, COLUMNS, Columns, Disturbance
from husky_course.record.record import Record


@dataclass(frozen=True, eq=False, kw_only=True)
class Run(Columns[Array]):
    """
    One robot's run; every array has one entry a control period.

    `x`, `y` and `yaw` are the true pose in the frame that its odometry started in.
    """

    begin: int  # the entry at which the drive began
    start: Pose  # in the frame world
    conditions: tuple[str, ...]  # settings that are not the default, as NAME:=VALUE
    collisions: tuple[Collision, ...]
    disturbances: tuple[Disturbance, ...]
    turned_over_sec: float | None
    obstacles: tuple[Outline, ...]
    min_clearance_m: float | None
    trajectory_sha256: str
    complete: bool  # false: the simulator ended before it could say so

    def to_world(self, x: Array, y: Array) -> tuple[Array, Array]:
        return to_world(self.start, x, y)

    def spread(self, most: int, begin: int = 0, end: int | None = None) -> Indices:
        """Return entries, the first and the last among them, evenly spread over the way driven."""
        x, y = self.x[begin:end], self.y[begin:end]
        if len(x) <= most:
            return begin + np.arange(len(x))
        way_m = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        evenly = np.searchsorted(way_m, np.linspace(0.0, way_m[-1], most - 2))
        some = {0, *np.minimum(evenly, len(x) - 1).tolist(), len(x) - 1}
        return begin + np.array(sorted(some))  # np.unique would load numpy.ma, which takes time


def read_run(record: Record, robot: str | None = None) -> Run:
    """
    Return one robot's run.

    :param robot: its name; None takes the only one.
    :raises RecordRefused: when the robot is not in the record.
    """
    place = record.place_of(robot)
    start = record.robots[place]
    begin = record.begin(place)
    begin_sec = float(record.rows[begin, place, 0])
    table = {column: record.column(place, column) for column in COLUMNS}
    x, y = to_odom(start.pose, table['x'], table['y'])
    yaw = table['yaw'] - start.yaw
    table |= {
        'time_sec': table['time_sec'] - begin_sec,
        'x': x,
        'y': y,
        'yaw': yaw - 2 * math.pi * np.rint(yaw / (2 * math.pi)),
    }
    collisions, disturbances, overturns = record.events_since(begin_sec)
    # Time and true pose of every period, as they are: four little-endian doubles each.
    poses = record.rows[:, place, :4].astype('<f8').tobytes()
    return Run(
        **table,
        begin=begin,
        start=start.pose,
        conditions=record.conditions,
        collisions=tuple(touch for touch in collisions if touch.robot == start.name),
        disturbances=disturbances,
        turned_over_sec=next((e.time_sec for e in overturns if e.robot == start.name), None),
        obstacles=record.obstacles,
        min_clearance_m=record.min_clearance_m(place),
        trajectory_sha256=hashlib.sha256(poses).hexdigest(),
        complete=record.complete,
    )
