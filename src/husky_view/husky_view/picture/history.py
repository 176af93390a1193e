# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Speed and distance off the path over the time of a run, and the plots of them in the panel."""

from collections.abc import Callable

from husky_course.frames import Array
import numpy as np
import viser

from husky_view.picture import palette
from husky_view.picture.page import AT_PLOTS
from husky_view.picture.palette import css, Rgb

STEP_SEC = 0.1
"""Of simulated time, between two points in the beginning."""

MOST_POINTS = 300
HEIGHT_PX = 110
AXIS_PX = 62  # uPlot's own 50 px cut the sign off -0.05
TICK_PX = 16  # from one to the next, at least: with uPlot's 30 there may be one alone
PADDING_PX = (8, 8, 0, 0)  # top, right, bottom, left: room for half of the last numbers
SPEED: Rgb = (200, 150, 0)  # of the trail, dark enough for white paper


class History:
    """Points (n, 3) of time, speed and distance; with more time they lie further apart."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Begin a new run."""
        self.points: Array = np.zeros((0, 3))
        self._step_sec = STEP_SEC

    def add(self, time_sec: Array, speed_m_s: Array, off_m: Callable[[int], float]) -> None:
        """
        Add what is due of a part of a run, in order of time.

        :param off_m: returns the distance off the path at a place of it; NaN without a path.
        """
        last_sec = self.points[-1, 0] if len(self.points) else -np.inf
        steps = np.floor(time_sec / self._step_sec + 1e-6)
        is_due = np.diff(steps, prepend=-1.0) > 0.0
        is_due &= steps > np.floor(last_sec / self._step_sec + 1e-6)
        added = [
            (time_sec[place], speed_m_s[place], off_m(int(place)))
            for place in np.flatnonzero(is_due)
        ]
        self.points = np.concatenate([self.points, np.array(added).reshape(-1, 3)])
        while len(self.points) > MOST_POINTS:
            self.points = self.points[::2]
            self._step_sec *= 2.0


class RunPlots:
    """A folder with a plot of each; closed at first."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._drawn_sec = np.nan
        with gui.add_folder('Plots over the time', order=AT_PLOTS, expand_by_default=False):
            self._speed = _plot(gui, 'speed, m/s', SPEED, low=0.0, high=0.6)
            self._off = _plot(gui, 'off the path, m', palette.PATH, low=-0.06, high=0.06)

    def show(self, history: History) -> None:
        """Show a history, if there is something new in it."""
        points = history.points
        if not len(points) or points[-1, 0] == self._drawn_sec:
            return
        self._drawn_sec = points[-1, 0]
        time_sec, speed_m_s, off_m = points.T
        self._speed.data = (time_sec, speed_m_s)
        is_known = np.isfinite(off_m)
        if is_known.any():
            self._off.data = (time_sec[is_known], off_m[is_known])
        if self._off.visible != bool(is_known.any()):
            self._off.visible = bool(is_known.any())


def _reaching(low: float, high: float) -> dict[str, dict[str, float]]:
    """Let an axis reach from low to high, or further: a robot at rest draws a flat line."""
    return {'min': {'soft': low, 'mode': 1}, 'max': {'soft': high, 'mode': 1}}


def _plot(
    gui: viser.GuiApi, title: str, color: Rgb, *, low: float, high: float
) -> viser.GuiUplotHandle:
    # With no point at all, viser's plot would stay empty for good.
    return gui.add_uplot(
        (np.zeros(1), np.zeros(1)),
        ({'label': 's'}, {'label': title, 'stroke': css(color), 'width': 2}),
        title=title,
        scales={'x': {'time': False}, 'y': {'range': _reaching(low, high)}},
        legend={'show': False},
        axes=({}, {'size': AXIS_PX, 'space': TICK_PX}),
        padding=PADDING_PX,
        height=HEIGHT_PX,
    )
