# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Waypoint files: read, checked, and turned into a course."""

from husky_course.waypoints.course import Course, MAX_SPEED_M_S, MIN_SPEED_M_S, Waypoint
from husky_course.waypoints.waypoint_file import load_course, parse_course

__all__ = ['MAX_SPEED_M_S', 'MIN_SPEED_M_S', 'Course', 'Waypoint', 'load_course', 'parse_course']
