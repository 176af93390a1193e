# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Play a recorded run in the browser. Needs no ROS."""

from collections.abc import Sequence
import os
from pathlib import Path
import signal
import sys
import time
from typing import NoReturn

from husky_course.record import COURSE_NAME, Record, RecordRefused
from husky_runtime.command_line import BAD_INPUT, Parser
from husky_runtime.web_address import AddressError
from husky_sim.errors import SimulatorError
from husky_sim.world import load_world
import numpy as np

from husky_view.editor.course import CourseRefused, path_of
from husky_view.picture.geometry import to_world
from husky_view.picture.picture import Picture
from husky_view.replay.panel import Playback, ReplayPanel
from husky_view.replay.run import load_run, RunScenes
from husky_view.server import ActionQueue, close_server, PageServer

FRAME_SEC = 1.0 / 30.0
PANEL_HZ = 10.0


class Replay:
    """A run on the page."""

    def __init__(self, server: PageServer, run: Record) -> None:
        """
        Put the run's world on the page.

        :raises SimulatorError: if the world is gone.
        :raises RecordRefused: if it is not the same any more.
        """
        self._server = server
        self._run = run
        world = load_world(run.world, run.robots)
        self._picture = Picture(server, server.tabs, world)
        self._scenes = RunScenes(run, world)
        self._playback = Playback(run.duration_sec)
        self._actions = ActionQueue()
        self._panel = ReplayPanel(
            server, self._actions, self._playback, run.collisions, self._picture.choose_camera
        )
        self._entry = 0  # the one drawn last
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
        """Advance by a wall time; now is of a steady clock."""
        self._actions.run()
        playback = self._playback
        jumped = playback.step(wall_sec)
        entry = self._run.row_at(playback.time_sec)
        if jumped:
            self._picture.clear()
            self._entry = 0
        if jumped or entry != self._entry:
            self._picture.show(
                self._scenes.scene(min(self._entry, entry), entry, paused=not playback.playing)
            )
            self._entry = entry
        self._show_collisions(now_sec)
        self._picture.draw(now_sec)
        if jumped or now_sec >= self._panel_due_sec:
            self._panel_due_sec = now_sec + 1.0 / PANEL_HZ
            self._show_figures(entry)
        self._server.flush()

    def _show_collisions(self, now_sec: float) -> None:
        marks = self._picture.collisions
        for collision in self._run.collisions[marks.count :]:
            if collision.time_sec > self._playback.time_sec + 1e-6:
                break
            marks.add(collision, now_sec=now_sec)

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
            collisions=self._picture.collisions.count,
            colors=self._picture.colors(),
            ground=self._picture.ground_html(),
            history=self._picture.history,
        )


def main(args: Sequence[str] | None = None) -> int:
    """Replay a run until interrupted."""
    parser = Parser(prog='replay', description=__doc__, allow_abbrev=False)
    parser.add_argument(
        'record',
        nargs='?',
        default='report',
        help='the record of a run, or the folder of its report (default: %(default)s)',
    )
    parser.add_argument(
        '--host', default='127.0.0.1', help='address to serve the page at (default: %(default)s)'
    )
    parser.add_argument(
        '--port',
        type=int,
        default=8080,
        help='port; the next free one if taken (default: %(default)s)',
    )
    parser.add_argument(
        '--names',
        type=str.split,
        action='extend',
        default=[],
        help='more names under which the page may be asked for; several in quotes',
    )
    parser.add_argument(
        '--waypoints', help=f"the course that was to be driven (the report's {COURSE_NAME})"
    )
    options = parser.parse_args(None if args is None else list(args)[1:])
    _end_on_signal()
    try:
        run = load_run(options.record)
        server = PageServer(options.host, options.port, title='Husky replay', names=options.names)
    except (RecordRefused, AddressError) as error:
        print(f'replay: {error}', file=sys.stderr)
        return BAD_INPUT
    try:
        replay = Replay(server, run)
        beside = Path(run.file).with_name(COURSE_NAME)
        if options.waypoints or beside.is_file():
            replay.show_course(Path(options.waypoints or beside))
        print(f'replay of {run.file}: look at {server.address} (Ctrl-C ends)', flush=True)
        _play(replay)
    except (SimulatorError, RecordRefused, CourseRefused) as error:
        print(f'replay: {error}', file=sys.stderr)
        return BAD_INPUT
    finally:
        close_server(server)


def _end_on_signal() -> None:
    # At once: nothing is to be saved, and a page finds its connection closed either way.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(0))


def _play(replay: Replay) -> NoReturn:
    before = time.monotonic()
    while True:
        time.sleep(FRAME_SEC)
        now = time.monotonic()
        replay.frame(now - before, now_sec=now)
        before = now


if __name__ == '__main__':
    sys.exit(main())
