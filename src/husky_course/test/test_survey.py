# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is found along a route before anything moves."""

from husky_course.outline import Outline
from husky_course.route import plan_route
from husky_course.route.survey import survey_route
from husky_course.waypoints import parse_course


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
