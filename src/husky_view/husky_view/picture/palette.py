# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The colours of the view, and what they mean."""

Rgb = tuple[int, int, int]

SKY_ABOVE: Rgb = (150, 190, 230)
SKY_BELOW: Rgb = (245, 248, 252)

# Safe for colour-blind people, on dark asphalt (after Okabe and Ito, 2008).
PATH: Rgb = (86, 180, 233)
TRUE_TRAIL: Rgb = (240, 228, 66)
ODOMETRY_TRAIL: Rgb = (230, 120, 200)
LOOK_AHEAD: Rgb = (255, 140, 0)
WAYPOINT: Rgb = (86, 180, 233)
REACHED: Rgb = (0, 200, 120)
LIDAR: Rgb = (255, 70, 30)
COLLISION: Rgb = (255, 0, 0)

# Of the editor.
EDITED: Rgb = (255, 255, 255)
SELECTED: Rgb = (255, 160, 0)
CLEAR: Rgb = (20, 180, 40)
SCARCE: Rgb = (255, 190, 0)
BLOCKED: Rgb = (255, 0, 40)

DOTS = frozenset((REACHED, LOOK_AHEAD, LIDAR, COLLISION))  # all others are lines
LEGEND: tuple[tuple[Rgb, str], ...] = (
    (PATH, 'given path and waypoints'),
    (REACHED, 'waypoint reached'),
    (TRUE_TRAIL, 'true trail'),
    (ODOMETRY_TRAIL, 'trail by odometry'),
    (LOOK_AHEAD, 'look-ahead point'),
    (LIDAR, 'lidar hits'),
    (COLLISION, 'collision'),
    (CLEAR, 'room enough'),
    (SCARCE, 'little room'),
    (BLOCKED, 'too near'),
)


def css(color: Rgb) -> str:
    """Return a colour as a CSS value."""
    return f'rgb({color[0]},{color[1]},{color[2]})'
