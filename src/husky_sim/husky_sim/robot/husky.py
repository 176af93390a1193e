# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A Husky in the physics: its wheels, its true state and its specific force."""

import math
from typing import NamedTuple

from husky_course.frames import Array
import mujoco
import numpy as np

from husky_sim.robot.diff_drive import limited

WHEELS = ('front_left', 'front_right', 'rear_left', 'rear_right')
JOINTS = tuple(f'{wheel}_wheel_joint' for wheel in WHEELS)

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
TorqueRange = tuple[float, float]
"""Least and greatest, N m."""

CHAIN_N_M_RAD, CHAIN_N_M_S_RAD = 1500.0, 40.0
"""Stiffness and damping between the wheels of a side: what physics steps of 4 ms bear."""

_TURNED_OVER = math.sin(math.radians(75.0) / 2.0) ** 2
"""x2 + y2 of the quaternion: of an inclination that it does not come back from."""


class RobotState(NamedTuple):
    """
    The true state of a robot, in metres, radians and seconds.

    Position and orientation are in the frame `world`; the twist is in base_link, as REP-103 and
    nav_msgs/Odometry want it. The quaternion is w, x, y, z.
    """

    position: Vector
    orientation: Quaternion
    velocity: Vector
    angular_velocity: Vector

    @property
    def yaw(self) -> float:
        """Return the heading, from -pi to pi."""
        w, x, y, z = self.orientation
        return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))

    @property
    def is_turned_over(self) -> bool:
        """Whether it lies on a side or on its top, where its wheels do not carry it."""
        _, x, y, _ = self.orientation
        return x * x + y * y > _TURNED_OVER


class WheelState(NamedTuple):
    """Angles, speeds and torques of the four wheels, in the order of JOINTS."""

    angles_rad: tuple[float, ...]
    speeds_rad_s: tuple[float, ...]
    torques_n_m: tuple[float, ...]

    @property
    def left_rad(self) -> float:
        """Return the mean angle of the left wheels."""
        return (self.angles_rad[0] + self.angles_rad[2]) / 2.0

    @property
    def right_rad(self) -> float:
        """Return the mean angle of the right wheels."""
        return (self.angles_rad[1] + self.angles_rad[3]) / 2.0

    @property
    def side_speeds_rad_s(self) -> tuple[float, float]:
        """Return the mean speeds of the left and of the right wheels."""
        front_left, front_right, rear_left, rear_right = self.speeds_rad_s
        return (front_left + rear_left) / 2.0, (front_right + rear_right) / 2.0

    @property
    def side_torques_n_m(self) -> tuple[float, float]:
        """Return the torques of the left and of the right wheels, added up."""
        front_left, front_right, rear_left, rear_right = self.torques_n_m
        return front_left + rear_left, front_right + rear_right


class Husky:
    """One robot of a world: reads and drives it by the names in husky.xml."""

    def __init__(self, name: str, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.name = name
        base = model.joint(f'{name}/base_joint')
        self._pose = data.qpos[int(base.qposadr[0]) :][:7]
        self._twist = data.qvel[int(base.dofadr[0]) :][:6]
        self._orientation, self._velocity = self._pose[3:], self._twist[:3]
        joints = [model.joint(f'{name}/{joint}') for joint in JOINTS]
        self._angles = [int(joint.qposadr[0]) for joint in joints]
        self._speeds = [int(joint.dofadr[0]) for joint in joints]
        self._actuators = [model.actuator(f'{name}/{wheel}_wheel').id for wheel in WHEELS]
        self._model = model
        self._data = data
        self._tyres = [_shapes_of_tyre(model, f'{name}/{wheel}') for wheel in WHEELS]
        self.gravity: Vector = tuple(model.opt.gravity.tolist())
        # The joints and the actuators of one robot lie side by side, so that slices do.
        self._wheel_angles = _block(data.qpos, self._angles)
        self._wheel_speeds = _block(data.qvel, self._speeds)
        self._torques = _block(data.actuator_force, self._actuators)
        # Into an array, four numbers are written in four times the time.
        self._control = _block(data.ctrl, self._actuators).data.cast('B').cast('d')
        servo = self._actuators[0]
        self._targets = _block(data.act, [int(model.actuator_actadr[i]) for i in self._actuators])
        self._stiffness = float(model.actuator_gainprm[servo, 0])
        self._lag_sec = -float(model.actuator_biasprm[servo, 2]) / self._stiffness
        self._is_limited = False  # by motors, more than the servos are
        self._ranges = _block(model.actuator_forcerange, self._actuators)
        self._torque_limit = float(model.actuator_forcerange[servo, 1])

    def drive(self, left_rad_s: float, right_rad_s: float) -> None:
        """Set the speeds the servos of the wheels aim at."""
        control, limit = self._control, self._torque_limit
        control[0] = control[2] = left_rad_s
        control[1] = control[3] = right_rad_s
        torques = self._torques.tolist()
        if self._is_limited or max(torques) >= limit or min(torques) <= -limit:
            self._unwind()

    def limit(self, left: TorqueRange, right: TorqueRange) -> None:
        """
        Let the wheels of each side together have no more torque, from the next step on.

        Each has half of it, and what a chain between the two takes from the one for the other.
        """
        self._is_limited = True
        pulls = CHAIN_N_M_RAD * self._wheel_angles + CHAIN_N_M_S_RAD * self._wheel_speeds
        front_left, front_right, rear_left, rear_right = pulls.tolist()
        chain_left, chain_right = rear_left - front_left, rear_right - front_right
        self._ranges[:] = (
            self._part_of(left, chain_left),
            self._part_of(right, chain_right),
            self._part_of(left, -chain_left),
            self._part_of(right, -chain_right),
        )

    def _part_of(self, side: TorqueRange, chain_n_m: float) -> TorqueRange:
        limit, (least, most) = self._torque_limit, side
        return limited(least / 2.0 + chain_n_m, limit), limited(most / 2.0 + chain_n_m, limit)

    def _unwind(self) -> None:
        """
        Keep the angle that a servo aims at within the reach of its torque.

        Else a wheel that was held fast would go on turning, to make up for it, after a stop.
        """
        reached = self._wheel_angles + self._lag_sec * self._wheel_speeds
        least, most = (self._ranges / self._stiffness).T
        self._targets[:] = np.clip(self._targets, reached + least, reached + most)

    def state(self) -> RobotState:
        """Read the true pose and twist."""
        x, y, z, qw, qx, qy, qz = self._pose.tolist()
        vx, vy, vz, wx, wy, wz = self._twist.tolist()
        orientation = (qw, qx, qy, qz)
        return RobotState(
            (x, y, z), orientation, into_body(orientation, (vx, vy, vz)), (wx, wy, wz)
        )

    def wheels(self) -> WheelState:
        """Read the wheels."""
        return WheelState(
            tuple(self._wheel_angles.tolist()),
            tuple(self._wheel_speeds.tolist()),
            tuple(self._torques.tolist()),
        )

    def wheel_loads_n(self) -> tuple[float, ...]:
        """Return the contact force on each wheel."""
        loads = [0.0] * len(WHEELS)
        force = np.zeros(6)
        for index, pair in enumerate(self._data.contact.geom.tolist()):
            mujoco.mj_contactForce(self._model, self._data, index, force)
            for wheel, tyre in enumerate(self._tyres):
                if not tyre.isdisjoint(pair):
                    loads[wheel] += float(force[0])
        return tuple(loads)

    def world_velocity(self) -> Vector:
        """Return the velocity of base_link along the axes of the world, in m/s."""
        vx, vy, vz = self._velocity.tolist()
        return vx, vy, vz

    def specific_force(self, before: Vector, after: Vector, period_sec: float) -> Vector:
        """
        Return the specific force at base_link, in m/s2, in base_link.

        It is the mean over the time from one world velocity to the next: an IMU, too, filters the
        vibration of contacts out of samples 20 ms apart.
        """
        gravity = self.gravity
        return into_body(
            tuple(self._orientation.tolist()),  # type: ignore[arg-type]
            (
                (after[0] - before[0]) / period_sec - gravity[0],
                (after[1] - before[1]) / period_sec - gravity[1],
                (after[2] - before[2]) / period_sec - gravity[2],
            ),
        )


def _shapes_of_tyre(model: mujoco.MjModel, wheel: str) -> set[int]:
    """Return the geoms; MuJoCo leaves out a tread where no ground is flat."""
    names = (f'{wheel}_wheel', f'{wheel}_tread')
    found = {mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, name) for name in names}
    return found - {-1}


def _block(values: Array, indices: list[int]) -> Array:
    """Return a view on consecutive entries."""
    if indices != list(range(indices[0], indices[0] + len(indices))):
        raise RuntimeError(f'the wheels lie apart in the model: {indices}')
    return values[indices[0] : indices[0] + len(indices)]


def into_body(orientation: Quaternion, vector: Vector) -> Vector:
    """Turn a vector of the world into the axes of a body."""
    w, x, y, z = orientation
    a, b, c = vector
    # v' = v + 2 u x (u x v + w v), with u the conjugate's vector part.
    tx = -(y * c - z * b) + w * a
    ty = -(z * a - x * c) + w * b
    tz = -(x * b - y * a) + w * c
    return (
        a - 2.0 * (y * tz - z * ty),
        b - 2.0 * (z * tx - x * tz),
        c - 2.0 * (x * ty - y * tx),
    )
