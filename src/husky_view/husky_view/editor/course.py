# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Waypoint files as the driver understands them.

Nothing here decides what a waypoint file means: husky_course does, for the driver too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import math
from pathlib import Path
import re

from husky_course.outline import clearances, Outline
from husky_course.robot import RobotStart
from husky_course.route import Leg, plan_route
from husky_course.waypoints import Course, parse_course, Waypoint
import numpy as np
import numpy.typing as npt

from husky_view.editor.draft import Content, Draft, Point
from husky_view.picture.planar import to_world

Array = npt.NDArray[np.float64]

NAME = re.compile(r'[A-Za-z0-9][A-Za-z0-9_-]{0,60}')
EVERY = 5  # of the driver's samples, 2 cm apart


class CourseRefused(Exception):
    """A draft that is no course, or a file that cannot be read or written."""


@dataclass(frozen=True, kw_only=True)
class Preview:
    """The path that the driver would take, and how near it passes, in the frame world."""

    line: Array  # (n, 2)
    clearance_m: Array  # (n,)


def preview(draft: Draft, start: RobotStart, obstacles: Sequence[Outline]) -> Preview:
    """
    Ask the driver for its path through a draft.

    :raises CourseRefused: if the driver would not take it.
    """
    route = plan_route(_parsed(draft.text(), 'the draft'))
    poses = np.concatenate([_poses(leg) for leg in route.legs])
    poses[:, :2] = to_world(start, poses[:, :2])
    poses[:, 2] += start.yaw
    return Preview(line=poses[:, :2], clearance_m=clearances(poses, obstacles))


def _poses(leg: Leg) -> Array:
    curve = leg.curve
    table = np.array([curve.x, curve.y, curve.heading]).T
    table[:, 2] += math.pi if leg.reverse else 0.0
    return np.concatenate([table[:-1:EVERY], table[-1:]])


def _parsed(text: str, name: str) -> Course:
    try:
        return parse_course(text, name)
    except ValueError as error:
        raise CourseRefused(str(error)) from error


def load(file: Path) -> Content:
    """
    Read a waypoint file to edit it.

    :raises CourseRefused: if the driver would not take it.
    """
    try:
        course = _parsed(file.read_text(encoding='utf-8'), file.name)
    except OSError as error:
        raise CourseRefused(f'{file}: {error.strerror}') from error
    return Content(
        points=tuple(_point(waypoint) for waypoint in course.waypoints),
        speed_m_s=course.speed_m_s,
        tolerance_m=course.tolerance_m,
        loop=course.loop,
        corners=course.corners,
    )


def _point(waypoint: Waypoint) -> Point:
    fields = (
        ('speed', waypoint.speed_m_s),
        ('yaw', waypoint.yaw_rad),
        ('dwell', waypoint.dwell_sec or None),
        ('reverse', waypoint.reverse or None),
    )
    more = tuple(
        (name, 'true' if value is True else f'{value:g}')
        for name, value in fields
        if value is not None
    )
    return Point(round(waypoint.x_m, 2), round(waypoint.y_m, 2), more)


def path_of(file: Path) -> tuple[Array, Array]:
    """
    Return the driver's path through a waypoint file and its waypoints (n, 2), in the frame odom.

    :raises CourseRefused: if the driver would not take it.
    """
    try:
        text = file.read_text(encoding='utf-8')
    except OSError as error:
        raise CourseRefused(f'{file}: {error.strerror}') from error
    course = _parsed(text, file.name)
    route = plan_route(course)
    line = np.concatenate([_poses(leg) for leg in route.legs])[:, :2]
    return line, np.array([(waypoint.x_m, waypoint.y_m) for waypoint in course.waypoints])


def save(draft: Draft, folder: Path, name: str) -> Path:
    """
    Write a draft as NAME.yaml, whole or not at all.

    :raises CourseRefused: if the driver would not take it, or the name or the folder cannot be.
    """
    if not NAME.fullmatch(name):
        raise CourseRefused(f'name {name!r}: letters, digits, _ and - are allowed, 1 to 61')
    text = draft.text()
    _parsed(text, f'{name}.yaml')
    file = folder / f'{name}.yaml'
    part = folder / f'.{name}.yaml.part'
    try:
        part.write_text(text, encoding='utf-8')
        part.replace(file)
    except OSError as error:
        raise CourseRefused(f'{file}: {error.strerror}') from error
    return file


def waypoint_folder() -> Path:
    """Return where the workspace keeps its waypoint files, or else the current folder."""
    in_source = Path(__file__).resolve().parents[4] / 'config' / 'waypoints'
    return in_source if in_source.is_dir() else Path.cwd()


def files_in(folder: Path) -> list[str]:
    """Return the names of the waypoint files of a folder, without .yaml."""
    return sorted(file.stem for file in folder.glob('*.yaml') if NAME.fullmatch(file.stem))
