# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Plays a recorded run in the browser. Needs no ROS."""

import argparse
from collections.abc import Sequence
from pathlib import Path
import signal
import sys
from threading import Event
import time
from typing import Any, NoReturn

from husky_course.record import Record, RecordRefused
from husky_sim.errors import SimulatorError
from husky_sim.world import load_world
import numpy as np
import viser

from husky_view.editor.course import CourseRefused, path_of
from husky_view.ending import end_soon
from husky_view.picture.picture import Picture
from husky_view.picture.planar import to_world
from husky_view.replay.playback import Playback
from husky_view.replay.replay_panel import ReplayPanel, SLIDER_HZ
from husky_view.replay.run import load_run, RunScenes
from husky_view.server import address_of, AddressError, close_server, open_server
from husky_view.work import Work

WAYPOINTS_FILE = 'waypoints.yaml'
FRAME_SEC = 1.0 / 30.0
BAD_INPUT = 2


class Replay:
    """A run on the page."""

    def __init__(self, server: viser.ViserServer, run: Record) -> None:
        """
        Put the run's world on the page.

        :raises SimulatorError: if the world is gone.
        :raises RecordRefused: if it is not the same any more.
        """
        self._server = server
        self._run = run
        world = load_world(run.world, run.robots)
        self._picture = Picture(server, world)
        self._scenes = RunScenes(run, world)
        self.playback = Playback(run.duration_sec)
        self._work = Work()
        self._panel = ReplayPanel(
            server, self._work, self.playback, run.collisions, self._on_choose_camera
        )
        self._shown = 0  # the entry shown last
        self._told = 0  # collisions shown
        self._panel_due_sec = 0.0

    def show_course(self, file: Path) -> None:
        """
        Show the path that was to be driven.

        :raises CourseRefused: if it cannot be read.
        """
        line, waypoints = path_of(file)
        self._picture.robots[0].set_path(line)
        self._picture.robots[0].set_waypoints(waypoints)

    def frame(self, wall_sec: float, *, now_sec: float) -> None:
        """Let so much wall time pass; now is of a steady clock."""
        self._work.do()
        playback, run = self.playback, self._run
        jumped = playback.step(wall_sec)
        entry = run.row_at(playback.time_sec)
        if jumped:
            self._picture.clear()
            self._picture.time_sec = 0.0
            self._shown = self._told = 0
        if jumped or entry != self._shown:
            self._picture.show(
                self._scenes.scene(min(self._shown, entry), entry, paused=not playback.playing)
            )
            self._shown = entry
        self._show_collisions(now_sec)
        self._picture.draw(now_sec)
        if jumped or now_sec >= self._panel_due_sec:
            self._panel_due_sec = now_sec + 1.0 / SLIDER_HZ
            self._show_figures(entry)
        self._server.flush()

    def _show_collisions(self, now_sec: float) -> None:
        collisions = self._run.collisions
        while (
            self._told < len(collisions)
            and collisions[self._told].time_sec <= self.playback.time_sec + 1e-6
        ):
            self._picture.collide(collisions[self._told], now_sec=now_sec)
            self._told += 1

    def _show_figures(self, entry: int) -> None:
        followed = self._picture.followed
        names = ('x', 'y', 'odom_x', 'odom_y', 'speed_m_s')
        x, y, odom_x, odom_y, speed_m_s = (
            float(self._run.column(followed, name)[entry]) for name in names
        )
        believed = to_world(self._run.robots[followed], np.array([[odom_x, odom_y]]))[0]
        self._panel.show(
            speed_m_s=speed_m_s,
            drift_m=float(np.hypot(*(believed - (x, y)))),
            collisions=self._told,
        )

    def _on_choose_camera(self, client: Any, preset: str) -> None:
        followed = self._picture.followed
        self._picture.cameras.choose(
            client,
            preset,
            robot=self._picture.scene.position(followed),
            yaw=self._picture.robots[followed].yaw,
            now_sec=time.monotonic(),
        )


class _Parser(argparse.ArgumentParser):
    """Refuses with one line instead of the whole usage."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f'{self.prog}: {message}; see {self.prog} --help\n')


def main(args: Sequence[str] | None = None) -> int:
    """Replay a run until interrupted."""
    parser = _Parser(prog='replay', description=__doc__, allow_abbrev=False)
    parser.add_argument('record', help="the record of a run, or the folder of its report's")
    parser.add_argument('--host', default='127.0.0.1', help='address to serve the page at')
    parser.add_argument('--port', type=int, default=8080, help='port; the next free one if taken')
    parser.add_argument(
        '--waypoints', help=f"the course that was to be driven (the report's {WAYPOINTS_FILE})"
    )
    options = parser.parse_args(None if args is None else list(args)[1:])
    ended = Event()
    _end_on_signal(ended)
    try:
        run = load_run(options.record)
        server = open_server(options.host, options.port, title='Husky replay')
    except (RecordRefused, AddressError) as error:
        print(f'replay: {error}', file=sys.stderr)
        return BAD_INPUT
    try:
        replay = Replay(server, run)
        beside = Path(run.file).with_name(WAYPOINTS_FILE)
        if options.waypoints or beside.is_file():
            replay.show_course(Path(options.waypoints or beside))
        print(f'replay of {run.file}: look at {address_of(server)} (Ctrl-C ends)', flush=True)
        _play(replay, ended)
    except (SimulatorError, RecordRefused, CourseRefused) as error:
        print(f'replay: {error}', file=sys.stderr)
        return BAD_INPUT
    finally:
        close_server(server)
    return 0


def _end_on_signal(ended: Event) -> None:
    def on_signal(*_: object) -> None:
        ended.set()
        end_soon()

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, on_signal)


def _play(replay: Replay, ended: Event) -> None:
    before = time.monotonic()
    while not ended.wait(FRAME_SEC):
        now = time.monotonic()
        replay.frame(now - before, now_sec=now)
        before = now


if __name__ == '__main__':
    sys.exit(main())
