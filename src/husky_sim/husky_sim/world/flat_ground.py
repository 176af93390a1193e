# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Flat ground, on which tyres grip along and across differently.

MuJoCo gives a contact one friction for each of two directions. Which these are it lets the shapes
choose, and only a capsule on a plane chooses well: across is where its axis points. So every tyre
has a second shape, a capsule that touches nothing but the planes made here: one in each plane of
the world that is ground, and one in the top of each box that is. `robot.tyres` says when they
count.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import mujoco
import numpy as np

from husky_sim.errors import WorldError

WHEELS = ('front_left', 'front_right', 'rear_left', 'rear_right')
NEVER_M = -1e9
"""The margin of a contact that does not count: no tread is so deep under an endless plane."""

UPWARDS = 0.5
"""Cosine of the steepest face that one drives on."""


@dataclass(frozen=True)
class FlatGround:
    """A face to drive on: metres, in the frame `world`."""

    middle: tuple[float, ...]
    axes: tuple[tuple[float, ...], ...]  # its x, its y and its normal
    half_m: tuple[float, float]  # along x and y; inf: endless


def is_flat_ground(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> bool:
    """Tell whether a geom that is ground has a face that treads can touch."""
    if model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_OVERRIDE:
        return False  # every contact has the world's margin and friction
    belts = getattr(model, 'geom_surfacevel', np.zeros((model.ngeom, 1)))
    if belts[geom].any():
        return False  # a plane made here would stand still
    kind = int(model.geom_type[geom])
    is_up = bool(data.geom_xmat[geom][8] >= UPWARDS)
    return is_up and kind in (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_BOX)


def find_flat_ground(
    model: mujoco.MjModel, data: mujoco.MjData, ground: Iterable[int]
) -> tuple[FlatGround, ...]:
    """Return the faces of the geoms that are ground, other than those too steep."""
    found = []
    for geom in ground:
        if not is_flat_ground(model, data, geom):
            continue
        axes, middle = data.geom_xmat[geom].reshape(3, 3).T, data.geom_xpos[geom]
        half_m = (np.inf, np.inf)
        if int(model.geom_type[geom]) == mujoco.mjtGeom.mjGEOM_BOX:
            x, y, z = model.geom_size[geom].tolist()
            half_m, middle = (x, y), middle + z * axes[2]
        found.append(FlatGround(tuple(middle.tolist()), tuple(map(tuple, axes.tolist())), half_m))
    return tuple(found)


def add_planes(spec: mujoco.MjSpec, faces: Iterable[FlatGround]) -> None:
    """Add the planes that treads touch; nothing else does, and nobody sees them."""
    for number, face in enumerate(faces):
        spec.worldbody.add_geom(
            name=_plane(number),
            type=mujoco.mjtGeom.mjGEOM_PLANE,
            size=[1.0, 1.0, 1.0],
            pos=face.middle,
            zaxis=face.axes[2],
            contype=0,
            conaffinity=0,
            group=5,
            rgba=[0.0, 0.0, 0.0, 0.0],
        )


def add_contacts(spec: mujoco.MjSpec, husky: str, robot: str, faces: Iterable[FlatGround]) -> None:
    """
    Let the treads of a robot touch the planes, once `robot.tyres` says so.

    :param husky: the robot's file, for the message.
    :raises WorldError: if the robot has no treads.
    """
    for number, _ in enumerate(faces):
        for wheel in WHEELS:
            tread = spec.geom(f'{robot}/{wheel}_tread')
            if tread is None:
                raise WorldError(
                    f'{husky!r}: no geom named {wheel}_tread; take the husky.xml that came with us'
                )
            spec.add_pair(
                name=pair_name(number, robot, wheel),
                geomname1=_plane(number),
                geomname2=tread.name,
                condim=3,
                margin=NEVER_M,
                friction=[tread.friction[0], *tread.friction[[0, 1, 2, 2]]],
                solref=tread.solref,
                solimp=tread.solimp,
            )


def pair_name(face: int, robot: str, wheel: str) -> str:
    """Return the name of the contact of a tread with a face of the world's flat ground."""
    return f'{robot}/{wheel}_tread on {_plane(face)}'


def _plane(number: int) -> str:
    return f'flat ground {number}'
