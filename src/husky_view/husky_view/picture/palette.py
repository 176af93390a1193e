# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The colours of the view, and the legend that explains them."""

Rgb = tuple[int, int, int]

# Told apart by people of every colour vision, on dark asphalt (after Okabe and Ito, 2008).
PATH: Rgb = (86, 180, 233)
TRUE_TRAIL: Rgb = (240, 228, 66)
ODOMETRY_TRAIL: Rgb = (230, 120, 200)
LOOK_AHEAD: Rgb = (0, 220, 160)
WAYPOINT: Rgb = (86, 180, 233)
REACHED: Rgb = (0, 200, 120)
LIDAR: Rgb = (255, 70, 30)
COLLISION: Rgb = (255, 0, 0)

# Of the editor.
EDITED: Rgb = (255, 255, 255)
SELECTED: Rgb = (255, 160, 0)
CLEAR: Rgb = (20, 180, 40)
SCARCE: Rgb = (255, 190, 0)
BLOCKED: Rgb = (255, 60, 40)

LEGEND: tuple[tuple[Rgb, str], ...] = (
    (PATH, 'given path and waypoints'),
    (TRUE_TRAIL, 'true trail'),
    (ODOMETRY_TRAIL, 'trail by odometry'),
    (LOOK_AHEAD, 'look-ahead point'),
    (LIDAR, 'lidar hits'),
    (COLLISION, 'collision'),
)


def css(color: Rgb) -> str:
    """Write a colour as a style sheet wants it."""
    return f'rgb({color[0]},{color[1]},{color[2]})'


def legend_html() -> str:
    """Return the legend: a coloured bar and a word for each."""
    rows = ''.join(
        '<span style="display:inline-flex;align-items:center;gap:.4em;margin-right:.9em">'
        f'<i style="width:1.4em;height:.35em;border-radius:.2em;background:{css(color)};'
        'outline:1px solid #0003"></i>'
        f'{name}</span>'
        for color, name in LEGEND
    )
    style = 'padding:0 1em .6em;font-size:.8em;line-height:1.5'
    return f'<div class="husky-legend" style="{style}">{rows}</div>'
