# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The panel beside a live simulation: figures, controls, buttons that drive, and the legend."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape
import time
from typing import Any

import viser

from husky_view.live.teleop import HOLD_HZ, Teleop
from husky_view.picture.camera import PRESETS
from husky_view.picture.page import Direction, figures_html, legend_html, RELEASE, STOP
from husky_view.server import ActionQueue

PAUSE, RESUME, STEP, RESET = 'Pause', 'Resume', 'Step', 'Reset'
FACTORS = {'½×': 0.5, '1×': 1.0, '2×': 2.0, '5×': 5.0, 'max': 0.0}


@dataclass(frozen=True, kw_only=True)
class Figures:
    """What the panel shows in figures; None where there is no value."""

    time_sec: float
    real_time_factor: float | None
    paused: bool
    speed_m_s: float
    cross_track_m: float | None
    waypoints_left: int | None
    collisions: int


@dataclass(frozen=True, kw_only=True)
class Controls:
    """What the clicks do; called on the thread that runs the actions."""

    pause: Callable[[bool], None]
    step: Callable[[], None]
    reset: Callable[[], None]
    set_factor: Callable[[float], None]
    stop: Callable[[bool], None]
    choose_robot: Callable[[int], None]
    choose_camera: Callable[[viser.ClientHandle, str], None]


class Panel:
    """The elements of the panel."""

    def __init__(
        self,
        server: viser.ViserServer,
        actions: ActionQueue,
        controls: Controls,
        *,
        robots: Sequence[str],
    ) -> None:
        self.teleop = Teleop()
        self._server = server
        self._controls = controls
        self._later = later = actions.put
        self._paused = False
        self._stopped = False
        gui = server.gui
        self._warning = gui.add_html('', visible=False)
        self._figures = gui.add_html('')
        self._stop = gui.add_button(STOP, color='red', icon=viser.Icon.HAND_STOP)
        self._stop.on_click(lambda _: later(lambda: controls.stop(not self._stopped)))
        self._time = gui.add_button_group('Time', (PAUSE, STEP, RESET))
        self._time.on_click(lambda event: self._on_time(event.target.value))
        factors = gui.add_button_group('Speed', tuple(FACTORS))
        factors.on_click(lambda event: self._on_factor(FACTORS[event.target.value]))
        camera = gui.add_button_group('Camera', PRESETS)
        camera.on_click(lambda event: self._on_camera(event.client, event.target.value))
        if len(robots) > 1:
            robot = gui.add_dropdown('Robot', tuple(robots))
            robot.on_update(
                lambda event: later(
                    lambda: controls.choose_robot(robots.index(event.target.value))
                )
            )
        self._add_drive_buttons(gui)
        gui.add_html(legend_html())

    def _add_drive_buttons(self, gui: viser.GuiApi) -> None:
        teleop = self.teleop
        self._server.on_client_disconnect(lambda client: teleop.release_tab(client.client_id))
        with gui.add_folder('Drive: arrow keys, or hold'):
            for direction in Direction:
                button = gui.add_button(direction.sign)
                button.on_hold(self._on_hold(direction), callback_hz=HOLD_HZ)
                button.on_click(self._on_release(direction))
        speed = gui.add_slider('Drive at, m/s', 0.1, 1.0, 0.1, teleop.speed_m_s)
        speed.on_update(lambda event: setattr(teleop, 'speed_m_s', float(event.target.value)))

    # Coroutines run on the server's own thread, and so in order.

    def _on_hold(self, direction: Direction) -> Callable[[Any], Any]:
        async def hold(event: Any) -> None:
            self.teleop.hold(event.client_id, direction, now_sec=time.monotonic())

        return hold

    def _on_release(self, direction: Direction) -> Callable[[Any], Any]:
        async def release(event: Any) -> None:
            self.teleop.release(event.client_id, direction)

        return release

    def _on_time(self, word: str) -> None:
        controls = self._controls
        if word in (PAUSE, RESUME):
            self._later(lambda: controls.pause(word == PAUSE))
        else:
            self._later(controls.step if word == STEP else controls.reset)

    def _on_factor(self, factor: float) -> None:
        self._later(lambda: self._controls.set_factor(factor))

    def _on_camera(self, client: viser.ClientHandle | None, preset: str) -> None:
        if client is not None:
            self._later(lambda: self._controls.choose_camera(client, preset))

    def show_stopped(self, stopped: bool) -> None:
        """Show whether the emergency stop is pressed."""
        self._stopped = stopped
        self._stop.label = RELEASE if stopped else STOP
        self._stop.color = 'orange' if stopped else 'red'

    def show(self, figures: Figures) -> None:
        """Show the figures."""
        if figures.paused != self._paused:
            self._paused = figures.paused
            self._time.options = (RESUME if figures.paused else PAUSE, STEP, RESET)
        html = _figures_html(figures)
        if html != self._figures.content:
            self._figures.content = html

    def show_warning(self, text: str) -> None:
        """Show a warning at the top; an empty one hides it."""
        html = warning_html(text) if text else ''
        if html != self._warning.content:
            self._warning.content = html
            self._warning.visible = bool(text)

    def notify(self, title: str, body: str, error: bool) -> None:
        """Show a notification in every tab for 6 s."""
        for client in self._server.get_clients().values():
            client.add_notification(
                title, body, auto_close_seconds=6.0, color='red' if error else 'blue'
            )


def warning_html(text: str) -> str:
    """Return a red box with a text."""
    return (
        '<div data-trouble style="margin:.3em .9em .6em;padding:.5em .7em;border-radius:.3em;'
        f'background:#c40;color:#fff;font-size:.9em">{escape(text)}</div>'
    )


def _figures_html(figures: Figures) -> str:
    factor, cross = figures.real_time_factor, figures.cross_track_m
    left = figures.waypoints_left
    table = figures_html(
        (
            ('sim time', f'{figures.time_sec:.1f} s', 'time'),
            ('real time ×', '–' if factor is None else f'{factor:.2f}', 'factor'),
            ('speed', f'{figures.speed_m_s:.2f} m/s'.replace('-0.00', '0.00'), 'speed'),
            ('off the path', '–' if cross is None else f'{cross:+.3f} m', 'cross'),
            ('waypoints left', '–' if left is None else str(left), 'left'),
            ('collisions', str(figures.collisions), 'collisions'),
        ),
        red='collisions' if figures.collisions else '',
    )
    state = '<b style="color:#e80">paused</b>' if figures.paused else ''
    return f'{table}<div style="padding:0 1em .3em">{state}</div>'
