# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The panel beside a live simulation: numbers, controls, the pad, cameras and the legend.

What is clicked is left as work for the thread that owns everything else.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape
import time
from typing import Any

import viser

from husky_view.picture import cameras
from husky_view.picture.pad import Direction, HOLD_HZ, Pad
from husky_view.picture.page import GO, page_html, STOP
from husky_view.picture.palette import legend_html
from husky_view.work import Work

PAUSE, RESUME, STEP, RESET = 'Pause', 'Resume', 'Step', 'Reset'
FACTORS = {'½×': 0.5, '1×': 1.0, '2×': 2.0, '5×': 5.0, 'max': 0.0}


@dataclass(frozen=True, kw_only=True)
class Numbers:
    """What the panel shows in figures; None where there is nothing to tell."""

    time_sec: float
    real_time_factor: float | None
    paused: bool
    speed_m_s: float
    cross_track_m: float | None
    waypoints_left: int | None
    collisions: int


@dataclass(frozen=True, kw_only=True)
class Controls:
    """What the clicks do; called on the thread that does the work."""

    pause: Callable[[bool], None]
    step: Callable[[], None]
    reset: Callable[[], None]
    set_factor: Callable[[float], None]
    stop: Callable[[bool], None]
    choose_robot: Callable[[int], None]
    choose_camera: Callable[[viser.ClientHandle, str], None]


class Panel:
    """The elements of the page."""

    def __init__(
        self,
        server: viser.ViserServer,
        work: Work,
        controls: Controls,
        *,
        robots: Sequence[str],
    ) -> None:
        self.pad = Pad()
        self._server = server
        self._controls = controls
        self._later = work.put
        self._paused = False
        self._stopped = False
        gui = server.gui
        self._trouble = gui.add_html('', visible=False)
        self._numbers = gui.add_html('')
        self._page = gui.add_html(page_html())
        self._stop = gui.add_button(STOP, color='red', icon=viser.Icon.HAND_STOP)
        self._stop.on_click(lambda _: self._later(lambda: controls.stop(not self._stopped)))
        self._time = gui.add_button_group('Time', (PAUSE, STEP, RESET))
        self._time.on_click(lambda event: self._on_time(event.target.value))
        factors = gui.add_button_group('Speed', tuple(FACTORS))
        factors.on_click(
            lambda event: self._later(lambda: controls.set_factor(FACTORS[event.target.value]))
        )
        camera = gui.add_button_group('Camera', cameras.PRESETS)
        camera.on_click(lambda event: self._on_camera(event.client, event.target.value))
        if len(robots) > 1:
            robot = gui.add_dropdown('Robot', tuple(robots))
            robot.on_update(
                lambda event: self._later(
                    lambda: controls.choose_robot(robots.index(event.target.value))
                )
            )
        self._add_pad(gui)
        self._legend = gui.add_html(legend_html())

    def _add_pad(self, gui: viser.GuiApi) -> None:
        self._server.on_client_disconnect(lambda client: self.pad.release_tab(client.client_id))
        folder = gui.add_folder('Drive: arrow keys, or hold')
        with folder:
            for direction in Direction:
                button = gui.add_button(direction.sign)
                button.on_hold(self._holder(direction), callback_hz=HOLD_HZ)
                button.on_click(self._releaser(direction))
        speed = gui.add_slider('Drive at, m/s', 0.1, 1.0, 0.1, self.pad.speed_m_s)
        speed.on_update(lambda event: setattr(self.pad, 'speed_m_s', float(event.target.value)))

    def _holder(self, direction: Direction) -> Callable[[Any], Any]:
        # A coroutine, so that it runs on the server's own thread and in order.
        async def on_hold(event: Any) -> None:
            self.pad.hold(event.client_id, direction, now_sec=time.monotonic())

        return on_hold

    def _releaser(self, direction: Direction) -> Callable[[Any], Any]:
        async def on_click(event: Any) -> None:
            self.pad.release(event.client_id, direction)

        return on_click

    def _on_time(self, word: str) -> None:
        controls = self._controls
        if word in (PAUSE, RESUME):
            self._later(lambda: controls.pause(word == PAUSE))
        elif word == STEP:
            self._later(controls.step)
        else:
            self._later(controls.reset)

    def _on_camera(self, client: viser.ClientHandle | None, preset: str) -> None:
        if client is not None:
            self._later(lambda: self._controls.choose_camera(client, preset))

    def show_stopped(self, stopped: bool) -> None:
        """Say whether the robot is held by the stop button."""
        self._stopped = stopped
        self._stop.label = GO if stopped else STOP
        self._stop.color = 'orange' if stopped else 'red'

    def show(self, numbers: Numbers) -> None:
        """Bring the figures up to date."""
        if numbers.paused != self._paused:
            self._paused = numbers.paused
            self._time.options = (RESUME if numbers.paused else PAUSE, STEP, RESET)
        html = numbers_html(numbers)
        if html != self._numbers.content:
            self._numbers.content = html

    def show_trouble(self, text: str) -> None:
        """Say above everything else what is the matter; empty: nothing is."""
        html = trouble_html(text) if text else ''
        if html != self._trouble.content:
            self._trouble.content = html
            self._trouble.visible = bool(text)

    def tell(self, title: str, body: str, error: bool) -> None:
        """Tell every tab something, for some seconds."""
        for client in self._server.get_clients().values():
            client.add_notification(
                title, body, auto_close_seconds=6.0, color='red' if error else 'blue'
            )


def trouble_html(text: str) -> str:
    """Return a box that nobody overlooks."""
    return (
        '<div data-trouble style="margin:.3em .9em .6em;padding:.5em .7em;border-radius:.3em;'
        f'background:#c40;color:#fff;font-size:.9em">{escape(text)}</div>'
    )


def numbers_html(numbers: Numbers) -> str:
    """Return the figures as a small table."""
    factor, cross, left = (
        numbers.real_time_factor,
        numbers.cross_track_m,
        numbers.waypoints_left,
    )
    cells = (
        ('sim time', f'{numbers.time_sec:.1f} s', 'time'),
        ('real time ×', '–' if factor is None else f'{factor:.2f}', 'factor'),
        ('speed', f'{numbers.speed_m_s:.2f} m/s'.replace('-0.00', '0.00'), 'speed'),
        ('off the path', '–' if cross is None else f'{cross:+.3f} m', 'cross'),
        ('waypoints left', '–' if left is None else str(left), 'left'),
        ('collisions', str(numbers.collisions), 'collisions'),
    )
    rows = ''.join(
        '<div style="min-width:5.6em"><div style="opacity:.65;font-size:.78em">'
        f'{name}</div><b data-number="{key}" style="font-variant-numeric:tabular-nums'
        f'{";color:#e33" if key == "collisions" and numbers.collisions else ""}">{value}</b></div>'
        for name, value, key in cells
    )
    state = '<b style="color:#e80">paused</b>' if numbers.paused else ''
    return (
        '<div style="display:grid;grid-template-columns:1fr 1fr 1fr;gap:.35em .6em;'
        f'padding:.2em 1em .6em">{rows}</div><div style="padding:0 1em .3em">{state}</div>'
    )
