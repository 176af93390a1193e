# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The laser scanner in front: the SICK LMS1xx of the original, cast on the CPU.

720 beams over 270 degrees, 0.1 to 30 m, with 1 mm of noise. It stands upright here, at the place
of the original's, which hangs upside down.
"""

import math

from husky_course.frames import Array, Indices
import mujoco
import numpy as np
import numpy.typing as npt

from husky_sim.robot.husky import RobotState
from husky_sim.sensors.noise import Noise
from husky_sim.sensors.ray_scene import RayScene

BEAMS = 720
HALF_ANGLE_RAD = 2.35619
ANGLE_INCREMENT_RAD = 2.0 * HALF_ANGLE_RAD / (BEAMS - 1)
RANGE_MIN_M, RANGE_MAX_M = 0.1, 30.0
DEVIATION_M = 0.001
PLACE = (0.337, 0.0, 0.30795)
"""In base_link: on the top plate, in front."""

FRAME = 'front_laser'

_SLACK_M = 1e-3
"""Around the boxes of geoms, many times what rounding adds up to."""

_SLACK_RAD = 1e-6
_PART = 180
"""
So many beams are cast at a time, at nothing but what stands in their angle.

In the playpen that takes 0.7 of the time of all 720 at once; with a third of them a tenth more.
"""

_AXES = np.eye(3)

_WITHOUT_BOX = (
    mujoco.mjtGeom.mjGEOM_PLANE,
    mujoco.mjtGeom.mjGEOM_HFIELD,
    mujoco.mjtGeom.mjGEOM_SDF,
)


class Lidar:
    """Scans what stands around one robot."""

    def __init__(
        self,
        name: str,
        scene: RayScene,
        noise: Noise | None,
        *,
        beams: int = BEAMS,
    ) -> None:
        """
        Prepare.

        :param beams: fewer than the scanner's are as evenly over the same angle, and cost less.
        """
        self._scene, model = scene, scene.model
        # Of the spheres around geoms, and of boxes around their own origins.
        without_box = np.isin(model.geom_type, _WITHOUT_BOX)
        self._reach_m = np.where(without_box, math.inf, model.geom_rbound + _SLACK_M)
        boxes = model.geom_aabb
        self._halves_m = np.abs(boxes[:, :3]) + boxes[:, 3:] + _SLACK_M
        # Not inf: times zero that is nan.
        self._halves_m[without_box] = mujoco.mjMAXVAL
        is_own = model.geom_bodyid == model.body(f'{name}/base_link').id
        self._halves_m[is_own | _invisible(model)] = -mujoco.mjMAXVAL
        apart_rad = 2.0 * HALF_ANGLE_RAD / max(beams - 1, 1)
        angles = -HALF_ANGLE_RAD + apart_rad * np.arange(beams)
        self._beams = np.stack([np.cos(angles), np.sin(angles), np.zeros(beams)], axis=1)
        parts = np.array_split(np.arange(beams), max(beams // _PART, 1))
        self._parts = [slice(part[0], part[-1] + 1) for part in parts]
        rightmost, leftmost = (angles[[part[end] for part in parts]] for end in (0, -1))
        self._middles_rad = ((leftmost + rightmost) / 2.0)[:, np.newaxis]
        self._halves_rad = ((leftmost - rightmost) / 2.0)[:, np.newaxis] + _SLACK_RAD
        self._hits = np.zeros(beams, dtype=np.int32)
        self._distances = np.zeros(beams)
        self._noise = noise

    def scan(self, state: RobotState, period_sec: float) -> npt.NDArray[np.float32]:
        """
        Return the range of every beam, from the right to the left.

        What is out of reach is inf, what is too near -inf (REP-117).
        """
        matrix = np.zeros(9)
        mujoco.mju_quat2Mat(matrix, np.array(state.orientation))
        turn = matrix.reshape(3, 3)
        origin = np.array(state.position) + turn @ np.array(PLACE)
        vectors = self._beams @ turn.T
        self._scene.follow()
        geoms, places_m = self._in_plane(origin, turn)
        for beams, met in zip(self._parts, self._met(geoms, places_m), strict=True):
            self._scene.choose(geoms[met])
            self._scene.cast(origin, vectors[beams], self._hits[beams], self._distances[beams])
        ranges: Array = self._distances
        if self._noise is not None:
            ranges = ranges + self._noise.sample(period_sec)
        missed = np.logical_or(self._hits < 0, ranges > RANGE_MAX_M)
        ranges = np.where(ranges < RANGE_MIN_M, -math.inf, ranges)
        return np.where(missed, math.inf, ranges).astype(np.float32)

    def _in_plane(self, origin: Array, turn: Array) -> tuple[Indices, Array]:
        """
        Return what reaches the plane of the beams, and where it is.

        In the playpen that is one geom of ten.

        :returns: geoms, and their places, in the frame of the scanner.
        """
        up, places_m, axes = turn[:, 2], self._scene.data.geom_xpos, self._scene.data.geom_xmat
        # How far up each axis of a geom goes, by one product of matrices: of all geoms at once it
        # takes less time than to choose some first.
        ups = np.abs(axes @ (up[:, np.newaxis, np.newaxis] * _AXES).reshape(9, 3))
        reaches_m = (ups * self._halves_m) @ np.ones(3)
        geoms = np.flatnonzero(np.abs(places_m @ up - origin @ up) <= reaches_m)
        return geoms, (places_m.take(geoms, 0) - origin) @ turn

    def _met(self, geoms: Indices, places_m: Array) -> npt.NDArray[np.bool_]:
        """Tell for each part of the beams, and each of these geoms, whether they may meet."""
        away_m, reach_m = np.hypot(places_m[:, 0], places_m[:, 1]), self._reach_m.take(geoms)
        beside = away_m > reach_m
        wide_rad = np.full(len(geoms), math.tau)
        np.divide(reach_m, away_m, out=wide_rad, where=beside)
        np.arcsin(wide_rad, out=wide_rad, where=beside)
        turned_rad = np.arctan2(places_m[:, 1], places_m[:, 0]) - self._middles_rad + math.pi
        away_rad = np.abs(np.remainder(turned_rad, math.tau) - math.pi)
        met: npt.NDArray[np.bool_] = away_rad <= self._halves_rad + wide_rad
        return met & (away_m - reach_m <= RANGE_MAX_M)


def _invisible(model: mujoco.MjModel) -> npt.NDArray[np.bool_]:
    """Tell which geoms a ray goes through; a material's colour counts before a geom's."""
    materials, alphas = model.geom_matid, model.geom_rgba[:, 3].copy()
    alphas[materials >= 0] = model.mat_rgba[materials[materials >= 0], 3]
    invisible: npt.NDArray[np.bool_] = alphas == 0.0
    return invisible


def new_noise(seed: list[int], beams: int = BEAMS) -> Noise:
    """Make the noise of a scanner."""
    return Noise(beams, deviation=DEVIATION_M, drift=0.0, seed=seed)
