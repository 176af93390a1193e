# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What obstacles look like from above, and how near a robot comes to them.

An outline is a circle or a rectangle: enough for every obstacle of the playpen, and for any other
the smallest rectangle around it, in the direction the body faces.
"""

from collections.abc import Sequence
from dataclasses import dataclass
import math

import mujoco
import numpy as np
import numpy.typing as npt

from husky_sim.config import ROBOT_LENGTH_M, ROBOT_WIDTH_M

Array = npt.NDArray[np.float64]

_DIRECTIONS = 72
_ROUND = 0.02  # how far a circle may be from round, as a part of its radius
_UPRIGHT_RAD = 0.15  # a body tilted less than this is seen along its own axis


@dataclass(frozen=True, kw_only=True)
class Outline:
    """An obstacle seen from above, in the frame `world`: metres and radians."""

    name: str
    x: float
    y: float
    yaw: float
    size: tuple[float, ...]  # (radius,) of a circle, or the lengths along x and y of a rectangle

    @property
    def type(self) -> str:
        """Tell `circle` from `rect`."""
        return 'circle' if len(self.size) == 1 else 'rect'


def outline_of(
    name: str, model: mujoco.MjModel, data: mujoco.MjData, geoms: Sequence[int], *, body: int
) -> Outline:
    """Measure the outline of some geoms that stand in data as they do in the world."""
    origin = data.xpos[body].copy()
    turn = data.xmat[body].reshape(3, 3)
    yaw = math.atan2(turn[1, 0], turn[0, 0])
    tilted = math.acos(max(-1.0, min(1.0, float(turn[2, 2])))) > _UPRIGHT_RAD
    frame = _about_z(yaw) if tilted else turn
    directions = _circle_of_directions() @ frame[:, :2].T
    reach = np.max([_reach(model, data, geom, origin, directions) for geom in geoms], axis=0)
    if reach.max() - reach.min() <= _ROUND * reach.max():
        return Outline(
            name=name, x=float(origin[0]), y=float(origin[1]), yaw=yaw, size=(float(reach.max()),)
        )
    quarter = _DIRECTIONS // 4
    front, left, back, right = (float(reach[i * quarter]) for i in range(4))
    middle = _about_z(yaw)[:2, :2] @ np.array([(front - back) / 2.0, (left - right) / 2.0])
    return Outline(
        name=name,
        x=float(origin[0] + middle[0]),
        y=float(origin[1] + middle[1]),
        yaw=yaw,
        size=(front + back, left + right),
    )


def _about_z(angle_rad: float) -> Array:
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])


def _circle_of_directions() -> Array:
    angles = np.arange(_DIRECTIONS) * (math.tau / _DIRECTIONS)
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _reach(
    model: mujoco.MjModel, data: mujoco.MjData, geom: int, origin: Array, directions: Array
) -> Array:
    """Return how far a geom reaches from origin along each of the unit vectors (n, 3)."""
    kind = mujoco.mjtGeom
    size = model.geom_size[geom]
    local = directions @ data.geom_xmat[geom].reshape(3, 3)
    middle: Array = directions @ (data.geom_xpos[geom] - origin)
    shape = int(model.geom_type[geom])
    if shape == kind.mjGEOM_SPHERE:
        return middle + size[0]
    if shape == kind.mjGEOM_CAPSULE:
        return middle + size[0] + size[1] * np.abs(local[:, 2])
    if shape == kind.mjGEOM_CYLINDER:
        across = np.hypot(local[:, 0], local[:, 1])
        return middle + size[0] * across + size[1] * np.abs(local[:, 2])
    if shape == kind.mjGEOM_ELLIPSOID:
        return middle + np.linalg.norm(local * size, axis=1)
    if shape == kind.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        first = model.mesh_vertadr[mesh]
        points = model.mesh_vert[first : first + model.mesh_vertnum[mesh]]
        return middle + (local @ points.T).max(axis=1)
    return middle + np.abs(local) @ size


def clearances(poses: Array, outlines: Sequence[Outline]) -> Array:
    """
    Return the plan distance of the robot's rectangle to the nearest outline, for every pose.

    :param poses: one row for every pose: x, y, yaw.
    """
    nearest = np.full(len(poses), math.inf)
    for outline in outlines:
        nearest = np.minimum(nearest, _clearance(poses, outline))
    return nearest


def _clearance(poses: Array, outline: Outline) -> Array:
    robot = np.array([ROBOT_LENGTH_M / 2.0, ROBOT_WIDTH_M / 2.0])
    middle = np.array([[outline.x, outline.y]])
    if outline.type == 'circle':
        away = _to_rectangle(_into(poses, middle), robot)[:, 0] - outline.size[0]
        return np.maximum(away, 0.0)
    half = np.array(outline.size) / 2.0
    pose = np.array([[outline.x, outline.y, outline.yaw]])
    corners = _out_of(pose, _corners(half))[0]
    robot_corners = _out_of(poses, _corners(robot))
    theirs = _into(poses, corners)
    ours = _into(pose, robot_corners.reshape(-1, 2)).reshape(len(poses), 4, 2)
    away = np.minimum(
        _to_rectangle(theirs, robot).min(axis=1), _to_rectangle(ours, half).min(axis=1)
    )
    apart = np.logical_or(_beside(theirs, robot), _beside(ours, half))
    return np.where(apart, away, 0.0)


def _corners(half: Array) -> Array:
    return half * np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]])


def _out_of(poses: Array, points: Array) -> Array:
    """Bring points from the frame of every pose into the world: shape (poses, points, 2)."""
    cos, sin = np.cos(poses[:, 2, None]), np.sin(poses[:, 2, None])
    x = poses[:, 0, None] + cos * points[:, 0] - sin * points[:, 1]
    y = poses[:, 1, None] + sin * points[:, 0] + cos * points[:, 1]
    return np.stack([x, y], axis=2)


def _into(poses: Array, points: Array) -> Array:
    """Bring points from the world into the frame of every pose: shape (poses, points, 2)."""
    cos, sin = np.cos(poses[:, 2, None]), np.sin(poses[:, 2, None])
    x = points[:, 0] - poses[:, 0, None]
    y = points[:, 1] - poses[:, 1, None]
    return np.stack([cos * x + sin * y, cos * y - sin * x], axis=2)


def _to_rectangle(points: Array, half: Array) -> Array:
    """Return the distance of points to a rectangle around the origin."""
    outside = np.maximum(np.abs(points) - half, 0.0)
    return np.hypot(outside[..., 0], outside[..., 1])


def _beside(corners: Array, half: Array) -> Array:
    """Tell whether all four corners lie on one side of a rectangle: a separating axis."""
    beyond = (corners.min(axis=1) > half) | (corners.max(axis=1) < -half)
    return beyond.any(axis=1)
