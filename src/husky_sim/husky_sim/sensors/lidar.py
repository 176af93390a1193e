# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The laser scanner in front: the SICK LMS1xx of the original, cast on the CPU.

720 beams over 270 degrees, 0.1 to 30 m, with 1 mm of noise. It stands upright here, at the place
of the original's, which hangs upside down.
"""

import copy
import math

from husky_course.frames import Array
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

_LOOKED_AT = np.array([1, 0, 0, 0, 0, 0], dtype=np.uint8)
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
        # A copy, for its groups of geoms: they say here what beams can reach.
        self._model = copy.copy(model)
        self._data = data
        self._without_box = np.isin(model.geom_type, _WITHOUT_BOX)
        self._base = model.body(f'{name}/base_link').id
        apart_rad = 2.0 * HALF_ANGLE_RAD / max(beams - 1, 1)
        angles = -HALF_ANGLE_RAD + apart_rad * np.arange(beams)
        self._beams = np.stack([np.cos(angles), np.sin(angles), np.zeros(beams)], axis=1)
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
        self._model.geom_group[:] = self._out_of_plane(origin, turn[:, 2])
        mujoco.mj_multiRay(
            self._model,
            self._data,
            origin,
            (self._beams @ turn.T).ravel(),
            _LOOKED_AT,
            True,
            self._base,
            self._hits,
            self._distances,
            None,
            len(self._beams),
            RANGE_MAX_M,
        )
        ranges = self._distances
        if self._noise is not None:
            ranges = ranges + self._noise.sample(period_sec)
        missed = np.logical_or(self._hits < 0, ranges > RANGE_MAX_M)
        ranges = np.where(ranges < RANGE_MIN_M, -math.inf, ranges)
        return np.where(missed, math.inf, ranges).astype(np.float32)

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


def new_noise(seed: list[int], beams: int = BEAMS) -> Noise:
    """Make the noise of a scanner."""
    return Noise(beams, deviation=DEVIATION_M, drift=0.0, seed=seed)
