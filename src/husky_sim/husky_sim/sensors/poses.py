# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Where everything is at the time of a measurement, for what looks at it.

In a simulation's own data all geoms and cameras are where they were before the last step of
physics, and before the first one nowhere.
"""

import mujoco


def follow(moved: mujoco.MjData, model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """
    Put every geom and body into the pose that it has in a simulation now.

    :param moved: the simulation's.
    :param model: of the same bodies, `data` of it.
    """
    data.qpos[:] = moved.qpos
    data.mocap_pos[:], data.mocap_quat[:] = moved.mocap_pos, moved.mocap_quat
    mujoco.mj_kinematics(model, data)
