# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import math

from husky_course.route import A200_LIMITS, DriveLimits, LIMITS, plan_route
from husky_course.route.path import smooth_curve
from husky_course.waypoints import parse_course
from husky_driver.checks.path_scan import (
    FRONT_M,
    HALF_WIDTH_M,
    LASER_X_M,
    look_along,
    Scan,
    Sighting,
)
from husky_driver.drive.drive import Drive
from husky_driver.motion import Odometry
from husky_driver.obstacle_stop import ObstacleStop
import pytest

BEAMS, FIRST = 721, -math.pi / 2
STEP = math.pi / 720
LINE = smooth_curve([(0.0, 0.0), (10.0, 0.0)])


def scan_of(*points: tuple[float, float]) -> list[float]:
    """Return the ranges of a laser at the origin's robot that sees only these places."""
    ranges = [math.inf] * BEAMS
    for x, y in points:
        beam = round((math.atan2(y, x - LASER_X_M) - FIRST) / STEP)
        ranges[beam] = math.hypot(x - LASER_X_M, y)
    return ranges


def seen(ranges: list[float], speed_m_s: float = 0.8) -> Sighting | None:
    return look_along(Scan(0.0, ranges, FIRST, STEP), (0.0, 0.0, 0.0), LINE, 0.0, speed_m_s)


def test_a_free_path_is_not_seen() -> None:
    assert seen([math.inf] * BEAMS) is None
    assert seen([math.nan] * BEAMS) is None
    assert seen([0.0] * BEAMS) is None


def test_something_on_the_path_blocks_it_and_is_described() -> None:
    found = seen(scan_of((1.2, 0.0), (1.2, 0.1), (1.25, 0.2), (1.2, -0.9)))
    assert found is not None
    assert found.ahead_m == pytest.approx(1.2 - FRONT_M, abs=0.01)
    assert (found.x_m, found.y_m) == pytest.approx((1.2, 0.0), abs=0.01)
    assert found.width_m == pytest.approx(0.2, abs=0.02)
    assert str(found) == (
        'something 0.2 m wide stands on the path, 0.71 m ahead near (1.20, 0.00)'
    )


def test_what_is_too_near_to_be_measured_blocks_the_path() -> None:
    ahead, middle = [math.inf] * BEAMS, BEAMS // 2
    ahead[middle - 20 : middle + 20] = [-math.inf] * 40
    found = seen(ahead)
    assert found is not None
    assert found.ahead_m == 0.0
    assert seen([-math.inf] * 20 + [math.inf] * (BEAMS - 20)) is None, 'it is beside the laser'


@pytest.mark.parametrize(('degrees', 'blocks'), [(55, True), (-55, True), (65, False)])
def test_what_is_too_near_counts_to_60_degrees_from_ahead(degrees: int, *, blocks: bool) -> None:
    ranges = [math.inf] * BEAMS
    ranges[BEAMS // 2 + 4 * degrees] = -math.inf
    assert (seen(ranges) is not None) is blocks


@pytest.mark.parametrize(('apart_m', 'width_m'), [(0.19, 0.19), (0.21, 0.0)])
def test_what_is_farther_apart_than_20_cm_is_another_obstacle(
    apart_m: float, width_m: float
) -> None:
    found = seen(scan_of((1.2, 0.0), (1.2, apart_m)))
    assert found is not None
    assert found.width_m == pytest.approx(width_m, abs=0.005)


def test_what_stands_beside_the_path_does_not_block_it() -> None:
    assert seen(scan_of((1.0, 0.6), (1.0, -0.6))) is None
    assert seen(scan_of((1.0, 0.3))) is not None


def test_it_looks_only_as_far_as_it_needs_to_stop() -> None:
    assert seen(scan_of((1.4, 0.0)), speed_m_s=0.2) is None
    assert seen(scan_of((1.4, 0.0)), speed_m_s=1.0) is not None


def test_it_sees_what_it_would_come_nearer_to_than_20_cm() -> None:
    for cm_s in range(101):
        # It drives on for 0.15 s, and then brakes by 2 m/s2.
        speed_m_s = cm_s / 100
        stands_m = FRONT_M + 0.15 * speed_m_s + speed_m_s**2 / 4.0
        nearest_m = stands_m + 0.2 + HALF_WIDTH_M  # of places that are 5 cm apart, the last
        assert seen(scan_of((nearest_m - 0.051, 0.0)), speed_m_s) is not None, speed_m_s
        assert seen(scan_of((nearest_m + 0.001, 0.0)), speed_m_s) is None, speed_m_s


def test_it_looks_to_where_the_bumper_gets_in_any_frame() -> None:
    x, y, yaw = 3.0, -4.0, 2.0  # and the path ends 0.5 m ahead
    ahead, aside = (math.cos(yaw), math.sin(yaw)), (-math.sin(yaw), math.cos(yaw))
    path = smooth_curve([(x, y), (x + 0.5 * ahead[0], y + 0.5 * ahead[1])])

    def found(*point: float) -> Sighting | None:
        scan = Scan(0.0, scan_of((point[0], point[1])), FIRST, STEP)
        return look_along(scan, (x, y, yaw), path, 0.0, 1.0)

    assert found(1.45, 0.0) is None, 'it stops before that'
    seen = found(1.05, 0.35)
    assert seen is not None
    assert seen.ahead_m == pytest.approx(math.hypot(1.05, 0.35) - FRONT_M, abs=0.01)
    place = (1.05 * ahead[k] + 0.35 * aside[k] for k in (0, 1))
    assert (seen.x_m - x, seen.y_m - y) == pytest.approx(tuple(place), abs=0.01)


def test_a_wall_beside_a_bend_does_not_block_the_bend() -> None:
    bend = smooth_curve([(0, 0), (1, 0), (1.7, 0.7), (1.7, 2)])
    wall = scan_of(*[(2.3, y / 20) for y in range(-10, 20)])
    assert look_along(Scan(0.0, wall, FIRST, STEP), (0, 0, 0), bend, 0.0, 0.6) is None


def scan_at(time_sec: float, *points: tuple[float, float]) -> Scan:
    return Scan(time_sec, scan_of(*points), FIRST, STEP)


def driving(limits: DriveLimits = LIMITS) -> Drive:
    """Return a drive along the x axis that stands at its start, on its first leg."""
    route = plan_route(parse_course('speed: 0.7\nwaypoints: [[0, 0], [10, 0]]'))
    drive = Drive(route, limits=limits)
    drive.step(Odometry(9.98, 0.0, 0.0, 0.0, 0.0, 0.0))
    return drive


def test_it_stands_before_the_first_scan_and_at_an_obstacle() -> None:
    stop, drive = ObstacleStop(), driving()
    assert stop.update(10.0) == ''
    assert stop.holds
    stop.add_scan(scan_at(10.0), drive)
    assert (stop.update(10.1), stop.holds) == ('', False)
    stop.add_scan(scan_at(10.2, (0.65, 0.0)), drive)
    assert stop.update(10.2).startswith('stopping: something 0.0 m wide stands on the path')
    assert (stop.update(10.3), stop.holds) == ('', True)
    stop.add_scan(scan_at(10.4), drive)
    assert stop.update(10.4) == 'the way is free: driving on'
    assert not stop.holds


def test_a_standing_robot_looks_as_far_as_one_that_drives() -> None:
    stop, drive, ahead = ObstacleStop(), driving(), (1.2, 0.0)
    stop.update(10.0)
    stop.add_scan(scan_at(10.0, ahead), drive)
    assert stop.update(10.0).startswith('stopping: ')
    stop.add_scan(scan_at(10.1), drive)
    stop.update(10.1)
    stop.add_scan(scan_at(10.2, ahead), drive)  # it may drive, but stands: 0 m/s
    assert (stop.update(10.2), stop.holds) == ('', False)


def test_a_robot_that_stops_later_looks_farther() -> None:
    for limits, is_seen in ((LIMITS, False), (A200_LIMITS, True)):
        stop = ObstacleStop()
        stop.update(10.0)
        stop.add_scan(scan_at(10.0, (1.5, 0.0)), driving(limits))
        stop.update(10.0)
        assert stop.holds is is_seen


def test_a_laser_farther_back_sees_what_is_nearer() -> None:
    for laser_x_m, ahead_m in ((LASER_X_M, 0.71), (0.0, 0.71 - LASER_X_M)):
        stop = ObstacleStop(laser_x_m=laser_x_m)
        stop.update(10.0)
        stop.add_scan(scan_at(10.0, (1.2, 0.0)), driving())
        assert f'{ahead_m:.2f} m ahead' in stop.update(10.0)


def test_a_robot_that_begins_looks_farther_than_its_speed_asks_for() -> None:
    for ahead_m, is_seen in ((0.83, True), (0.88, False)):  # at 0.7 m/s up to 0.81 m
        stop = ObstacleStop()
        stop.update(10.0)
        stop.add_scan(scan_at(10.0, (FRONT_M + ahead_m, 0.0)), driving())
        assert stop.update(10.0).startswith('stopping: ') is is_seen


def test_a_scan_from_before_a_reset_is_no_sight_of_the_way() -> None:
    for scanned_sec, counts in ((10.97, True), (11.0, False)):  # the odometry is of 9.98 s
        stop = ObstacleStop()
        stop.update(10.0)
        stop.add_scan(scan_at(scanned_sec), driving())
        stop.update(10.0)
        assert stop.holds is not counts


def waiting_drive() -> Drive:
    return Drive(plan_route(parse_course('waypoints: [[0, 0], [9, 0]]')))


def test_without_scans_the_robot_stands() -> None:
    stop, waiting = ObstacleStop(), waiting_drive()
    stop.update(10.0)
    stop.add_scan(scan_at(10.0, (0.65, 0.0)), waiting)  # not on its way yet: no obstacle
    assert (stop.update(10.9), stop.holds) == ('', False)
    assert 'no scan comes on front/scan' in stop.update(11.1)
    assert stop.holds
    stop.add_scan(scan_at(11.2), waiting)
    assert stop.update(11.2) == 'the way is free: driving on'
    assert stop.update(1.0) == ''  # the simulator was reset
    assert stop.holds
    stop.add_scan(scan_at(1.0, (0.65, 0.0)), driving())
    assert stop.update(1.0).startswith('stopping: ')
    stop.add_scan(scan_at(1.1, (0.65, 0.0)), waiting)
    assert stop.update(1.1) == 'the way is free: driving on', 'of another course'


def test_scans_that_measure_nothing_do_not_tell_that_the_way_is_free() -> None:
    for ranges in ([math.nan] * 720, []):
        stop, drive = ObstacleStop(), driving()
        stop.update(10.0)
        stop.add_scan(scan_at(10.0), drive)
        for time_sec in (10.1, 10.9):
            stop.add_scan(Scan(time_sec, ranges, FIRST, STEP), drive)
        assert (stop.update(11.0), stop.holds) == ('', False)
        assert stop.update(11.1) == (
            'standing: the scans on front/scan measure nothing: no range is a number'
        )
        assert stop.holds
        drive.step(Odometry(11.2, 0.0, 0.0, 0.0, 0.0, 0.0))
        stop.add_scan(scan_at(11.2), drive)  # +inf: nothing within reach
        assert (stop.update(11.2), stop.holds) == ('the way is free: driving on', False)


def test_it_waits_a_minute_and_no_longer() -> None:
    stop = ObstacleStop()
    for tenth in range(610):
        stop.update(tenth / 10)
        assert (stop.complaint != '') == (tenth >= 600)
    assert stop.complaint.startswith('stood for 60 s: standing: no scan comes')
    stop.add_scan(scan_at(61.0), waiting_drive())
    stop.update(61.0)
    assert stop.complaint == '', 'it has driven since'
    stop.update(100.0)
    assert stop.complaint == '', 'it has stood for less than a minute'
