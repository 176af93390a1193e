# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The laser scanner in front: the SICK LMS1xx of the original, cast on the CPU.

720 beams over 270 degrees, 0.1 to 30 m, with 1 mm of noise. It stands upright here, at the place
of the original's, which hangs upside down.
"""

import copy
import math

from husky_course.frames import Array, Indices
import mujoco
import numpy as np
import numpy.typing as npt

from husky_sim.robot.husky import RobotState
from husky_sim.sensors.noise import Noise

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
_PART = 240
"""
So many beams are cast at a time, at nothing but what stands in their angle.

In the playpen that takes three quarters of the time of all 720 at once, and with ten robots 0.6 of
it. With half as many beams it saves nothing.
"""

_LOOKED_AT = np.array([1, 0, 0, 0, 0, 0], dtype=np.uint8)
_WITHOUT_BOX = (
    mujoco.mjtGeom.mjGEOM_PLANE,
    mujoco.mjtGeom.mjGEOM_HFIELD,
    mujoco.mjtGeom.mjGEOM_SDF,
)


class _Part:
    """
    Beams side by side.

    :param right_rad: the direction of the first of them, as of the last.
    """

    def __init__(self, beams: slice, right_rad: float, left_rad: float) -> None:
        self.beams = beams
        self._middle_rad = (right_rad + left_rad) / 2.0
        self._half_rad = (left_rad - right_rad) / 2.0 + _SLACK_RAD

    def meets(self, bearings_rad: Array, wide_rad: Array) -> npt.NDArray[np.bool_]:
        """Tell for each place whether beams can meet what reaches so far around it."""
        away_rad = np.remainder(bearings_rad - self._middle_rad + math.pi, math.tau) - math.pi
        met: npt.NDArray[np.bool_] = np.abs(away_rad) <= self._half_rad + wide_rad
        return met


class Lidar:
    """Scans what stands around one robot."""

    def __init__(
        self,
        name: str,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        noise: Noise | None,
        *,
        beams: int = BEAMS,
    ) -> None:
        """
        Prepare.

        :param beams: fewer than the scanner's are as evenly over the same angle, and cost less.
        """
        # A copy: its groups of geoms, and which geoms a body has, say here what beams can reach.
        self._model = copy.copy(model)
        self._data = data
        self._groups = self._model.geom_group
        self._first_geoms, self._geoms = self._model.body_geomadr, self._model.body_geomnum
        self._spheres = self._model.body_bvhadr
        self._all_spheres = model.body_bvhadr.copy()
        self._bodies = model.geom_bodyid
        self._without_box = np.isin(model.geom_type, _WITHOUT_BOX)
        self._base = model.body(f'{name}/base_link').id
        self._is_own = self._bodies == self._base
        self._reach_m = model.geom_rbound + _SLACK_M
        apart_rad = 2.0 * HALF_ANGLE_RAD / max(beams - 1, 1)
        angles = -HALF_ANGLE_RAD + apart_rad * np.arange(beams)
        self._beams = np.stack([np.cos(angles), np.sin(angles), np.zeros(beams)], axis=1)
        self._parts = [
            _Part(slice(part[0], part[-1] + 1), angles[part[0]], angles[part[-1]])
            for part in np.array_split(np.arange(beams), max(beams // _PART, 1))
        ]
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
        self._groups[:] = out = self._out_of_plane(origin, turn[:, 2])
        vectors = self._beams @ turn.T
        if len(self._parts) == 1:
            self._cast(origin, vectors, self._parts[0].beams)
        else:
            geoms = np.flatnonzero(~(out | self._is_own))
            bearings_rad, wide_rad = self._seen_from(origin, turn, geoms)
            for part in self._parts:
                self._leave_only(geoms[part.meets(bearings_rad, wide_rad)])
                self._cast(origin, vectors, part.beams)
        ranges: Array = self._distances
        if self._noise is not None:
            ranges = ranges + self._noise.sample(period_sec)
        missed = np.logical_or(self._hits < 0, ranges > RANGE_MAX_M)
        ranges = np.where(ranges < RANGE_MIN_M, -math.inf, ranges)
        return np.where(missed, math.inf, ranges).astype(np.float32)

    def _cast(self, origin: Array, vectors: Array, beams: slice) -> None:
        mujoco.mj_multiRay(
            self._model,
            self._data,
            origin,
            vectors[beams].ravel(),
            _LOOKED_AT,
            True,
            self._base,
            self._hits[beams],
            self._distances[beams],
            None,
            beams.stop - beams.start,
            RANGE_MAX_M,
        )

    def _out_of_plane(self, origin: Array, normal: Array) -> npt.NDArray[np.bool_]:
        """
        Tell for each geom whether all of it is above or below the plane of the beams.

        In the playpen that is nine geoms of ten, and four tenths of the time of all beams.
        """
        data, boxes = self._data, self._model.geom_aabb
        # einsum: of so few numbers a product of matrices, or a sum, takes twice as long.
        axes = np.einsum('i,nij->nj', normal, data.geom_xmat.reshape(-1, 3, 3))
        middle_m = (data.geom_xpos - origin) @ normal
        middle_m += np.einsum('nj,nj->n', axes, boxes[:, :3])
        half_m = np.einsum('nj,nj->n', np.abs(axes), boxes[:, 3:]) + _SLACK_M
        out: npt.NDArray[np.bool_] = (np.abs(middle_m) > half_m) & ~self._without_box
        return out

    def _seen_from(self, origin: Array, turn: Array, geoms: Indices) -> tuple[Array, Array]:
        """Return in which direction of the plane each geom lies, and half its width, in rad."""
        places = (self._data.geom_xpos[geoms] - origin) @ turn
        away_m, reach_m = np.hypot(places[:, 0], places[:, 1]), self._reach_m[geoms]
        everywhere = (away_m <= reach_m) | self._without_box[geoms]
        wide_rad = np.arcsin(reach_m / np.maximum(away_m, reach_m))
        return np.arctan2(places[:, 1], places[:, 0]), np.where(everywhere, math.tau, wide_rad)

    def _leave_only(self, geoms: Indices) -> None:
        """
        Let each body have its first of these geoms, its last, and those between; others none.

        MuJoCo asks each beam about every geom of a body, and before about a sphere around them.
        """
        bodies = self._bodies[geoms]
        self._geoms[:], self._spheres[:] = 0, -1
        self._first_geoms[bodies[::-1]] = geoms[::-1]  # of one body, the last written stays
        self._geoms[bodies] = geoms - self._first_geoms[bodies] + 1
        self._spheres[bodies] = self._all_spheres[bodies]


def new_noise(seed: list[int], beams: int = BEAMS) -> Noise:
    """Make the noise of a scanner."""
    return Noise(beams, deviation=DEVIATION_M, drift=0.0, seed=seed)
