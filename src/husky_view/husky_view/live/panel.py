# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The panel beside a live simulation: figures, controls, buttons that drive, and the legend."""

from collections.abc import Callable, Collection, Sequence
from functools import partial
from html import escape
import time
from typing import Any

import viser

from husky_view.live.simulator import SimulatorControl
from husky_view.live.teleop import HOLD_HZ, Teleop
from husky_view.picture.camera import add_camera_buttons
from husky_view.picture.clicks import in_order
from husky_view.picture.history import History, RunPlots
from husky_view.picture.page import (
    AT_LEGEND,
    Direction,
    figures_html,
    in_decimals,
    legend_html,
    page_html,
    RELEASE,
    show_html,
    STOP,
)
from husky_view.picture.palette import Rgb
from husky_view.server import ActionQueue, PageServer

PAUSE, RESUME, STEP, RESET = 'Pause', 'Resume', 'Step', 'Reset'
STOPPED_SEC = 1.0
"""How long a stop cannot be released: who clicks then has meant STOP, too, or clicks twice."""

FACTORS = {'½×': 0.5, '1×': 1.0, '2×': 2.0, '5×': 5.0, 'max': 0.0}


class Panel:
    """
    The elements of the panel; what is clicked is left as actions.

    :param stop: called with whether the emergency stop is to be pressed.
    :param choose_robot: called with the robot's place in `robots`.
    :param choose_camera: called with a tab and a preset.
    """

    def __init__(
        self,
        server: PageServer,
        actions: ActionQueue,
        simulator: SimulatorControl,
        *,
        robots: Sequence[str],
        stop: Callable[[bool], None],
        choose_robot: Callable[[int], None],
        choose_camera: Callable[[viser.ClientHandle, str], None],
    ) -> None:
        self.teleop = Teleop()
        self._server = server
        self._simulator = simulator
        self._later = actions.put
        self._paused = False
        self._stopped = False
        self._stopped_sec = 0.0  # when that changed
        self._press_stop = stop
        gui = server.gui
        self._warning = gui.add_html('')
        self._figures = gui.add_html('')
        self._stop = gui.add_button(STOP, color='red', icon=viser.Icon.HAND_STOP)
        self._stop.on_click(in_order(self._on_stop))
        self._time = gui.add_button_group('Time', (PAUSE, STEP, RESET))
        self._time.on_click(in_order(lambda event: self._on_time(event.target.value)))
        factors = gui.add_button_group('Speed', tuple(FACTORS))
        factors.on_click(in_order(lambda event: self._on_factor(FACTORS[event.target.value])))
        add_camera_buttons(gui, actions.put, choose_camera)
        if len(robots) > 1:
            robot = gui.add_dropdown('Robot', tuple(robots))
            robot.on_update(
                in_order(
                    lambda event: self._later(
                        partial(choose_robot, robots.index(event.target.value))
                    )
                )
            )
        self._add_drive_buttons(gui)
        self._page = gui.add_html(page_html())
        self._legend = gui.add_html('', order=AT_LEGEND)
        self._ground = gui.add_html('')
        self._plots = RunPlots(gui)

    def _add_drive_buttons(self, gui: viser.GuiApi) -> None:
        teleop = self.teleop
        self._server.tabs.on_gone(teleop.release_tab)
        with gui.add_folder('Drive: arrow keys, or hold'):
            for direction in Direction:
                button = gui.add_button(direction.sign)
                button.on_hold(in_order(partial(self._on_hold, direction)), callback_hz=HOLD_HZ)
                button.on_click(in_order(partial(self._on_release, direction)))
        speed = gui.add_slider('Drive at, m/s', 0.1, 1.0, 0.1, teleop.speed_m_s)
        speed.on_update(
            in_order(lambda event: setattr(teleop, 'speed_m_s', float(event.target.value)))
        )

    def _on_stop(self, _event: Any) -> None:
        self._later(
            lambda: self._press_stop(not self._stopped or self._stop.disabled), urgent=True
        )

    def _on_hold(self, direction: Direction, event: Any) -> None:
        self.teleop.hold(event.client_id, direction, now_sec=time.monotonic())

    def _on_release(self, direction: Direction, event: Any) -> None:
        self.teleop.release(event.client_id, direction)

    def _on_time(self, word: str) -> None:
        simulator = self._simulator
        if word in (PAUSE, RESUME):
            self._later(lambda: simulator.pause(word == PAUSE))
        else:
            self._later(simulator.step if word == STEP else simulator.reset)

    def _on_factor(self, factor: float) -> None:
        self._later(lambda: self._simulator.set_factor(factor))

    def show_stopped(self, stopped: bool, *, now_sec: float) -> None:
        """Show whether the emergency stop is pressed; call it every frame."""
        changes = stopped != self._stopped
        if changes:
            self._stopped, self._stopped_sec = stopped, now_sec
        is_new = stopped and now_sec - self._stopped_sec < STOPPED_SEC
        if self._stop.disabled != is_new:
            self._stop.disabled = is_new
        if not changes:
            return
        self._stop.color = 'orange' if stopped else 'red'
        self._stop.label = RELEASE if stopped else STOP

    def show(
        self,
        *,
        time_sec: float,
        real_time_factor: float | None,
        paused: bool,
        speed_m_s: float,
        cross_track_m: float | None,
        waypoints_left: int | None,
        collisions: int,
        colors: Collection[Rgb],
        ground: str,
        history: History,
    ) -> None:
        """
        Show the figures; None where there is no value.

        :param colors: of what there is to be seen, for the legend.
        :param ground: HTML of what the pointer is told about.
        :param history: what the plots show.
        """
        if paused != self._paused:
            self._paused = paused
            self._time.options = (RESUME if paused else PAUSE, STEP, RESET)
        factor = '–' if real_time_factor is None else f'{real_time_factor:.2f}'
        # In the place of a figure: a line that comes and goes would move the buttons.
        factor = '<span style="color:#e80">paused</span>' if paused else factor
        cross = '–' if cross_track_m is None else f'{in_decimals(cross_track_m, 3, sign="+")} m'
        left = '–' if waypoints_left is None else str(waypoints_left)
        figures = (
            ('sim time', f'{time_sec:.1f} s', 'time'),
            ('real time ×', factor, 'factor'),
            ('speed', f'{in_decimals(speed_m_s, 2)} m/s', 'speed'),
            ('off the path', cross, 'cross'),
            ('waypoints left', left, 'left'),
            ('collisions', str(collisions), 'collisions'),
        )
        red = 'collisions' if collisions else ''
        show_html(self._figures, figures_html(figures, red=red))
        show_html(self._legend, legend_html(colors))
        show_html(self._ground, ground)
        self._plots.show(history)
        now = self._simulator.factor
        show_html(self._page, page_html(active=[w for w, f in FACTORS.items() if f == now]))

    def show_warning(self, text: str) -> None:
        """Show a warning over the figures; an empty one hides it."""
        # It takes no room: below it STOP stays where it is, just when it is needed.
        place = 'position:absolute;left:0;right:0;height:6.4em;z-index:1;display:grid'
        show_html(
            self._warning, f'<div style="{place}">{warning_html(text)}</div>' if text else ''
        )

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
        f'background:#c40;color:#fff;font-size:.9em;overflow-y:auto">{escape(text)}</div>'
    )
