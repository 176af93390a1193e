# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
How the tyres meet the ground.

A tyre has two shapes. On flat ground its tread counts, a capsule that grips along and across
differently (see `world.flat_ground`); everywhere else, at edges and on hills, the wheel, a
cylinder that grips as much in every direction. What is no ground meets the cylinder, always. Both
have the same radius and stand on the same two points, and so change places unnoticed.

From 4.0 on MuJoCo gives contacts of cylinders several points, some of them on the wrong face of
the other shape, up to a metre deep, which throw the robot (its sources of September 2026 mend
that). So contacts have one point while a wheel touches as a cylinder, and several else: by one
alone a barrel on a box would never come to rest.
"""

from husky_course.frames import Indices
import mujoco
import numpy as np

from husky_sim.config import Floor
from husky_sim.robot.husky import WHEELS
from husky_sim.world.flat_ground import NEVER_M, pair_name
from husky_sim.world.world import World

REACH_M = 0.6
"""From base_link to the outermost place of a tyre, and what a robot goes in a control period."""
UPRIGHT = 0.99
"""Cosine of a lean, above which the ends of a tread are within 2 mm of those of the cylinder."""
BELOW_M, ABOVE_M = 0.1, 0.75

_SOLID, _EVERYWHERE = 1 << 30, (1 << 30) | 1
_ONE_POINT = int(mujoco.mjtDisableBit.mjDSBL_MULTICCD)
_AGAIN_PERIODS = 50  # a wheel that bounces off an obstacle, or is driven back, meets it again


class Tyres:
    """Chooses, before every control period, the shapes of tyres that count."""

    def __init__(self, world: World, data: mujoco.MjData, floor: Floor) -> None:
        model = world.model
        self._model, self._data = model, data
        # Unpacked at once: every robot asks for all of them in every control period.
        self._faces = [(face.middle, *face.axes, face.half_m) for face in world.flat_ground]
        names = [robot.name for robot in world.robots]
        joints = [model.joint(f'{name}/base_joint') for name in names]
        self._poses = [data.qpos[int(joint.qposadr[0]) :][:7] for joint in joints]
        self._wheels = [
            [model.geom(f'{name}/{wheel}_wheel').id for wheel in WHEELS] for name in names
        ]
        wheels = np.array(self._wheels).ravel()
        self._flags, self._has_one_point = int(model.opt.disableflags), False
        self._is_wheel = np.zeros(model.ngeom + 1, dtype=np.bool_)  # the last: -1, no geom
        self._is_wheel[wheels] = True
        # What is no ground meets wheels by a bit of its own: theirs of ground comes and goes.
        # So does ground without a flat face, as a ramp on a plane, above which treads count.
        solid = (world.owners >= 0) & ~np.isin(np.arange(model.ngeom), wheels)
        solid[list(world.uneven_ground)] = True
        self._is_uneven = bool(world.uneven_ground)
        model.geom_conaffinity[solid] |= _SOLID
        model.body_conaffinity[model.geom_bodyid[solid]] |= _SOLID
        soft = (model.flex_contype | model.flex_conaffinity) & 1 != 0  # not what is only seen
        model.flex_conaffinity[soft] |= _SOLID  # ground, too: treads do not know it
        model.body_contype[model.geom_bodyid[wheels]] |= _SOLID
        model.body_conaffinity[model.geom_bodyid[wheels]] |= _SOLID
        self._pairs = [self._pairs_of(name) for name in names]
        self._grip(wheels, floor)
        self.reset()

    def _pairs_of(self, name: str) -> Indices:
        """Return the contacts of a robot's treads: a row for each face."""
        model = self._model
        pairs = [
            [model.pair(pair_name(number, name, wheel)).id for wheel in WHEELS]
            for number, _ in enumerate(self._faces)
        ]
        return np.array(pairs, dtype=np.int64).reshape(-1, len(WHEELS))

    def _grip(self, wheels: Indices, floor: Floor) -> None:
        """Make the friction of the robot's file that of a floor."""
        self._model.geom_friction[wheels, 0] *= floor.along
        for pairs in self._pairs:
            self._model.pair_friction[pairs, 0] *= floor.across
            self._model.pair_friction[pairs, 1] *= floor.along

    def reset(self) -> None:
        """Look again where every robot is; to be called when they were put somewhere else."""
        self._under: list[tuple[int, ...] | None] = [(-1,)] * len(self._poses)
        self._periods_after_touch = _AGAIN_PERIODS
        self.update()

    def update(self) -> None:
        """Choose for the coming control period."""
        for robot, pose in enumerate(self._poses):
            under = self._faces_under(*pose.tolist())
            if under != self._under[robot]:
                self._under[robot] = under
                self._choose(robot, under)
        self._periods_after_touch += 1
        self._choose_points()

    def meet_obstacles(self) -> None:
        """Look whether wheels touch something; to be called after a step in which a robot does."""
        if self._is_wheel[self._data.contact.geom].any():
            self._periods_after_touch = 0
            self._choose_points()

    def _choose_points(self) -> None:
        one = self._is_uneven or None in self._under or self._periods_after_touch < _AGAIN_PERIODS
        if one != self._has_one_point:
            self._has_one_point = one
            self._model.opt.disableflags = self._flags | _ONE_POINT if one else self._flags

    def _choose(self, robot: int, under: tuple[int, ...] | None) -> None:
        bits = _EVERYWHERE if under is None else _SOLID
        self._model.geom_contype[self._wheels[robot]] = bits
        self._model.geom_conaffinity[self._wheels[robot]] = bits
        self._model.pair_margin[self._pairs[robot]] = NEVER_M
        if under:
            self._model.pair_margin[self._pairs[robot][list(under)]] = 0.0

    def _faces_under(
        self, x: float, y: float, z: float, qw: float, qx: float, qy: float, qz: float
    ) -> tuple[int, ...] | None:
        """Return the faces that a robot is above with all wheels; None beside an edge."""
        up_x, up_y = 2 * (qx * qz + qw * qy), 2 * (qy * qz - qw * qx)
        up_z = 1 - 2 * (qx * qx + qy * qy)
        under = []
        for number, (middle, along, across, normal, half_m) in enumerate(self._faces):
            (mx, my, mz), (nx, ny, nz) = middle, normal
            dx, dy, dz = x - mx, y - my, z - mz
            if not -BELOW_M < dx * nx + dy * ny + dz * nz < ABOVE_M:
                continue
            # How far inside the nearest edge; negative outside.
            inside_m = min(
                half_m[0] - abs(dx * along[0] + dy * along[1] + dz * along[2]),
                half_m[1] - abs(dx * across[0] + dy * across[1] + dz * across[2]),
            )
            if inside_m < -REACH_M:
                continue
            if inside_m < REACH_M or up_x * nx + up_y * ny + up_z * nz < UPRIGHT:
                return None
            under.append(number)
        return tuple(under) or None
