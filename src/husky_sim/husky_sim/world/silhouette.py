# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Measures the outlines of what stands in a world: see `outline`."""

from collections.abc import Sequence
import math

from husky_course.frames import Array
from husky_course.outline import Outline
import mujoco
import numpy as np

_DIRECTIONS = 72
_ANGLES = np.arange(_DIRECTIONS) * (math.tau / _DIRECTIONS)
_CIRCLE = np.stack([np.cos(_ANGLES), np.sin(_ANGLES)], axis=1)
_ROUND = 0.02  # how far a circle may be from round, as a part of its radius
_UPRIGHT_RAD = 0.15  # a body tilted less than this is seen along its own axis
_FULL = 0.9  # of a rectangle, which is filled enough to be seen as a whole
_ENDLESS_M = 50.0  # half of how long a plane without a size is on a map
_THIN_M = 0.001  # half of its thickness, which must not be nothing
_MOST_PARTS = 5000  # of an obstacle; a record holds 10 000 outlines


def outlines_of(
    name: str, model: mujoco.MjModel, data: mujoco.MjData, geoms: Sequence[int], *, body: int
) -> list[Outline]:
    """
    Measure an obstacle as a whole, or each geom where the whole is mostly empty.

    So a robot can be between the walls of one body, or pass the gate in it.
    """
    origin, axes = data.xpos[body], data.xmat[body]
    reaches = _reaches(model, data, geoms, origin, axes)
    whole = _outline(name, np.max(reaches, axis=0), origin, axes)
    if len(geoms) > _MOST_PARTS:
        return [whole]
    parts = [
        min(
            _outline(name, reach, origin, axes),
            _outline_along_itself(name, model, data, geom),
            key=_area_m2,
        )
        for geom, reach in zip(geoms, reaches, strict=True)
    ]
    return parts if sum(map(_area_m2, parts)) < _FULL * _area_m2(whole) else [whole]


def _area_m2(outline: Outline) -> float:
    return math.pi * outline.size[0] ** 2 if outline.type == 'circle' else math.prod(outline.size)


def lowest_m(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> float:
    """Return the height of the lowest point of a geom."""
    return -float(_reach(model, data, geom, np.zeros(3), np.array([[0.0, 0.0, -1.0]]))[0])


def highest_m(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> float:
    """Return the height of the highest point of a geom, infinite of a plane that is inclined."""
    kind, shape = mujoco.mjtGeom, int(model.geom_type[geom])
    if shape in (kind.mjGEOM_PLANE, kind.mjGEOM_HFIELD):
        if data.geom_xmat[geom][8] < 1.0 - 1e-9:
            return math.inf
        field = int(model.geom_dataid[geom])
        above = model.hfield_size[field][2] if shape == kind.mjGEOM_HFIELD else 0.0
        return float(data.geom_xpos[geom][2] + above)
    return float(_reach(model, data, geom, np.zeros(3), np.array([[0.0, 0.0, 1.0]]))[0])


def outline_of(
    name: str, model: mujoco.MjModel, data: mujoco.MjData, geoms: Sequence[int], *, body: int
) -> Outline:
    """Measure the outline of some geoms that stand in data as they do in the world."""
    origin, axes = data.xpos[body], data.xmat[body]
    reaches = _reaches(model, data, geoms, origin, axes)
    return _outline(name, np.max(reaches, axis=0), origin, axes)


def outline_of_flex(
    name: str, model: mujoco.MjModel, data: mujoco.MjData, flex: int, *, below_m: float
) -> Outline | None:
    """
    Measure a soft body as it stands in data: the rectangle around it.

    :return: None of one that touches nothing, or whose lowest point is above below_m.
    """
    first = model.flex_vertadr[flex]
    points = data.flexvert_xpos[first : first + model.flex_vertnum[flex]]
    radius_m = float(model.flex_radius[flex])
    low, high = points.min(axis=0) - radius_m, points.max(axis=0) + radius_m
    collides = (model.flex_contype[flex] | model.flex_conaffinity[flex]) & 1
    if not collides or low[2] >= below_m:
        return None
    x, y, _ = ((low + high) / 2.0).tolist()
    size = (float(high[0] - low[0]), float(high[1] - low[1]))
    return Outline(name=name, x=x, y=y, yaw=0.0, size=size)


def _outline_along_itself(
    name: str, model: mujoco.MjModel, data: mujoco.MjData, geom: int
) -> Outline:
    """Measure the outline of a geom along its own axes."""
    origin, axes = data.geom_xpos[geom], data.geom_xmat[geom]
    (reach,) = _reaches(model, data, [geom], origin, axes)
    return _outline(name, reach, origin, axes)


def _reaches(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    geoms: Sequence[int],
    origin: Array,
    axes: Array,
) -> list[Array]:
    """Return how far each geom reaches from origin, all around along these axes."""
    yaw, is_upright = _yaw_of(axes)
    frame = axes.reshape(3, 3) if is_upright else _about_z(yaw)
    directions = _CIRCLE @ frame[:, :2].T
    return [_reach(model, data, geom, origin, directions) for geom in geoms]


def _yaw_of(axes: Array) -> tuple[float, bool]:
    """Return to where axes point, and whether they are upright."""
    turn = axes.reshape(3, 3)
    yaw = math.atan2(turn[1, 0], turn[0, 0])
    return yaw, math.acos(max(-1.0, min(1.0, float(turn[2, 2])))) <= _UPRIGHT_RAD


def _outline(name: str, reach: Array, origin: Array, axes: Array) -> Outline:
    """Return the outline of what reaches so far all around along these axes."""
    yaw, _ = _yaw_of(axes)
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
    if shape == kind.mjGEOM_PLANE:  # as far as it is drawn
        size = np.array([size[0] or _ENDLESS_M, size[1] or _ENDLESS_M, _THIN_M])
    return middle + np.abs(local) @ size
