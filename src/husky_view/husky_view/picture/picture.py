# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
All that is drawn of a run: the playpen, the robots, their trails and paths, collisions.

The live page and the replay share it; it needs no ROS. For one thread.
"""

import time

from husky_course.frames import Array
from husky_course.robot import RobotStart
from husky_sim.scene_topic import Scene, TRACK
from husky_sim.world import World
import numpy as np
import viser

from husky_view.picture import palette
from husky_view.picture.camera import Cameras
from husky_view.picture.geometry import distance_to_line, to_world
from husky_view.picture.marks import (
    add_line,
    CollisionMarks,
    ContactShadow,
    lifted,
    NumberedDiscs,
    Trail,
)
from husky_view.picture.scene import ABOVE_GROUND_M, PlaypenScene

_X, _ODOM_X, _YAW = TRACK.index('x'), TRACK.index('odom_x'), TRACK.index('yaw')
_SPEED = TRACK.index('speed_m_s')


class RobotMarks:
    """What is drawn of one robot beside its body; points (n, 2) are in its frame odom."""

    def __init__(self, server: viser.ViserServer, start: RobotStart, ground_m: float) -> None:
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
        self._shadow = ContactShadow(server, f'{name}/shadow', ground_m + ABOVE_GROUND_M / 2.0)
        self._path: Array = np.zeros((0, 2))
        self._height_m = ground_m + ABOVE_GROUND_M
        self._x_y: Array = np.array([start.x, start.y])
        self.yaw = start.yaw
        self.speed_m_s = 0.0
        self._shadow.move(start.x, start.y, yaw=start.yaw)

    def move(self, track: Array) -> None:
        """Take the newest entries (n, len(TRACK)) of this robot's track."""
        self._x_y = track[-1, _X : _X + 2].copy()
        self.yaw = float(track[-1, _YAW])
        self.speed_m_s = float(track[-1, _SPEED])
        self._shadow.move(*self._x_y.tolist(), yaw=self.yaw)
        self._true_trail.extend(lifted(track[:, _X : _X + 2], self._height_m + 0.02))
        odometry = to_world(self._start, track[:, _ODOM_X : _ODOM_X + 2])
        self._odometry_trail.extend(lifted(odometry, self._height_m + 0.01))

    def draw_trails(self) -> None:
        """Send what was added to the trails."""
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
        self._waypoints.show(marks, highlighted=slice(reached))

    def set_reached(self, reached: int) -> None:
        """Colour the waypoints that were reached."""
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

    @property
    def cross_track_m(self) -> float | None:
        """Return the true distance from the path, positive to its left; None without a path."""
        return distance_to_line(self._x_y, self._path) if len(self._path) >= 2 else None

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

    def __init__(self, server: viser.ViserServer, world: World) -> None:
        self.scene = PlaypenScene(server, world)
        self.robots = [RobotMarks(server, start, self.scene.ground_m) for start in world.robots]
        self.collisions = CollisionMarks(server)
        self._cameras = Cameras(
            server,
            center=np.array(world.model.stat.center),
            extent_m=float(world.model.stat.extent),
        )
        self._time_sec = 0.0
        self._run = ''
        self.followed = 0

    def show(self, scene: Scene) -> None:
        """Draw a scene; one of another run, or with a time that goes back, begins a new run."""
        first = first_of_run(scene.time_sec, after_sec=self._time_sec)
        if first is not None or scene.run != (self._run or scene.run):
            self.clear()
        self._run = scene.run
        self._time_sec = float(scene.time_sec[-1])
        self.scene.show(scene.qpos)
        for place, robot in enumerate(self.robots):
            robot.move(scene.track[first:, place])

    def draw(self, now_sec: float) -> None:
        """Send what grew, animate flashes and cameras; now is of a steady wall clock."""
        for robot in self.robots:
            robot.draw_trails()
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

    def show_scan(self, robot: int, ranges: Array, angles: Array, *, reach_m: float) -> None:
        """Draw the ends of a lidar's beams, without those that hit nothing."""
        hit = np.isfinite(ranges) & (ranges < reach_m)
        self.robots[robot].set_lidar(self.scene.beam_ends(robot, ranges[hit], angles[hit]))

    def clear(self) -> None:
        """Begin a new run, with the same paths."""
        self._time_sec = 0.0
        self.collisions.clear()
        for robot in self.robots:
            robot.clear_run()
