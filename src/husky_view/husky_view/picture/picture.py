# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
All that is drawn of a run: the playpen, the robots, their trails and paths, collisions.

The live page and the replay share it; it needs no ROS. For one thread.
"""

from collections.abc import Iterator
import math
import time

from husky_course.frames import Array
from husky_course.robot import ROBOT_LENGTH_M, ROBOT_WIDTH_M, RobotStart
from husky_sim.scene_topic import Scene, TRACK
from husky_sim.world import World
import numpy as np
import viser

from husky_view.picture import palette
from husky_view.picture.camera import Cameras
from husky_view.picture.collision_marks import CollisionMarks
from husky_view.picture.coordinates import add_start_axes, ground_html, TopGrids
from husky_view.picture.geometry import bounds, distance_to_line, to_world
from husky_view.picture.history import History
from husky_view.picture.marks import (
    add_line,
    lifted,
    NumberedDiscs,
    Trail,
)
from husky_view.picture.page import SHADOWS, TOP
from husky_view.picture.scene import ABOVE_GROUND_M, PlaypenScene
from husky_view.picture.shadows import ContactShadows, ObstacleShadows
from husky_view.picture.tabs import Tabs

_X, _ODOM_X, _YAW = TRACK.index('x'), TRACK.index('odom_x'), TRACK.index('yaw')
_SPEED = TRACK.index('speed_m_s')


SEEN_M = 5.0
"""How far Top shows a world without obstacles."""

NAME_M = 0.6
"""Height of a robot's name above the ground."""


class RobotMarks:
    """
    What is drawn of one robot beside its body; points (n, 2) are in its frame odom.

    :param is_named: whether its name stands above it.
    """

    def __init__(
        self, server: viser.ViserServer, start: RobotStart, ground_m: float, *, is_named: bool
    ) -> None:
        name = f'/{start.name}'
        self._server = server
        self._start = start
        self._true_trail = Trail(server, f'{name}/true_trail', palette.TRUE_TRAIL)
        self._odometry_trail = Trail(server, f'{name}/odometry_trail', palette.ODOMETRY_TRAIL)
        self._path_name = f'{name}/path'
        self._waypoints = NumberedDiscs(
            server,
            f'{name}/waypoints',
            radius_m=0.12,
            height_m=0.01,
            color=palette.WAYPOINT,
            highlight=palette.REACHED,
        )
        self._look_ahead = server.scene.add_icosphere(
            f'{name}/look_ahead',
            radius=0.09,
            color=palette.LOOK_AHEAD,
            visible=False,
            cast_shadow=False,
        )
        self._lidar = server.scene.add_point_cloud(
            f'{name}/lidar',
            points=np.zeros((1, 3), dtype=np.float32),
            colors=palette.LIDAR,
            point_size=0.04,
            visible=False,
        )
        self._shadow = ContactShadows(
            server,
            f'{SHADOWS}{start.name}',
            (ROBOT_LENGTH_M, ROBOT_WIDTH_M),
            [(start.x, start.y, start.yaw)],
            ground_m + ABOVE_GROUND_M / 2.0,
        )
        self._name = server.scene.add_label(
            f'{name}/name',
            start.name,
            anchor='bottom-center',
            font_screen_scale=0.9,
            depth_test=True,
            visible=is_named,
        )
        self._name_m = ground_m + NAME_M
        add_start_axes(server, f'{name}/start', start, ground_m + ABOVE_GROUND_M)
        self._path: Array = np.zeros((0, 2))
        self._reached = 0
        self._height_m = ground_m + ABOVE_GROUND_M
        self._x_y: Array = np.array([start.x, start.y])
        self.yaw = start.yaw
        self.speed_m_s = 0.0
        self._place()

    def move(self, track: Array) -> None:
        """Take the newest entries (n, len(TRACK)) of this robot's track; `draw` shows them."""
        self._x_y = track[-1, _X : _X + 2].copy()
        self.yaw = float(track[-1, _YAW])
        self.speed_m_s = float(track[-1, _SPEED])
        self._true_trail.extend(lifted(track[:, _X : _X + 2], self._height_m + 0.02))
        odometry = to_world(self._start, track[:, _ODOM_X : _ODOM_X + 2])
        self._odometry_trail.extend(lifted(odometry, self._height_m + 0.01))

    def _place(self) -> None:
        x, y = self._x_y.tolist()
        self._shadow.move([(x, y, self.yaw)])
        if self._name.visible:
            self._name.position = (x, y, self._name_m)

    def draw(self) -> None:
        """Send where it is, and what was added to the trails."""
        self._place()
        self._true_trail.draw()
        self._odometry_trail.draw()

    def set_path(self, points: Array) -> None:
        """Draw the path to follow; fewer than two points clear it."""
        self._path = to_world(self._start, points)
        if len(points) >= 2:
            line = lifted(self._path, self._height_m)
            add_line(self._server, self._path_name, line, palette.PATH)
        else:
            self._server.scene.remove_by_name(self._path_name)

    def set_waypoints(self, points: Array, *, reached: int = 0) -> None:
        """Draw the waypoints; the first ones were reached."""
        marks = lifted(to_world(self._start, points), self._height_m)
        self._reached = reached
        self._waypoints.show(marks, highlighted=slice(reached))

    def show_numbers(self, shown: bool) -> None:
        """Show or hide the numbers of the waypoints."""
        self._waypoints.show_numbers(shown)

    def set_reached(self, reached: int) -> None:
        """Colour the waypoints that were reached."""
        self._reached = reached
        self._waypoints.highlight(slice(reached))

    def set_look_ahead(self, point: Array | None) -> None:
        """Draw the point (2,) that the driver aims at; None hides it."""
        if point is not None:
            x, y = to_world(self._start, point[None])[0]
            self._look_ahead.position = np.array([x, y, self._height_m + 0.08])
        self._look_ahead.visible = point is not None

    def set_lidar(self, hits: Array) -> None:
        """Draw lidar hits (n, 3) in the world."""
        self._lidar.visible = len(hits) > 0
        if len(hits):
            self._lidar.points = hits.astype(np.float32)

    def colors(self) -> Iterator[palette.Rgb]:
        """Yield the colours of what there is to be seen."""
        shown = {
            palette.PATH: len(self._path) >= 2,
            palette.REACHED: self._reached > 0,
            palette.TRUE_TRAIL: self._true_trail.is_drawn,
            palette.ODOMETRY_TRAIL: self._odometry_trail.is_drawn,
            palette.LOOK_AHEAD: self._look_ahead.visible,
            palette.LIDAR: self._lidar.visible,
        }
        yield from (color for color, is_shown in shown.items() if is_shown)

    @property
    def cross_track_m(self) -> float | None:
        """Return the true distance from the path, positive to its left; None without a path."""
        return self.off_path_m(self._x_y) if len(self._path) >= 2 else None

    def off_path_m(self, x_y: Array) -> float:
        """Return how far a place (2,) of the world is off the path; NaN without a path."""
        return distance_to_line(x_y, self._path) if len(self._path) >= 2 else math.nan

    def clear_run(self) -> None:
        """Remove what belongs to one run; the path and its waypoints stay."""
        self._true_trail.clear()
        self._odometry_trail.clear()
        self.set_reached(0)
        self.set_look_ahead(None)


def first_of_run(time_sec: Array, *, after_sec: float) -> int | None:
    """
    Return the first entry of a run that has begun in between, or None.

    A message has what came before a reset, too: drawn as one trail, it would lead from the end of
    the last run to the start of the next.
    """
    back = np.flatnonzero(np.diff(time_sec, prepend=after_sec) < 0.0)
    return int(back[-1]) if len(back) else None


class Picture:
    """All that is drawn of a run."""

    def __init__(self, server: viser.ViserServer, tabs: Tabs, world: World) -> None:
        self.scene = PlaypenScene(server, world)
        self.robots = [
            RobotMarks(server, start, self.scene.ground_m, is_named=len(world.robots) > 1)
            for start in world.robots
        ]
        self._shadows = ObstacleShadows(
            server, self.scene.outlines(), self.scene.ground_m + ABOVE_GROUND_M / 3.0
        )
        self.collisions = CollisionMarks(server)
        seen = bounds(world.obstacles, at_least_m=SEEN_M)
        self._cameras = Cameras(
            server,
            tabs,
            center=np.array(world.model.stat.center),
            extent_m=float(world.model.stat.extent),
            seen_from_above=seen,
        )
        self._grids = TopGrids(tabs, seen, self.scene.ground_m + ABOVE_GROUND_M)
        self.history = History()
        self._time_sec = 0.0
        self._run = ''
        self._undrawn: Array | None = None  # joint positions of the newest scene
        self.followed = 0

    def show(self, scene: Scene) -> bool:
        """
        Take a scene; one of another run, or with a time that goes back, begins a new run.

        `draw` shows it. Until then this costs little, as while no page is open.

        :return: whether it began one.
        """
        first = first_of_run(scene.time_sec, after_sec=self._time_sec)
        is_new = first is not None or scene.run != (self._run or scene.run)
        if is_new:
            self.clear()
        self._run = scene.run
        self._time_sec = float(scene.time_sec[-1])
        self._undrawn = scene.qpos
        for place, robot in enumerate(self.robots):
            robot.move(scene.track[first:, place])
        track = scene.track[first:, self.followed]
        followed = self.robots[self.followed]
        self.history.add(
            scene.time_sec[first:],
            track[:, _SPEED],
            lambda place: followed.off_path_m(track[place, _X : _X + 2]),
        )
        return is_new

    def draw(self, now_sec: float) -> None:
        """Send what moved and grew, animate flashes and cameras; now is of a steady wall clock."""
        if self._undrawn is not None:
            self.scene.show(self._undrawn)
            self._shadows.show(self.scene.outlines())
            for robot in self.robots:
                robot.draw()
            self._undrawn = None
        self.collisions.update(now_sec)
        self._cameras.follow(self.scene.position(self.followed), now_sec=now_sec)

    def choose_camera(self, client: viser.ClientHandle, preset: str) -> None:
        """Bring the camera of a tab to a preset."""
        self._cameras.choose(
            client,
            preset,
            robot=self.scene.position(self.followed),
            yaw=self.robots[self.followed].yaw,
            now_sec=time.monotonic(),
        )
        if preset == TOP:
            self._grids.show(client, self.scene.world.robots[self.followed])
        else:
            self._grids.hide(client)

    def follow(self, place: int) -> None:
        """Follow another robot, whose frame odom is that of the coordinates from now on."""
        self.followed = place
        self.history.clear()  # it is of one robot
        self._grids.choose(self.scene.world.robots[place])

    def ground_html(self) -> str:
        """Return what the page is to know of the ground, for the pointer."""
        robots = self.scene.world.robots
        return ground_html(
            robots[self.followed],
            self.scene.ground_m,
            self.scene.outlines(),
            is_named=len(robots) > 1,
        )

    def colors(self) -> set[palette.Rgb]:
        """Return the colours of what there is to be seen, for the legend."""
        seen = {color for robot in self.robots for color in robot.colors()}
        return seen | ({palette.COLLISION} if self.collisions.count else set())

    def show_numbers(self, shown: bool) -> None:
        """Show or hide the numbers of the given waypoints."""
        for robot in self.robots:
            robot.show_numbers(shown)

    def show_scan(self, robot: int, ranges: Array, angles: Array, *, reach_m: float) -> None:
        """Draw the ends of a lidar's beams, without those that hit nothing."""
        hit = np.isfinite(ranges) & (ranges < reach_m)
        self.robots[robot].set_lidar(self.scene.beam_ends(robot, ranges[hit], angles[hit]))

    def clear(self) -> None:
        """Begin a new run, with the same paths."""
        self._time_sec = 0.0
        self.history.clear()
        self.collisions.clear()
        for robot in self.robots:
            robot.clear_run()
