# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is learned of slip, on a robot of which the truth is known."""

from collections.abc import Iterator
from dataclasses import dataclass
import math
import random

from husky_driver.drive.motion_estimate import MotionEstimate
from husky_driver.drive.slip import Slip
from husky_driver.motion import Command, ImuReading, Odometry
import pytest

PERIOD_SEC = 0.02
GRASS = Slip(pivot_m=0.19, onward_sec=0.035, outward_sec2=0.2, aside_m_s=0.03, yaw_gain=0.8)


@dataclass
class Moment:
    """What a robot measures, and where it is."""

    odometry: Odometry
    reading: ImuReading
    told: Command
    x_m: float = 0.0
    y_m: float = 0.0
    yaw_rad: float = 0.0


def drive(
    slip: Slip,
    seconds: float,
    *,
    noise: float = 0.0,
    drift: float = 0.0,
    rest_sec: float = 0.0,
) -> Iterator[Moment]:
    """
    Drive bends to both sides and turn on the spot, in steady motion at every moment.

    :param noise: of the IMU, in its units.
    :param drift: of odometry's heading, rad/s.
    :param rest_sec: how long it stands before it drives.
    """
    dice = random.Random(5)
    x = y = yaw = rolled_x = rolled_y = wheels = rate = 0.0
    before = (0.0, 0.0)
    for period in range(round(seconds / PERIOD_SEC)):
        now_sec = period * PERIOD_SEC
        on_sec = now_sec - rest_sec
        told = Command(0.6 if on_sec % 8.0 < 6.0 else 0.0, 0.9 * math.sin(on_sec / 1.5))
        if on_sec < 0.0:
            told = Command(0.0, 0.0)
        wheels += (told.speed_m_s - wheels) * 0.1
        rate += (slip.yaw_gain * told.yaw_rate_rad_s - rate) * 0.1
        error = drift * now_sec
        odometry = Odometry(now_sec, rolled_x, rolled_y, yaw - error, wheels, rate)
        ahead, left = slip.velocity(odometry)
        felt = (
            (ahead - before[0]) / PERIOD_SEC - left * rate + 0.006 * bool(noise),
            (left - before[1]) / PERIOD_SEC + ahead * rate - 0.004 * bool(noise),
        )
        before = (ahead, left)
        errors = [dice.gauss(0.0, noise) for _ in range(3)]
        # The IMU's north is not where the drive began to face.
        reading = ImuReading(
            now_sec, yaw + 1.2 + errors[0], felt[0] + errors[1], felt[1] + errors[2]
        )
        yield Moment(odometry, reading, told, x, y, yaw)
        middle = yaw + rate * PERIOD_SEC / 2
        x += (math.cos(middle) * ahead - math.sin(middle) * left) * PERIOD_SEC
        y += (math.sin(middle) * ahead + math.cos(middle) * left) * PERIOD_SEC
        rolled_x += math.cos(middle - error) * wheels * PERIOD_SEC
        rolled_y += math.sin(middle - error) * wheels * PERIOD_SEC
        yaw += rate * PERIOD_SEC


def follow(
    moments: list[Moment], *, late: int = 0, imu: bool = True
) -> tuple[MotionEstimate, list[Odometry]]:
    """Estimate the motion; readings come so many periods late."""
    estimate, found = MotionEstimate(), []
    for number, moment in enumerate(moments):
        if imu and number >= late:
            estimate.add_reading(moments[number - late].reading)
        found.append(estimate.corrected(moment.odometry, moment.told))
    return estimate, found


def off_m(moment: Moment, odometry: Odometry) -> float:
    return math.hypot(odometry.x_m - moment.x_m, odometry.y_m - moment.y_m)


def test_what_the_wheels_do_not_tell_is_learned() -> None:
    moments = list(drive(GRASS, 30.0, noise=0.005))
    estimate, found = follow(moments)
    learned = estimate.slip
    assert learned.pivot_m == pytest.approx(GRASS.pivot_m, abs=0.02)
    assert learned.onward_sec == pytest.approx(GRASS.onward_sec, abs=0.02)
    assert learned.outward_sec2 == pytest.approx(GRASS.outward_sec2, abs=0.05)
    assert learned.aside_m_s == pytest.approx(GRASS.aside_m_s, abs=0.01)
    assert off_m(moments[-1], moments[-1].odometry) > 0.4, 'nothing was to be learned'
    assert max(map(off_m, moments, found)) < 0.06
    assert found[-1].speed_m_s == pytest.approx(GRASS.velocity(moments[-1].odometry)[0], abs=0.02)


def test_a_gap_in_which_the_robot_brakes_costs_little() -> None:
    moments = list(drive(GRASS, 20.0, noise=0.005))
    heard = [each for each in moments if not 6.02 < each.odometry.time_sec < 6.42]
    _, found = follow(heard)
    assert heard[-1].odometry.time_sec - heard[0].odometry.time_sec > 19.0
    assert max(map(off_m, heard, found)) < 0.12


def test_a_heading_that_drifts_is_held_by_that_of_the_imu() -> None:
    moments = list(drive(Slip(), 60.0, noise=0.005, drift=0.005))
    _, found = follow(moments)
    assert abs(moments[-1].odometry.yaw_rad - moments[-1].yaw_rad) > 0.25
    last = math.remainder(found[-1].yaw_rad - moments[-1].yaw_rad, math.tau)
    assert abs(last) < 0.01
    assert off_m(moments[-1], found[-1]) < 0.15


def test_at_rest_a_robot_neither_moves_nor_turns_whatever_the_sensors_say() -> None:
    moments = list(drive(GRASS, 0.5, noise=0.005, drift=0.02, rest_sec=0.5))
    _, found = follow(moments)
    assert moments[-1].odometry.yaw_rad < -0.009, 'odometry turns'
    assert abs(found[-1].yaw_rad) < 0.003
    assert max(map(off_m, moments, found)) < 0.001


def test_the_gain_of_turns_is_learned_from_steady_ones() -> None:
    estimate, told = MotionEstimate(), Command(0.5, 0.5)
    yaw = 0.0
    for period in range(500):
        now_sec = period * PERIOD_SEC
        yaw += 0.6 * PERIOD_SEC
        estimate.add_reading(ImuReading(now_sec, yaw, 0.0, 0.3))
        estimate.corrected(Odometry(now_sec, 0.0, 0.0, yaw, 0.5, 0.6), told)
    assert estimate.slip.yaw_gain == pytest.approx(1.2, abs=0.02)


def test_late_readings_change_nothing() -> None:
    moments = list(drive(GRASS, 10.0, noise=0.005))
    assert follow(moments, late=3)[1][:-3] == follow(moments)[1][:-3]


def test_without_an_imu_it_is_odometry_with_the_slip_of_asphalt() -> None:
    moments = list(drive(Slip(), 20.0))
    estimate, found = follow(moments, imu=False)
    assert estimate.slip == Slip()
    assert max(map(off_m, moments, found)) < 0.03


def test_lost_and_broken_readings_are_passed_over() -> None:
    moments = list(drive(GRASS, 20.0))
    dice = random.Random(3)
    for moment in moments:
        if dice.random() < 0.2:
            moment.reading = moment.reading._replace(left_m_s2=math.nan)
    estimate, found = follow(moments)
    assert all(math.isfinite(value) for value in (*estimate.slip, *found[-1]))
    assert estimate.slip.pivot_m == pytest.approx(GRASS.pivot_m, abs=0.05)


def test_a_gap_in_odometry_costs_nothing_of_the_way() -> None:
    moments = list(drive(Slip(), 12.0))
    kept = moments[:150] + moments[190:]  # 0.8 s at 0.6 m/s
    _, found = follow(kept)
    assert math.dist(*((each.x_m, each.y_m) for each in (moments[150], moments[190]))) > 0.4
    assert max(map(off_m, kept, found)) < 0.03


def test_after_a_reset_the_ground_is_known_and_the_place_is_new() -> None:
    moments = list(drive(GRASS, 20.0))
    estimate, _ = follow(moments)
    learned = estimate.slip
    estimate.restart()
    begun = Odometry(0.0, 3.0, 4.0, 0.5, 0.0, 0.0)
    assert estimate.corrected(begun, Command(0.0, 0.0)) == begun
    assert estimate.slip == learned


@pytest.mark.parametrize(
    ('speed', 'rate', 'outward'), [(0.5, 0.2, -1), (0.5, -0.2, 1), (-0.5, 0.2, 1)]
)
def test_in_a_bend_the_slip_is_onward_and_outward(speed: float, rate: float, outward: int) -> None:
    ahead, left = Slip(0.0, 0.04, 0.1).velocity(Odometry(0.0, 0.0, 0.0, 0.0, speed, rate))
    assert ahead == pytest.approx(speed * 1.008)
    assert left == pytest.approx(outward * 0.1 * 0.504 * 0.04)


@pytest.mark.parametrize(('speed', 'rate'), [(0.8, 0.0), (0.0, 1.5)])
def test_straight_on_or_on_the_spot_nothing_is_added(speed: float, rate: float) -> None:
    assert Slip().velocity(Odometry(0.0, 0.0, 0.0, 0.0, speed, rate)) == (speed, 0.0)


@pytest.mark.parametrize('wish', [Command(0.5, 0.0), Command(0.0, 1.0), Command(-0.4, -0.6)])
def test_a_command_is_what_makes_the_robot_do_as_wished(wish: Command) -> None:
    speed, rate = GRASS.command(wish)
    turned = rate * GRASS.yaw_gain
    ahead, _ = GRASS.velocity(Odometry(0.0, 0.0, 0.0, 0.0, speed, turned))
    assert (ahead, turned) == pytest.approx(wish)
