# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The filter behind odometry/filtered."""

from collections.abc import Callable
import math
from pathlib import Path

from husky_sim.sensors.imu import disturbed, new_noise
from husky_sim.sensors.localization import PlanarFilter
from husky_sim.simulation import SimulatedRobot, Simulation
import numpy as np
import pytest

from husky_sim.config import SimulationConfig

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


def squared_error(estimate: PlanarFilter, robot: SimulatedRobot) -> float:
    """Return the squared error of the pose, in deviations of the filter."""
    error = np.array(
        [
            estimate.x - robot.state.position[0],
            estimate.y - robot.state.position[1],
            math.remainder(estimate.yaw - robot.state.yaw, math.tau),
        ]
    )
    return float(error @ np.linalg.inv(estimate.covariance[:3, :3]) @ error)


def test_the_covariance_tells_how_large_the_true_error_is(worlds: Path, drive: Drive) -> None:
    # The noise has no influence on the physics, so that one drive serves many IMUs.
    simulation = Simulation(SimulationConfig(world=str(worlds / 'empty.xml')))
    robot = simulation.robots[0]
    noises = [new_noise([seed, 0]) for seed in range(8)]
    estimates = [PlanarFilter(PERIOD_SEC) for _ in noises]
    squares = []
    for period in range(1500):
        speed, rate = 0.7 * abs(math.sin(period // 100 / 2)), 0.9 * math.sin(period // 100)
        drive(simulation, speed, rate, seconds=PERIOD_SEC)
        for estimate, noise in zip(estimates, noises, strict=True):
            imu = disturbed(robot.imu, noise, PERIOD_SEC)
            estimate.update(
                wheel_speed_m_s=robot.odometry.speed_m_s,
                wheel_yaw_rate_rad_s=robot.odometry.yaw_rate_rad_s,
                imu_yaw=imu.yaw,
                imu_yaw_rate_rad_s=imu.angular_velocity[2],
            )
        if period % 250 == 249:
            squares += [squared_error(estimate, robot) for estimate in estimates]
    # Three on average where the covariance is just right. Less is caution; 7.81 is the 95 %
    # limit of chi square with three degrees of freedom.
    assert 0.3 < np.mean(squares) < 4.0, squares
    assert np.mean(np.array(squares) < 7.81) >= 0.9, squares
