# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The panel beside a replay, and the time that it controls."""

from collections.abc import Callable, Collection, Sequence
import math
from typing import Any

from husky_course.record import Collision
import viser

from husky_view.picture.camera import add_camera_buttons
from husky_view.picture.clicks import in_order
from husky_view.picture.history import History, RunPlots
from husky_view.picture.page import (
    AT_LEGEND,
    figures_html,
    in_decimals,
    legend_html,
    page_html,
    PLAY,
    show_html,
)
from husky_view.picture.palette import Rgb
from husky_view.server import ActionQueue

PAUSE, RESTART = 'Pause', 'From the start'
FACTORS = {'¼×': 0.25, '1×': 1.0, '2×': 2.0, '5×': 5.0, '20×': 20.0}
MOST_BUTTONS = 30


class Playback:
    """The time of a replay: it plays, pauses, jumps, and stops at the end."""

    def __init__(self, duration_sec: float) -> None:
        self.duration_sec = duration_sec
        self.time_sec = 0.0
        self.playing = True
        self.factor = 1.0
        self._jumped = True  # since the last step

    @property
    def at_end(self) -> bool:
        """Tell whether there is nothing left to play."""
        return self.time_sec >= self.duration_sec

    def jump(self, time_sec: float) -> None:
        """Go to a time of the run, or to the nearer end of it."""
        self.time_sec = min(max(time_sec, 0.0), self.duration_sec)
        self._jumped = True

    def play(self) -> None:
        """Play; at the end, from the start."""
        self.playing = True
        if self.at_end:
            self.jump(0.0)

    def pause(self) -> None:
        """Stand still; may be called twice."""
        self.playing = False

    def step(self, wall_sec: float) -> bool:
        """
        Advance by a wall time.

        :returns: whether there was a jump since the last step; then the past is drawn anew.
        """
        jumped, self._jumped = self._jumped, False
        if self.playing and not jumped:
            self.time_sec = min(self.time_sec + wall_sec * self.factor, self.duration_sec)
        if self.at_end:
            self.playing = False
        return jumped


class ReplayPanel:
    """
    The elements of the panel; what is clicked is left as actions.

    It stands at first: the first tab presses Play, when it has drawn the scene, unless somebody
    has gone to a collision before.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        actions: ActionQueue,
        playback: Playback,
        collisions: Sequence[Collision],
        choose_camera: Callable[[viser.ClientHandle, str], None],
    ) -> None:
        playback.playing = False
        self._has_begun = False
        self._playback = playback
        self._later = actions.put
        gui = server.gui
        self._figures = gui.add_html('')
        self._play = gui.add_button_group('Time', (PLAY, RESTART))
        self._play.on_click(in_order(lambda event: self._on_time(event.target.value)))
        # The slider's range is a whole number of steps, or its end could not be reached.
        end = max(math.ceil(playback.duration_sec / 0.1) * 0.1, 0.1)
        self._slider = gui.add_slider('Seconds', 0.0, round(end, 1), 0.1, 0.0)
        self._slider.on_update(in_order(self._on_slider))
        self._known_sec = self._slider.value  # what we have set, or heard of
        factor = gui.add_button_group('Speed', tuple(FACTORS))
        factor.on_click(in_order(lambda event: self._on_factor(FACTORS[event.target.value])))
        add_camera_buttons(gui, actions.put, choose_camera)
        with gui.add_folder(f'Collisions: {len(collisions)}'):
            for collision in collisions[:MOST_BUTTONS]:
                button = gui.add_button(
                    f'{collision.time_sec:.1f} s  {collision.obstacle}',
                    color='red',
                    icon=viser.Icon.ALERT_TRIANGLE,
                    hint=str(collision),
                )
                button.on_click(in_order(self._jumper(collision.time_sec)))
            if not collisions:
                gui.add_html('<div style="padding:0 1em .4em">none</div>')
        self._legend = gui.add_html('', order=AT_LEGEND)
        self._ground = gui.add_html('')
        self._plots = RunPlots(gui)
        self._page = gui.add_html(self._page_html())

    def _page_html(self) -> str:
        active = [word for word, factor in FACTORS.items() if factor == self._playback.factor]
        return page_html(active=active, plays=not self._has_begun)

    def _on_time(self, word: str) -> None:
        # What the word says, and no toggle: two tabs may press the same one at a time.
        playback = self._playback
        if word == RESTART:
            self._later(lambda: playback.jump(0.0))
        else:
            self._later(playback.play if word == PLAY else playback.pause)

    def _on_slider(self, event: Any) -> None:
        # Updates by the server itself have no client.
        if event.client is not None:
            time_sec = float(event.target.value)

            def jump() -> None:
                self._known_sec = time_sec
                self._playback.jump(time_sec)

            self._later(jump)

    def _on_factor(self, factor: float) -> None:
        self._later(lambda: setattr(self._playback, 'factor', factor))

    def _jumper(self, time_sec: float) -> Callable[[Any], None]:
        def jump() -> None:
            self._has_begun = True  # it stands there, also where the scene is drawn only later
            self._playback.pause()
            self._playback.jump(time_sec)

        return lambda _: self._later(jump)

    def show(
        self,
        *,
        speed_m_s: float,
        drift_m: float,
        collisions: int,
        colors: Collection[Rgb],
        ground: str,
        history: History,
    ) -> None:
        """
        Show the figures and the time.

        :param colors: of what there is to be seen, for the legend.
        :param ground: HTML of what the pointer is told about.
        :param history: what the plots show.
        """
        playback = self._playback
        self._has_begun = self._has_begun or playback.playing
        show_html(self._page, self._page_html())
        show_html(self._legend, legend_html(colors))
        show_html(self._ground, ground)
        self._plots.show(history)
        if (PLAY in self._play.options) == playback.playing:
            self._play.options = (PAUSE if playback.playing else PLAY, RESTART)
        now = min(round(playback.time_sec, 1), self._slider.max)
        # Moved by somebody a moment ago, it stays until that is heard: the event has no value of
        # its own, so that what is set meanwhile would be taken for it.
        is_ours = self._slider.value == self._known_sec
        if is_ours and abs(now - self._known_sec) > 0.04:
            self._slider.value = self._known_sec = now
        figures = figures_html(
            (
                ('sim time', f'{playback.time_sec:.1f} s', 'time'),
                ('of', f'{playback.duration_sec:.1f} s', 'duration'),
                ('speed', f'{in_decimals(speed_m_s, 2)} m/s', 'speed'),
                ('odometry is off', f'{drift_m:.3f} m', 'drift'),
                ('collisions so far', str(collisions), 'collisions'),
            )
        )
        show_html(self._figures, figures)
