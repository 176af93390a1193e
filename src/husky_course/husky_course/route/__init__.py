# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The route of a course: legs on smooth curves, and how long they take."""

from husky_course.route.legs import AT_FIRST_M, Leg
from husky_course.route.path import Curve, Point
from husky_course.route.route import LIMIT_EXTRA_SEC, LIMIT_FACTOR, plan_route, Route
from husky_course.route.speeds import A200_LIMITS, DriveLimits, LIMITS, plan_speeds
from husky_course.route.survey import NearPass, poses_along, Survey, survey_route

__all__ = [
    'A200_LIMITS',
    'AT_FIRST_M',
    'LIMITS',
    'LIMIT_EXTRA_SEC',
    'LIMIT_FACTOR',
    'Curve',
    'DriveLimits',
    'Leg',
    'NearPass',
    'Point',
    'Route',
    'Survey',
    'plan_route',
    'plan_speeds',
    'poses_along',
    'survey_route',
]
