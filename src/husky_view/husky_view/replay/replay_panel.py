# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The panel beside a replay: figures, the time slider, and the collisions to jump to."""

from collections.abc import Callable, Sequence
import math
from typing import Any

from husky_course.record import Collision
import viser

from husky_view.picture import cameras
from husky_view.picture.page import page_html
from husky_view.picture.palette import legend_html
from husky_view.replay.playback import Playback
from husky_view.work import Work

PLAY, STAND, RESTART = 'Play', 'Pause', 'From the start'
FACTORS = {'¼×': 0.25, '1×': 1.0, '2×': 2.0, '5×': 5.0, '20×': 20.0}
SLIDER_HZ = 10.0
MOST_BUTTONS = 30


class ReplayPanel:
    """The elements of the page; what is clicked is left as work for the playback's thread."""

    def __init__(
        self,
        server: viser.ViserServer,
        work: Work,
        playback: Playback,
        collisions: Sequence[Collision],
        choose_camera: Callable[[viser.ClientHandle, str], None],
    ) -> None:
        self._playback = playback
        self._later = work.put
        self._choose_camera = choose_camera
        gui = server.gui
        self._figures = gui.add_html('')
        self._page = gui.add_html(page_html())
        self._play = gui.add_button_group('Time', (STAND, RESTART))
        self._play.on_click(lambda event: self._on_time(event.target.value))
        # The last step of a slider is whole as well, or its end could not be reached.
        end = max(math.ceil(playback.duration_sec / 0.1) * 0.1, 0.1)
        self._slider = gui.add_slider('Seconds', 0.0, round(end, 1), 0.1, 0.0)
        self._slider.on_update(self._on_slider)
        factor = gui.add_button_group('Speed', tuple(FACTORS))
        factor.on_click(lambda event: self._on_factor(FACTORS[event.target.value]))
        camera = gui.add_button_group('Camera', cameras.PRESETS)
        camera.on_click(lambda event: self._on_camera(event.client, event.target.value))
        with gui.add_folder(f'Collisions: {len(collisions)}'):
            for collision in collisions[:MOST_BUTTONS]:
                button = gui.add_button(
                    f'{collision.time_sec:.1f} s  {collision.obstacle}',
                    color='red',
                    icon=viser.Icon.ALERT_TRIANGLE,
                    hint=str(collision),
                )
                button.on_click(self._jumper(collision.time_sec))
            if not collisions:
                gui.add_html('<div style="padding:0 1em .4em">none</div>')
        self._legend = gui.add_html(legend_html())

    def _on_time(self, word: str) -> None:
        if word == RESTART:
            self._later(lambda: self._playback.jump(0.0))
        else:
            self._later(self._playback.toggle)

    def _on_slider(self, event: Any) -> None:
        # Our own updates come without a client.
        if event.client is not None:
            time_sec = float(event.target.value)
            self._later(lambda: self._playback.jump(time_sec))

    def _on_factor(self, factor: float) -> None:
        self._later(lambda: setattr(self._playback, 'factor', factor))

    def _on_camera(self, client: viser.ClientHandle | None, preset: str) -> None:
        if client is not None:
            self._later(lambda: self._choose_camera(client, preset))

    def _jumper(self, time_sec: float) -> Callable[[Any], None]:
        def jump() -> None:
            self._playback.playing = False
            self._playback.jump(time_sec)

        return lambda _: self._later(jump)

    def show(self, *, speed_m_s: float, drift_m: float, collisions: int) -> None:
        """Bring the figures and the slider up to date."""
        playback = self._playback
        if (PLAY in self._play.options) == playback.playing:
            self._play.options = (STAND if playback.playing else PLAY, RESTART)
        now = min(round(playback.time_sec, 1), self._slider.max)
        if abs(now - self._slider.value) > 0.04:
            self._slider.value = now
        html = _figures_html(
            (
                ('sim time', f'{playback.time_sec:.1f} s', 'time'),
                ('of', f'{playback.duration_sec:.1f} s', 'duration'),
                ('speed', f'{speed_m_s:.2f} m/s', 'speed'),
                ('odometry is off', f'{drift_m:.3f} m', 'drift'),
                ('collisions so far', str(collisions), 'collisions'),
            )
        )
        if html != self._figures.content:
            self._figures.content = html


def _figures_html(cells: Sequence[tuple[str, str, str]]) -> str:
    rows = ''.join(
        f'<div><div style="opacity:.65;font-size:.78em">{name}</div>'
        f'<b data-number="{key}" style="font-variant-numeric:tabular-nums">{value}</b></div>'
        for name, value, key in cells
    )
    return (
        '<div style="display:grid;grid-template-columns:1fr 1fr 1fr;gap:.35em .6em;'
        f'padding:.2em 1em .6em">{rows}</div>'
    )
