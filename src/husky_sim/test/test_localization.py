# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The filter behind odometry/filtered."""

from collections.abc import Callable
import math

from husky_sim.localization import PlanarFilter
from husky_sim.simulation import Simulation
import numpy as np
import pytest

from husky_sim.config import RobotStart, SensorConfig, SimulationConfig

Drive = Callable[..., None]
PERIOD_SEC = 0.02


def feed(estimate: PlanarFilter, speed: float, rate: float, count: int) -> None:
    for step in range(1, count + 1):
        estimate.update(
            wheel_speed_m_s=speed,
            wheel_yaw_rate_rad_s=rate,
            imu_yaw=rate * step * PERIOD_SEC,
            imu_yaw_rate_rad_s=rate,
        )


def test_standing_still_leaves_the_estimate_at_the_origin() -> None:
    estimate = PlanarFilter(PERIOD_SEC)
    feed(estimate, 0.0, 0.0, 500)
    assert (estimate.x, estimate.y, estimate.yaw) == (0.0, 0.0, 0.0)


def test_a_steady_circle_is_followed_round() -> None:
    estimate = PlanarFilter(PERIOD_SEC)
    feed(estimate, 0.5, 0.5, round(math.tau / 0.5 / PERIOD_SEC))
    assert math.hypot(estimate.x, estimate.y) < 0.05
    assert estimate.speed_m_s == pytest.approx(0.5)
    assert estimate.yaw_rate_rad_s == pytest.approx(0.5)


def test_the_imu_outweighs_the_wheels_in_turns() -> None:
    estimate = PlanarFilter(PERIOD_SEC)
    for _ in range(100):
        estimate.update(
            wheel_speed_m_s=0.0, wheel_yaw_rate_rad_s=1.0, imu_yaw=0.0, imu_yaw_rate_rad_s=0.0
        )
    assert abs(estimate.yaw) < 0.01


def test_the_heading_counts_from_the_first_of_the_imu() -> None:
    estimate = PlanarFilter(PERIOD_SEC)
    estimate.reset(imu_yaw=3.0)
    estimate.update(
        wheel_speed_m_s=0.0, wheel_yaw_rate_rad_s=0.0, imu_yaw=3.0, imu_yaw_rate_rad_s=0.0
    )
    assert estimate.yaw == pytest.approx(0.0, abs=1e-12)


def test_the_covariance_stays_symmetric_and_positive() -> None:
    estimate = PlanarFilter(PERIOD_SEC)
    feed(estimate, 0.7, -0.9, 3000)
    covariance = estimate.covariance
    assert np.abs(covariance - covariance.T).max() < 1e-9
    assert np.linalg.eigvalsh(covariance).min() > 0.0


def test_the_covariance_tells_how_large_the_true_error_is(worlds: object, drive: Drive) -> None:
    squares = []
    for seed in range(8):
        simulation = Simulation(
            SimulationConfig(
                world=f'{worlds}/empty.xml',
                robots=(RobotStart(),),
                sensors=SensorConfig(noise=True, seed=seed),
            )
        )
        robot = simulation.robots[0]
        for leg in range(15):
            drive(simulation, 0.7 * abs(math.sin(leg / 2)), 0.9 * math.sin(leg), seconds=2.0)
        error = np.array(
            [
                robot.filtered.x - robot.state.position[0],
                robot.filtered.y - robot.state.position[1],
                math.remainder(robot.filtered.yaw - robot.state.yaw, math.tau),
            ]
        )
        squares.append(error @ np.linalg.inv(robot.filtered.covariance[:3, :3]) @ error)
    # Three for a covariance that is just right; chi square of 24 degrees of freedom gives
    # 0.9 to 6.6 in 999 of 1000 cases. The drift is not white, so we allow somewhat more.
    assert 0.3 < np.mean(squares) < 9.0, squares
