# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from collections.abc import Callable
from dataclasses import replace
import hashlib
from itertools import pairwise
import math
import struct

from husky_course.record import (
    Collision,
    COLUMNS,
    Disturbance,
    Overturn,
    read_run,
    Record,
    RecordRefused,
)
from husky_course.route import plan_route
from husky_course.waypoints import parse_course
from husky_grader.scoring.alignment import projected
from husky_grader.scoring.report import judge
import numpy as np
import pytest

SPEED_M_S = 0.5
STRAIGHT = plan_route(parse_course('speed: 0.5\nwaypoints: [[0, 0], [2, 0], [4, 0]]'))
LOOP = plan_route(
    parse_course('speed: 0.5\nloop: true\nwaypoints: [[0, 0], [3, 0], [3, 3], [0, 3]]')
)
Make = Callable[..., Record]
Places = list[tuple[float, float]]


def along(*corners: tuple[float, float], speed_m_s: float = SPEED_M_S) -> Places:
    """Return places along straight lines, then standing still."""
    places: Places = []
    for (x0, y0), (x1, y1) in pairwise(corners):
        count = max(1, round(math.hypot(x1 - x0, y1 - y0) / speed_m_s / 0.02))
        places += [(x0 + (x1 - x0) * k / count, y0 + (y1 - y0) * k / count) for k in range(count)]
    return places + [corners[-1]] * 10


def test_a_run_along_the_path_gets_every_point(make_record: Make) -> None:
    report = judge(read_run(make_record(along((0, 0), (4, 0)))), STRAIGHT)
    assert report.passed
    assert report.completed
    assert report.score == pytest.approx(100.0)
    assert report.reasons == ()
    assert (report.waypoints_reached, report.waypoints_total) == (3, 3)
    assert report.path_length_m == pytest.approx(4.0)
    assert report.driven_m == pytest.approx(4.0)
    assert report.sim_time_sec == pytest.approx(8.0, abs=0.05)
    assert report.cross_track_max_m < 1e-6


@pytest.mark.parametrize(
    ('corners', 'speed_m_s', 'told'),
    [
        ([(0, 0), (4, 0)], 0.3862, '10.34 s, full marks up to 10.33 s'),
        ([(0, 0.1003), (4, 0.1003)], 0.5, '0.1003 m RMS off the path, full marks up to 0.10 m'),
    ],
)
def test_what_costs_points_is_told_with_enough_digits(
    make_record: Make, corners: Places, speed_m_s: float, told: str
) -> None:
    report = judge(read_run(make_record(along(*corners, speed_m_s=speed_m_s))), STRAIGHT)
    (costly,) = [part for part in report.parts if part.cost_points > 0.0]
    assert told in costly.why


def test_a_parallel_run_is_off_the_path_by_its_distance(make_record: Make) -> None:
    report = judge(read_run(make_record(along((0, 0.2), (4, 0.2)))), STRAIGHT)
    assert report.cross_track_rms_m == pytest.approx(0.2)
    assert report.completed
    tracking = report.parts[-1]
    assert tracking.factor == pytest.approx(0.75)
    assert report.score == pytest.approx(75.0)
    assert tracking.cost_points == pytest.approx(25.0)


def touch_at(time_sec: float) -> Collision:
    return Collision(
        robot='husky',
        obstacle='cone',
        part='base',
        time_sec=time_sec,
        force_n=12.0,
        position=(1.0, 0.0, 0.1),
    )


def test_each_collision_costs_a_factor_and_fails_the_run(make_record: Make) -> None:
    record = make_record(along((0, 0), (4, 0)), collisions=[touch_at(1.0), touch_at(2.0)])
    report = judge(read_run(record), STRAIGHT)
    assert report.completed
    assert not report.passed
    assert report.score == pytest.approx(100 * 0.65**2)
    assert report.parts[1].why == 'touched 2 times: cone'
    assert 'touched cone with its base at 1.00 s, with 12 N' in report.reasons


def test_the_costs_of_the_parts_add_up_to_the_missing_points(make_record: Make) -> None:
    report = judge(
        read_run(make_record(along((0, 0.3), (2, 0.3), (3, 0.3), speed_m_s=0.2))), STRAIGHT
    )
    assert 100 - sum(part.cost_points for part in report.parts) == pytest.approx(report.score)
    assert report.score == pytest.approx(100 * math.prod(part.factor for part in report.parts))


def test_stopping_early_is_not_completed_and_says_where(make_record: Make) -> None:
    report = judge(read_run(make_record(along((0, 0), (2.5, 0)))), STRAIGHT)
    assert not report.completed
    assert report.waypoints_reached == 2
    assert 'missed waypoint 3 at (4, 0): it came no nearer than 1.50 m' in report.reasons[0]
    assert 'stopped at (2.50, 0.00), 1.50 m from the last waypoint' in report.reasons[1]


@pytest.mark.parametrize('speed_m_s', [SPEED_M_S, -SPEED_M_S])
def test_a_run_that_never_stops_is_not_completed(make_record: Make, speed_m_s: float) -> None:
    places = along((0, 0), (4, 0), (4.2, 0))[:-10]
    record = make_record(places, speed_m_s=[speed_m_s] * len(places))
    report = judge(read_run(record), STRAIGHT)
    assert report.waypoints_reached == 3
    assert not report.completed
    told = f'did not stop: still driving {speed_m_s:.2f} m/s when the run ended'
    assert told in report.reasons, report.reasons
    completion = report.parts[0]
    assert completion.factor == pytest.approx(0.8)
    assert completion.why == (
        '3 of 3 waypoints reached in order; not standing at the last waypoint in the end'
    )


def test_one_that_turned_over_is_told_when_and_where(make_record: Make) -> None:
    places = along((0, 0), (2.5, 0))
    at = places.index(next(place for place in places if place[0] >= 1.0))
    over = Overturn(robot='husky', time_sec=at * 0.02)
    run = read_run(make_record(places, overturns=[over, replace(over, robot='other')]))
    (said,) = [line for line in judge(run, STRAIGHT).reasons if 'turned' in line]
    place = f'({run.x[at]:.2f}, 0.00)'
    when_sec = over.time_sec - 0.02 * run.begin
    assert said == f'turned over at {when_sec:.2f} s at {place}, as when it climbs an obstacle'


def test_a_robot_that_never_moves_gets_nothing_and_is_told_why(make_record: Make) -> None:
    for course in (STRAIGHT, LOOP):
        run = read_run(make_record([(0.0, 0.0)] * 50))
        report = judge(run, course)
        assert report.score == 0.0
        assert not report.completed
        assert 'no command that moves it arrived on husky_veloc' in report.reasons[0]
        assert 'it arrived on cmd_vel; ' in judge(run, course, interface='clearpath').reasons[0]


@pytest.mark.parametrize(
    ('column', 'said'),
    [
        ('command_yaw_rate_rad_s', 'it was only told to turn (linear.x was always 0)'),
        ('command_speed_m_s', 'it never moved, although it was told to'),
    ],
)
def test_one_that_was_told_to_move_and_did_not_is_told_how(
    make_record: Make, column: str, said: str
) -> None:
    record = make_record([(0.0, 0.0)] * 50, **{column: [0.0] * 49 + [-0.5]})
    assert said in judge(read_run(record), STRAIGHT).reasons[0]


CLOSED = plan_route(parse_course('speed: 0.5\nwaypoints: [[0, 0], [2, 0], [2, 2], [0, 0]]'))


@pytest.mark.parametrize('run', [[(0.0, 0.0)] * 50, along((0, 0), (0.1, 0))])
def test_where_a_course_begins_it_has_not_ended(make_record: Make, run: Places) -> None:
    report = judge(read_run(make_record(run)), CLOSED)
    assert report.waypoints_reached == 1
    assert report.score == 0.0


def test_a_course_that_ends_where_it_begins_is_driven(make_record: Make) -> None:
    run = along((0, 0), (2, 0), (2, 2), (0, 0))
    report = judge(read_run(make_record(run)), CLOSED)
    assert report.completed
    assert report.waypoints_reached == 4


def test_one_visit_counts_for_one_way_past_a_place(make_record: Make) -> None:
    there_and_back = '[[0, 0], [1, 0], [2, 0], [3, 0], [2, 0], [1, 0], [0, 0]]'
    route = plan_route(parse_course(f'speed: 0.5\nwaypoints: {there_and_back}'))
    reports = [
        judge(read_run(make_record(along((0, 0), *run))), route)
        for run in (((1, 0),), ((3, 0),), ((3, 0), (1, 0)), ((3, 0), (0, 0)))
    ]
    assert [report.waypoints_reached for report in reports] == [2, 4, 6, 7]
    assert reports[0].reasons[3] == '... and 2 more waypoints', reports[0].reasons


def test_near_waypoints_are_reached_in_one_visit(make_record: Make) -> None:
    near = '[[0, 0], [0.06, 0], [0.12, 0], [0.18, 0.05], [0.12, 0.1], [1, 0.1]]'
    route = plan_route(parse_course(f'speed: 0.5\ncorners: sharp\nwaypoints: {near}'))
    report = judge(read_run(make_record(along((0, 0), (0.18, 0.05), (1, 0.1)))), route)
    assert report.completed


def test_standing_near_all_waypoints_earns_nothing(make_record: Make) -> None:
    route = plan_route(parse_course('tolerance: 1.0\nwaypoints: [[0, 0], [0.5, 0], [0.9, 0]]'))
    report = judge(read_run(make_record([(0.0, 0.0)] * 50)), route)
    assert not report.passed
    assert report.score == 0.0
    (said,) = report.reasons
    assert said.startswith('it never moved')


def test_a_short_course_that_is_driven_is_no_stand(make_record: Make) -> None:
    route = plan_route(parse_course('speed: 0.05\nwaypoints: [[0, 0], [0.05, 0]]'))
    report = judge(read_run(make_record(along((0, 0), (0.045, 0), speed_m_s=0.05))), route)
    assert report.passed
    assert report.reasons == ()


def test_one_that_turns_on_at_the_end_is_told_so(make_record: Make) -> None:
    run = along((0, 0), (4, 0)) + [(4.0, 0.0)] * 500
    turning = [0.0] * (len(run) - 500) + [0.8] * 500
    report = judge(read_run(make_record(run, yaw_rate_rad_s=turning)), STRAIGHT)
    assert not report.passed
    assert report.reasons == ('did not stop: still turning 0.80 rad/s when the run ended',)
    assert report.sim_time_sec == pytest.approx(18.2, abs=0.05), 'it turned to the end'


def test_a_loop_that_is_not_ended_at_its_beginning_says_so(make_record: Make) -> None:
    run = along((0, 0), (3, 0), (3, 3), (0, 3), (0, -0.5))
    report = judge(read_run(make_record(run)), LOOP)
    assert report.reasons == (
        'missed waypoint 5 at (0, 0): a loop is to end there',
        'stopped at (0.00, -0.50), 0.50 m from the last waypoint',
    )
    assert report.parts[0].factor == pytest.approx(3 / 4 * 0.8)


def test_a_near_miss_is_told_with_enough_digits(make_record: Make) -> None:
    report = judge(read_run(make_record(along((0, 0.2504), (4, 0.2504)))), STRAIGHT)
    assert 'it came no nearer than 0.2504 m, allowed are 0.25 m' in report.reasons[0]


def test_turns_that_the_course_asks_for_are_no_surplus(make_record: Make) -> None:
    asked = [f'{{x: {x}, y: 0, yaw: 3.1}}' for x in range(1, 7)]
    route = plan_route(parse_course(f'speed: 0.5\nwaypoints: [[0, 0], {", ".join(asked)}]'))
    run, yaw = Places(), list[float]()
    for x in range(5):  # not to the end
        there = along((x, 0), (x + 1, 0))
        run += there + [(x + 1.0, 0.0)] * 200
        yaw += [0.0] * len(there) + [3.1 * (1 - abs(k - 100) / 100) for k in range(200)]
    report = judge(read_run(make_record(run, yaw=yaw)), route)
    assert [line.split(' at ')[0] for line in report.reasons] == ['missed waypoint 7', 'stopped']
    swung = [3.1 * (1 - abs(k % 200 - 100) / 100) for k in range(len(run))]
    report = judge(read_run(make_record(run, yaw=swung)), route)
    assert 'rounds more than the path does' in report.reasons[-1]


def test_a_mirrored_course_is_told_beside_great_commands(make_record: Make) -> None:
    places = along((0, 0), (3, 0), (3, -3), (0, -3), (0, 0))
    asked = [25.1] * len(places)  # eight times the angle to the waypoint, in radians
    report = judge(read_run(make_record(places, command_yaw_rate_rad_s=asked)), LOOP)
    mirrored, units = report.reasons[-2:]
    assert mirrored.startswith('it drove the course mirrored')
    assert units.startswith('it commanded angular.z = 25.1')


def test_one_that_is_pushed_back_is_not_said_to_drive_so(make_record: Make) -> None:
    places = along((0, 0), (3, 0), (2, 0))
    speed = [0.5] * 300 + [-0.5] * (len(places) - 310) + [0.0] * 10
    for ahead, said in ((0.5, False), (-0.5, True)):
        asked = [0.5] * 300 + [ahead] * (len(places) - 300)
        record = make_record(places, speed_m_s=speed, command_speed_m_s=asked)
        report = judge(read_run(record), STRAIGHT)
        assert any('backwards' in line for line in report.reasons) is said
        assert report.parts[-1].factor == pytest.approx(1 - 0.5 * 0.25, abs=0.01)
        assert report.parts[-1].why.endswith('; 25% of the way in the wrong direction')


AWAY = '[[6, 0], [6, 2], [3, 2], [3, 0.3]]'


@pytest.mark.parametrize('first_speed', [0.5, 1.0])
def test_the_way_to_the_first_waypoint_is_none_of_the_path(
    make_record: Make, first_speed: float
) -> None:
    text = AWAY.replace('[6, 0]', f'{{x: 6, y: 0, speed: {first_speed}}}')
    route = plan_route(parse_course(f'speed: 0.5\ncorners: sharp\nwaypoints: {text}'))
    way = along((0, 0), (6, 0), speed_m_s=first_speed)
    run = way + along((6, 0), (6, 2), (3, 2), (3, 0.3))
    report = judge(read_run(make_record(run)), route)
    assert report.score == pytest.approx(100.0)
    assert report.cross_track_max_m < 0.02
    assert not report.errors_m[: len(way)].any()


def test_a_wide_tolerance_does_not_begin_the_path_beside_it(make_record: Make) -> None:
    course = parse_course('speed: 0.5\ntolerance: 1.0\nwaypoints: [[0, 0.9], [3, 0.9]]')
    report = judge(read_run(make_record(along((0, 0), (0, 0.9), (3, 0.9)))), plan_route(course))
    assert report.cross_track_max_m < 0.01
    assert report.score == pytest.approx(100.0)


def test_backwards_counts_from_the_first_waypoint_on(make_record: Make) -> None:
    text = '[[2, 0], {x: 4, y: 0.1, reverse: true}, {x: 6, y: 0, reverse: true}]'
    route = plan_route(parse_course(f'speed: 0.5\ntolerance: 1.0\nwaypoints: {text}'))
    run = along((0, 0), (2, 0))
    speed = [0.5] * (len(run) - 10) + [0.0] * 10
    back = along((2, 0), (4, 0.1), (6, 0))
    speed += [-0.5] * (len(back) - 10) + [0.0] * 10
    report = judge(read_run(make_record(run + back, speed_m_s=speed)), route)
    assert report.score == pytest.approx(100.0)
    assert report.reasons == ()


def test_one_that_misses_the_first_waypoint_is_judged_from_there(make_record: Make) -> None:
    route = plan_route(parse_course(f'speed: 0.5\ncorners: sharp\nwaypoints: {AWAY}'))
    run = along((0, 0), (5.7, 0), (5.7, 0.1), (6, 2), (3, 2), (3, 0.3))
    report = judge(read_run(make_record(run)), route)
    assert (report.waypoints_reached, report.waypoints_total) == (3, 4)
    assert report.cross_track_max_m < 0.31
    assert 'missed waypoint 1 at (6, 0): it came no nearer than 0.30 m' in report.reasons[0]


def test_a_loop_whose_beginning_was_missed_is_judged_as_a_whole(make_record: Make) -> None:
    loop = '[[3, 0], [6, 0], [6, 3], [3, 3]]'
    route = plan_route(parse_course(f'speed: 0.5\nloop: true\nwaypoints: {loop}'))
    way = along((0, 0.3), (3, 0.3), (6, 0.2), (5.8, 2.8), (3.2, 3.0), (3, 0))
    report = judge(read_run(make_record(way)), route)
    assert (report.waypoints_reached, report.waypoints_total) == (3, 5)
    assert report.cross_track_rms_m > 0.1
    assert 'full marks' in report.parts[2].why


def test_one_that_gives_up_on_the_way_to_the_path_is_told_so(make_record: Make) -> None:
    route = plan_route(parse_course(f'speed: 0.5\nwaypoints: {AWAY}'))
    report = judge(read_run(make_record(along((0, 0), (3, -1)))), route)
    assert report.score == 0.0
    assert report.parts[2].why == 'it did not drive along the path'


def test_a_cut_corner_misses_its_waypoint_and_only_that(make_record: Make) -> None:
    run = along((0, 0), (3, 0), (0.5, 3), (0, 3), (0, 0))
    report = judge(read_run(make_record(run)), LOOP)
    assert (report.waypoints_reached, report.waypoints_total) == (4, 5)
    assert 'missed waypoint 3 at (3, 3)' in report.reasons[0]
    assert report.cross_track_max_m > 1.0


def test_a_loop_driven_the_wrong_way_round_is_not_completed(make_record: Make) -> None:
    report = judge(read_run(make_record(along((0, 0), (0, 3), (3, 3), (3, 0), (0, 0)))), LOOP)
    assert not report.completed
    assert any('not in its turn' in reason for reason in report.reasons)


def test_driving_faster_than_asked_costs_points(make_record: Make) -> None:
    report = judge(read_run(make_record(along((0, 0), (4, 0), speed_m_s=0.9))), STRAIGHT)
    assert report.parts[2].factor == pytest.approx(0.5, abs=0.02)
    assert 'faster than asked' in report.parts[2].why


def test_driving_slowly_costs_points_in_proportion(make_record: Make) -> None:
    report = judge(read_run(make_record(along((0, 0), (4, 0), speed_m_s=0.3))), STRAIGHT)
    assert report.parts[2].factor == pytest.approx(1.15 * 9.0 / 13.33, abs=0.02)
    report = judge(read_run(make_record(along((0, 0), (4, 0), speed_m_s=0.1))), STRAIGHT)
    assert report.parts[2].factor == 0.5, 'that is the least'


def test_a_start_elsewhere_moves_the_course_with_it(make_record: Make) -> None:
    run = [(2.0 - y, 1.0 + x) for x, y in along((0, 0), (4, 0))]
    report = judge(read_run(make_record(run, start=[2.0, 1.0, math.pi / 2])), STRAIGHT)
    assert report.passed
    assert report.cross_track_max_m < 1e-6


def test_the_hash_is_of_time_and_true_pose_in_full_precision(make_record: Make) -> None:
    record = make_record(along((0, 0), (4, 0)))
    columns = (record.column(0, name) for name in ('time_sec', 'x', 'y', 'yaw'))
    data = b''.join(struct.pack('<4d', *entry) for entry in zip(*columns, strict=True))
    assert judge(read_run(record), STRAIGHT).trajectory_sha256 == hashlib.sha256(data).hexdigest()
    record.rows[5, 0, COLUMNS.index('x')] = math.nextafter(record.column(0, 'x')[5], 9.0)
    assert judge(read_run(record), STRAIGHT).trajectory_sha256 != hashlib.sha256(data).hexdigest()


def test_a_robot_that_is_not_in_the_record_is_refused(make_record: Make) -> None:
    record = make_record(along((0, 0), (4, 0)))
    with pytest.raises(RecordRefused, match="robot 'beta' is not in the record; it has: husky"):
        judge(read_run(record, 'beta'), STRAIGHT)


def test_the_reports_time_begins_with_the_first_command(make_record: Make) -> None:
    waits = [(0.0, 0.0)] * 100  # two seconds
    record = make_record([*waits, *along((0, 0), (4, 0))], collisions=[touch_at(3.0)])
    report = judge(read_run(record), STRAIGHT)
    (touch,) = report.collisions
    assert touch.time_sec == pytest.approx(1.0, abs=0.03)
    assert 'touched cone with its base at 1.00 s, with 12 N' in report.reasons
    assert report.parts[1].why == 'touched once: cone'
    assert report.sim_time_sec == pytest.approx(8.0, abs=0.05)


@pytest.mark.parametrize('time_sec', [0.5, 3.0, 10.1])
def test_every_collision_lies_within_the_time_of_the_run(
    make_record: Make, time_sec: float
) -> None:
    places = [*[(0.0, 0.0)] * 100, *along((0, 0), (4, 0))]
    report = judge(read_run(make_record(places, collisions=[touch_at(time_sec)])), STRAIGHT)
    assert 0.0 <= report.collisions[0].time_sec <= report.sim_time_sec


COMMANDS = '/husky_velocity_controller/cmd_vel'


@pytest.mark.parametrize(
    ('topic', 'nodes', 'said'),
    [
        (
            COMMANDS,
            ('/follow_path', '/other'),
            f'/follow_path and /other both published {COMMANDS}: nobody can tell whose drive '
            'it was',
        ),
        (
            COMMANDS,
            ('/a', '/b', '/c'),
            f'/a and /b and /c all published {COMMANDS}: nobody can tell whose drive it was',
        ),
        (
            '/odometry/filtered',
            ('/liar',),
            '/liar published /odometry/filtered beside the simulator: nobody can tell what the '
            'driver heard',
        ),
    ],
)
def test_a_disturbed_run_is_worth_nothing_and_says_why(
    make_record: Make, topic: str, nodes: tuple[str, ...], said: str
) -> None:
    other = Disturbance(time_sec=3.2, topic=topic, nodes=nodes)
    report = judge(read_run(make_record(along((0, 0), (4, 0)), disturbances=[other])), STRAIGHT)
    assert report.completed
    assert not report.passed
    assert report.score == 0.0
    assert report.reasons == (f'disturbed at 3.20 s: {said}',)
    alone = report.parts[-1]
    assert (alone.name, alone.factor, alone.why) == ('alone', 0.0, report.reasons[0])
    assert alone.cost_points == pytest.approx(100.0)


def test_a_record_that_breaks_off_is_judged_as_far_as_it_goes(make_record: Make) -> None:
    run = along((0, 0), (4, 0))[:300]
    report = judge(read_run(make_record(run, complete=False)), STRAIGHT)
    assert report.waypoints_reached == 2
    assert not report.passed
    early, missed = report.reasons
    assert early.startswith('the run ended early: its record breaks off at 5.98 s')
    assert missed.startswith('missed waypoint 3')


def test_a_record_of_the_start_alone_does_not_say_it_never_moved(make_record: Make) -> None:
    report = judge(read_run(make_record([(0.0, 0.0)], complete=False)), STRAIGHT)
    (early,) = report.reasons
    assert early.startswith('the run ended early: its record breaks off at 0.00 s')


@pytest.mark.parametrize('far', [(5, 0), (-2, 0)], ids=['beyond the turn', 'behind the start'])
def test_beyond_an_end_of_a_leg_it_is_off_the_path(
    make_record: Make, far: tuple[float, float]
) -> None:
    route = plan_route(parse_course('speed: 0.5\nwaypoints: [[0, 0], [3, 0], [0, 0]]'))
    report = judge(read_run(make_record(along((0, 0), far, (3, 0), (0, 0)))), route)
    assert report.cross_track_max_m == pytest.approx(2.0, abs=0.01)
    assert report.parts[-1].factor < 0.1


def test_a_run_laid_along_its_path_is_projected_as_pose_by_pose() -> None:
    chance = np.random.default_rng(1)
    curve = LOOP.legs[0].curve
    places = np.array([curve.point_at(s) for s in np.linspace(0.0, curve.length_m, 3000)])
    x, y = (places + chance.normal(0.0, 0.05, places.shape)).T
    near = np.array([curve.index_at(s) for s in np.linspace(0.0, curve.length_m, 3000)])
    along_m, offsets = projected(curve, near, x, y)
    for k in range(0, 3000, 7):
        _, s, offset = curve.project(int(near[k]), float(x[k]), float(y[k]))
        away_m = math.dist(curve.point_at(s), (x[k], y[k]))
        assert along_m[k] == pytest.approx(s, abs=1e-12)
        assert offsets[k] == pytest.approx(math.copysign(away_m, offset), abs=1e-4)


def test_a_long_stand_on_the_way_changes_no_score(make_record: Make) -> None:
    there, back = along((0, 0), (2, 0.1)), along((2, 0.1), (4, 0))
    short, long = (
        judge(read_run(make_record([*there, *[(2.0, 0.1)] * stand, *back])), STRAIGHT)
        for stand in (10, 30_000)
    )
    assert long.waypoints_reached == short.waypoints_reached == 3
    assert long.cross_track_rms_m == pytest.approx(short.cross_track_rms_m, rel=1e-6)
    assert long.driven_m == pytest.approx(short.driven_m)
