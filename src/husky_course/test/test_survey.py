# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is found along a route before anything moves."""

from husky_course.outline import Outline
from husky_course.robot import ROBOT_LENGTH_M
from husky_course.route import plan_route
from husky_course.route.survey import survey_route
from husky_course.waypoints import parse_course
import pytest


def test_what_is_in_the_way_is_named_in_the_order_of_the_way() -> None:
    route = plan_route(parse_course('waypoints: [[0, 0], [8, 0], [8, 6]]'))
    obstacles = [
        Outline(name='after', x=8.0, y=4.0, yaw=0.0, size=(0.3,)),
        Outline(name='far', x=6.0, y=0.0, yaw=0.0, size=(0.3,)),
        Outline(name='near', x=3.0, y=0.0, yaw=0.0, size=(0.3,)),
    ]
    found = survey_route(route, obstacles)
    assert found.touched == ('near', 'far', 'after')
    assert [near.waypoint for near in found.near] == [1, 1, 2]


@pytest.mark.parametrize(
    ('text', 'place', 'waypoints'),
    [
        ('waypoints:\n- [0, 2]\n- [0, 5]\n- [3, 5]', (0.0, -0.55), [0]),  # at the start
        ('waypoints:\n- [0, 0]\n- [0, 5]\n- [3, 5]', (0.0, -0.55), [1]),
        ('waypoints:\n- [0, 0]\n- {x: 4, y: 0, yaw: 1.57}\n- [4, 5]', (4.0, -0.5), [1, 2]),
        ('waypoints:\n- [0, 0]\n- {x: 4, y: 0, yaw: 1.57}', (4.0, -0.55), [1]),
    ],
)
def test_a_turn_on_the_spot_belongs_to_the_way_that_follows(
    text: str, place: tuple[float, float], waypoints: list[int]
) -> None:
    post = Outline(name='post', x=place[0], y=place[1], yaw=0.0, size=(0.05,))
    found = survey_route(plan_route(parse_course(text)), [post]).near
    assert [near.waypoint for near in found] == waypoints, [str(near) for near in found]


def test_the_last_place_of_a_way_is_looked_at() -> None:
    post = Outline(name='post', x=4.6, y=0.0, yaw=0.0, size=(0.05,))
    (near,) = survey_route(plan_route(parse_course('waypoints: [[0, 0], [4, 0]]')), [post]).near
    assert (near.waypoint, near.x) == (1, 4.0)
    assert near.clearance_m == pytest.approx(4.6 - 0.05 - 4.0 - ROBOT_LENGTH_M / 2)


def test_an_obstacle_of_several_parts_is_named_once() -> None:
    route = plan_route(parse_course('waypoints: [[0, 0], [8, 0]]'))
    parts = [Outline(name='walls', x=x, y=0.6, yaw=0.0, size=(0.4, 0.4)) for x in (2.0, 5.0)]
    found = survey_route(
        route, [*parts, Outline(name='post', x=3.0, y=0.75, yaw=0.0, size=(0.4,))]
    )
    assert [near.obstacle for near in found.near] == ['walls', 'post']
    assert found.nearest == 'post'
