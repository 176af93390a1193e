# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
All that is to be seen of a run: the playpen, the robots, their trails and paths, collisions.

Neither live nor replayed, and without ROS. For one thread.
"""

from husky_course.record import Collision
from husky_course.robot import RobotStart
from husky_sim.scene_topic import Scene, TRACK
from husky_sim.world import World
import numpy as np
import numpy.typing as npt
import viser

from husky_view.picture import palette
from husky_view.picture.cameras import Cameras
from husky_view.picture.collisions import CollisionMarks
from husky_view.picture.marks import LidarMark, lifted, PathMark, PointMark, WaypointMarks
from husky_view.picture.planar import distance_to_line, to_world
from husky_view.picture.scene import ABOVE_GROUND_M, PlaypenScene
from husky_view.picture.trail import Trail

Array = npt.NDArray[np.float64]

_X, _ODOM_X, _YAW = TRACK.index('x'), TRACK.index('odom_x'), TRACK.index('yaw')
_SPEED = TRACK.index('speed_m_s')


class RobotPicture:
    """What belongs to one robot."""

    def __init__(self, server: viser.ViserServer, start: RobotStart, ground_m: float) -> None:
        name = f'/{start.name}'
        self.start = start
        self.true_trail = Trail(server, f'{name}/true_trail', palette.TRUE_TRAIL)
        self.odometry_trail = Trail(server, f'{name}/odometry_trail', palette.ODOMETRY_TRAIL)
        self._path_mark = PathMark(server, f'{name}/path')
        self._waypoints = WaypointMarks(server, f'{name}/waypoints')
        self._look_ahead = PointMark(server, f'{name}/look_ahead', palette.LOOK_AHEAD)
        self.lidar = LidarMark(server, f'{name}/lidar')
        self._path: Array = np.zeros((0, 2))
        self._height_m = ground_m + ABOVE_GROUND_M
        self.x_y: Array = np.array([start.x, start.y])
        self.yaw = start.yaw
        self.speed_m_s = 0.0

    def move(self, track: Array) -> None:
        """Take the newest entries (n, len(TRACK)) of this robot's track."""
        self.x_y = track[-1, _X : _X + 2].copy()
        self.yaw = float(track[-1, _YAW])
        self.speed_m_s = float(track[-1, _SPEED])
        self.true_trail.extend(lifted(track[:, _X : _X + 2], self._height_m + 0.02))
        believed = to_world(self.start, track[:, _ODOM_X : _ODOM_X + 2])
        self.odometry_trail.extend(lifted(believed, self._height_m + 0.01))

    def set_path(self, points: Array) -> None:
        """Take the path to follow: points (n, 2) in the frame odom."""
        self._path = to_world(self.start, points)
        self._path_mark.show(lifted(self._path, self._height_m))

    def set_waypoints(self, points: Array, *, reached: int = 0) -> None:
        """Take the waypoints: points (n, 2) in the frame odom."""
        marks = lifted(to_world(self.start, points), self._height_m)
        self._waypoints.show(marks, reached=reached)

    def set_reached(self, reached: int) -> None:
        """Colour the waypoints that were reached."""
        self._waypoints.set_reached(reached)

    def set_look_ahead(self, point: Array | None) -> None:
        """Show the point (2,) in the frame odom that the driver aims at; None hides it."""
        if point is None:
            self._look_ahead.show(None)
        else:
            x, y = to_world(self.start, point[None])[0]
            self._look_ahead.show((x, y, self._height_m + 0.08))

    @property
    def cross_track_m(self) -> float | None:
        """Return the true distance from the path, positive to its left; None without a path."""
        return distance_to_line(self.x_y, self._path) if len(self._path) >= 2 else None

    def clear_trails(self) -> None:
        """Forget where the robot has been."""
        self.true_trail.clear()
        self.odometry_trail.clear()


class Picture:
    """The whole of it."""

    def __init__(self, server: viser.ViserServer, world: World) -> None:
        self.world = world
        self.scene = PlaypenScene(server, world)
        self.robots = [RobotPicture(server, start, self.scene.ground_m) for start in world.robots]
        self.collisions = CollisionMarks(server)
        self.cameras = Cameras(
            server,
            center=np.array(world.model.stat.center),
            extent_m=float(world.model.stat.extent),
        )
        self.time_sec = 0.0
        self._run = ''
        self.collision_count = 0
        self.followed = 0

    def show(self, scene: Scene) -> None:
        """Bring everything to the end of a scene; a scene of the past begins a new run."""
        if scene.time_sec[-1] < self.time_sec or scene.run != (self._run or scene.run):
            self.clear()
        self._run = scene.run
        self.time_sec = float(scene.time_sec[-1])
        self.scene.show(scene.qpos)
        for place, robot in enumerate(self.robots):
            robot.move(scene.track[:, place])

    def draw(self, now_sec: float) -> None:
        """Send the lines that grew, go on with flashes and cameras; now is of a wall clock."""
        for robot in self.robots:
            robot.true_trail.draw()
            robot.odometry_trail.draw()
        self.collisions.update(now_sec)
        self.cameras.follow(self.scene.position(self.followed), now_sec=now_sec)

    def collide(self, collision: Collision, *, now_sec: float) -> None:
        """Show a collision."""
        self.collision_count += 1
        self.collisions.add(collision, now_sec=now_sec)

    def show_scan(self, robot: int, ranges: Array, angles: Array, *, reach_m: float) -> None:
        """Show where the beams of a robot's lidar ended, but for those that hit nothing."""
        hit = np.isfinite(ranges) & (ranges < reach_m)
        self.robots[robot].lidar.show(self.scene.beam_ends(robot, ranges[hit], angles[hit]))

    def clear(self) -> None:
        """Begin anew, with the same paths."""
        self.collision_count = 0
        self.collisions.clear()
        for robot in self.robots:
            robot.clear_trails()
            robot.set_reached(0)
            robot.set_look_ahead(None)
