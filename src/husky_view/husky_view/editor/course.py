# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A course while it is edited, and the waypoint files that it is read from and saved as.

What a waypoint file means is decided by husky_course alone, as for the driver.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
import math
import os
from pathlib import Path
import re
from typing import Any, NamedTuple

from husky_course.files import replacing
from husky_course.frames import Array
from husky_course.outline import clearances, Outline
from husky_course.robot import RobotStart
from husky_course.route import Leg, plan_route, poses_along
from husky_course.waypoints import Course, load_course, parse_course, Waypoint
import numpy as np

UNDO_STEPS = 100
MOST_WAYPOINTS = 200
NEAR_M = 0.3
"""A click nearer than this to a waypoint means that waypoint."""

NAME = re.compile(r'[A-Za-z0-9][A-Za-z0-9_-]{0,60}')
SAME_M = 1e-6
EVERY = 5  # of the driver's samples, 2 cm apart
EMPTY = Course(name='', waypoints=())


class CourseRefused(Exception):
    """An edited course that is invalid, or a file that cannot be read or written."""


@dataclass
class EditableCourse:
    """A course with a selected waypoint, whose changes can be undone."""

    course: Course = EMPTY
    selected: int | None = None
    _past: list[Course] = field(default_factory=list)

    def _change(self, *, select: int | None = None, **changes: Any) -> None:
        self._past = [*self._past[1 - UNDO_STEPS :], self.course]
        self.course = replace(self.course, **changes)
        self.selected = select

    def add(self, x: float, y: float) -> None:
        """Append a waypoint and select it, if there are not too many to draw."""
        waypoints = self.course.waypoints
        if len(waypoints) >= MOST_WAYPOINTS:
            return
        added = Waypoint(_rounded(x), _rounded(y))
        self._change(waypoints=(*waypoints, added), select=len(waypoints))

    def begin_move(self, number: int) -> None:
        """Begin a drag, which is undone as a whole."""
        self._change(select=number)

    def move(self, number: int, x: float, y: float) -> None:
        """Move a waypoint."""
        waypoints = list(self.course.waypoints)
        waypoints[number] = replace(waypoints[number], x_m=_rounded(x), y_m=_rounded(y))
        self.course = replace(self.course, waypoints=tuple(waypoints))

    def delete_selected(self) -> None:
        """Remove the selected waypoint, or else the last one."""
        waypoints = list(self.course.waypoints)
        if waypoints:
            del waypoints[self.selected if self.selected is not None else -1]
            self._change(waypoints=tuple(waypoints))

    def clear(self) -> None:
        """Remove all waypoints."""
        self._change(waypoints=())

    def set_speed(self, speed_m_s: float) -> None:
        """Change the speed of the whole course."""
        self._change(select=self.selected, speed_m_s=speed_m_s)

    def set_loop(self, loop: bool) -> None:
        """Change whether the course comes back to its first waypoint."""
        self._change(select=self.selected, loop=loop)

    def load(self, course: Course) -> None:
        """Replace the whole course."""
        self._change()
        self.course = course

    def undo(self) -> None:
        """Undo the last change."""
        if self._past:
            self.course = self._past.pop()
            self.selected = None

    def nearest(self, x: float, y: float) -> int | None:
        """Return the waypoint that a click means, if any."""
        distances = [math.hypot(p.x_m - x, p.y_m - y) for p in self.course.waypoints]
        if not distances or min(distances) > NEAR_M:
            return None
        return distances.index(min(distances))


def _rounded(length_m: float) -> float:
    return round(length_m, 2) + 0.0  # no -0.0


def text_of(course: Course) -> str:
    """Return the waypoint file of a course."""
    corners = '' if course.corners == 'smooth' else f'corners: {course.corners}\n'
    return (
        '# Made with the editor of the view.\n'
        'frame: odom         # metres, x forward and y left of where the Husky starts\n'
        f'speed: {course.speed_m_s:<12g} # m/s along the path, up to 1.0\n'
        f'tolerance: {course.tolerance_m:<8g} # m, how near counts as reached\n'
        f'loop: {"true " if course.loop else "false"}         '
        '# true: come back to the first waypoint\n'
        f'{corners}waypoints:\n' + ''.join(map(_entry_of, course.waypoints))
    )


def _entry_of(waypoint: Waypoint) -> str:
    x, y = f'{waypoint.x_m:.2f}', f'{waypoint.y_m:.2f}'
    fields = {
        'speed': waypoint.speed_m_s,
        'yaw': waypoint.yaw_rad,
        'dwell': waypoint.dwell_sec or None,
    }
    more = ''.join(f', {name}: {value:g}' for name, value in fields.items() if value is not None)
    more += ', reverse: true' if waypoint.reverse else ''
    return f'  - {{x: {x}, y: {y}{more}}}\n' if more else f'  - [{x}, {y}]\n'


class Preview(NamedTuple):
    """
    The path (n, 2) that the driver would take, in the frame world, and its clearances (n,).

    It begins where the robot starts, also where the first waypoint is elsewhere.

    :param nearest: the obstacle that it passes nearest to; empty if there is none.
    """

    line: Array
    clearance_m: Array
    nearest: str


def preview(course: Course, start: RobotStart, obstacles: Sequence[Outline]) -> Preview:
    """
    Return what the driver would do.

    :raises CourseRefused: if the driver would refuse it.
    """
    poses, _ = poses_along(plan_route(_parsed(text_of(course), 'the draft')), start.pose)
    clearance_m = clearances(poses, obstacles)
    worst = poses[clearance_m.argmin()][None]
    nearest = min(obstacles, key=lambda each: clearances(worst, [each])[0], default=None)
    # A turn on the spot is one place of the line.
    goes = np.hypot(*np.diff(poses[:, :2], axis=0).T) > SAME_M
    places = np.flatnonzero(np.append(True, goes))
    least_m = np.minimum.reduceat(clearance_m, places)
    return Preview(poses[places, :2], least_m, nearest.name if nearest else '')


def _path(course: Course) -> Array:
    """Return the poses (n, 3) of the driver's path, with the way to its first waypoint."""
    return np.concatenate([_poses(leg) for leg in plan_route(course).begun_at((0.0, 0.0)).legs])


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


def _read(file: Path) -> Course:
    try:
        return load_course(file)
    except ValueError as error:
        raise CourseRefused(str(error)) from error


def load(file: Path) -> Course:
    """
    Read a waypoint file to edit it; its waypoints are rounded to whole centimetres.

    :raises CourseRefused: if the driver would refuse it.
    """
    course = _read(file)
    waypoints = tuple(
        replace(each, x_m=_rounded(each.x_m), y_m=_rounded(each.y_m), line=0)
        for each in course.waypoints
    )
    return replace(course, name='', waypoints=waypoints)


def path_of(file: Path) -> tuple[Array, Array]:
    """
    Return the driver's path through a waypoint file and its waypoints (n, 2), in the frame odom.

    :raises CourseRefused: if the driver would refuse it.
    """
    course = _read(file)
    waypoints = np.array([(waypoint.x_m, waypoint.y_m) for waypoint in course.waypoints])
    return _path(course)[:, :2], waypoints


def file_of(folder: Path, name: str) -> Path:
    """
    Return the waypoint file of a name, whether it is there or not.

    :raises CourseRefused: if the name is invalid.
    """
    if not NAME.fullmatch(name):
        raise CourseRefused(f'name {name!r}: letters, digits, _ and - are allowed, 1 to 61')
    return folder / f'{name}.yaml'


def stamp(file: Path) -> tuple[int, ...] | None:
    """Return what is another after each change of a file; None where there is no such file."""
    try:
        found = file.stat()
    except OSError:
        return None
    return found.st_ino, found.st_size, found.st_mtime_ns


def save(course: Course, folder: Path, name: str) -> Path:
    """
    Write a course as NAME.yaml, whole or not at all.

    :raises CourseRefused: if the driver would refuse it, or the name or the folder is invalid.
    """
    file = file_of(folder, name)
    text = text_of(course)
    _parsed(text, file.name)
    try:
        # A link stays one: the file that it leads to is written, as by any editor.
        with replacing(Path(os.path.realpath(file))) as part:
            part.write_text(text, encoding='utf-8')
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
