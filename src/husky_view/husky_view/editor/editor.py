# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The editor of waypoint files, a folder of the panel.

A click on the ground adds a waypoint, a click on a waypoint selects it, a drag moves it. The
callbacks of viser leave actions; everything else runs on the thread that runs them.
"""

from collections.abc import Callable
from functools import partial
from html import escape
from pathlib import Path
from typing import Any

from husky_course.frames import Array
from husky_course.waypoints import Course
from husky_sim.world import World
import numpy as np
import viser

from husky_view.editor import course
from husky_view.picture import palette
from husky_view.picture.clicks import in_order
from husky_view.picture.geometry import on_ground, to_odom, to_world
from husky_view.picture.marks import add_line, lifted, NumberedDiscs
from husky_view.picture.page import ON_TOP
from husky_view.picture.scene import ABOVE_GROUND_M
from husky_view.server import ActionQueue

NEW, NEW_NAME = '(new)', 'my_path'
UNDO, DELETE, CLEAR = 'Undo', 'Delete', 'Clear'
DRIVE = 'Save and drive it'
EDIT = 'Edit: click on the ground'

ENOUGH_M, SCARCE_M = 0.30, 0.15
"""Clearances: comfortable from the first on; a good drive needs the second."""

_ROOM = 'height:4.7em;overflow-y:auto;margin:0 1em .6em;font-size:.85em'
"""Of the verdict: three lines, also where it has fewer, or it would move the buttons below it."""

_PATH, _TOO_NEAR = '/editor/path', f'{ON_TOP}editor/too_near'


def _clearance_color(clearance_m: float) -> palette.Rgb:
    if clearance_m >= ENOUGH_M:
        return palette.CLEAR
    return palette.SCARCE if clearance_m >= SCARCE_M else palette.BLOCKED


class Editor:
    """
    Edits one course, in the frame odom of one robot.

    :param drive: called with a saved file to drive it.
    :param on_editing: called with whether it is edited, when that changes.
    :param notify: called with a title, a text and whether it is an error.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        actions: ActionQueue,
        world: World,
        *,
        folder: Path,
        ground_m: float,
        drive: Callable[[Path], None],
        on_editing: Callable[[bool], None],
        notify: Callable[[str, str, bool], None],
    ) -> None:
        self._edited = course.EditableCourse()
        self._server = server
        self._later = actions.put
        self._world = world
        self._start = world.robots[0]
        self._folder = folder
        self._height_m = ground_m + ABOVE_GROUND_M
        self._drive = drive
        self._on_editing = on_editing
        self._colors: frozenset[palette.Rgb] = frozenset()
        self._notify = notify
        self._discs = NumberedDiscs(
            server,
            '/editor',
            radius_m=0.18,
            height_m=0.03,
            color=palette.EDITED,
            highlight=palette.SELECTED,
            on_drag=self._on_drag,
        )
        self._seen: dict[Path, tuple[int, ...] | None] = {}  # files, as they were read or written
        self._stands_in: tuple[Path, Course] | None = None  # what was last read or written
        self._tried: tuple[int, ...] | None = None  # of that file, to read it again
        self._dragged: dict[int, int] = {}  # by tab
        self._editing = False
        self._changed = False  # since it was drawn
        with server.gui.add_folder('Waypoints', expand_by_default=False):
            self._add_elements(server.gui)

    def choose_robot(self, place: int) -> None:
        """Edit in the frame odom of another robot."""
        self._start = self._world.robots[place]
        self._changed = True

    def colors(self) -> frozenset[palette.Rgb]:
        """Return the colours of the path that is edited, for the legend."""
        return self._colors

    def close(self) -> None:
        """Stop taking clicks on the ground."""
        self._set_editing(False)

    def _add_elements(self, gui: viser.GuiApi) -> None:
        later = self._later
        self._file = gui.add_dropdown('Open', (NEW, *course.files_in(self._folder)))
        # viser goes back to the first where the file that is edited is there no more.
        self._file.on_update(
            in_order(lambda event: event.client and later(partial(self._open, event.target.value)))
        )
        self._edit = gui.add_checkbox(EDIT, False)
        self._edit.on_update(
            in_order(lambda event: later(lambda: self._set_editing(event.target.value)))
        )
        change = gui.add_button_group('Change', (UNDO, DELETE, CLEAR))
        change.on_click(in_order(lambda event: later(partial(self._change, event.target.value))))
        self._speed = gui.add_slider('Speed, m/s', 0.1, 1.0, 0.1, self._edited.course.speed_m_s)
        self._loop = gui.add_checkbox('Back to the first (loop)', False)
        self._speed.on_update(in_order(lambda event: event.client and later(self._on_speed)))
        self._loop.on_update(in_order(lambda event: event.client and later(self._on_loop)))
        self._verdict = gui.add_html(f'<div style="{_ROOM}"></div>')
        self._name = gui.add_text('Save as', NEW_NAME)
        gui.add_button('Save').on_click(in_order(lambda _: later(self._save)))
        drive = gui.add_button(DRIVE, color='green')
        drive.on_click(in_order(lambda _: later(self._save_and_drive)))

    def _set_editing(self, editing: bool) -> None:
        if editing == self._editing:
            return
        self._editing = editing
        self._on_editing(editing)
        if editing:
            self._server.scene.on_click()(self._on_click)
        else:
            self._server.scene.remove_click_callback(self._on_click)
        self._changed = True

    async def _on_click(self, event: Any) -> None:  # a coroutine: clicks come in order
        place = on_ground(event.ray_origin, event.ray_direction, self._height_m)
        if place is not None:
            self._later(lambda: self._click(place))

    def _click(self, place: Array) -> None:
        x, y = to_odom(self._start, place[None])[0]
        meant = self._edited.nearest(x, y)
        if meant is None:
            self._edited.add(x, y)
        else:
            self._edited.selected = meant
        self._changed = True

    def _on_drag(self, event: Any) -> None:
        if not self._editing:
            return
        eye = np.asarray(event.client.camera.position)
        place = on_ground(eye, np.asarray(event.end_position) - eye, self._height_m)
        tab, phase, number = event.client_id, event.phase, event.instance_index
        self._later(lambda: self._drag(tab, phase, number, place))

    def _drag(self, tab: int, phase: str, number: int | None, place: Array | None) -> None:
        if phase == 'start' and number is not None and number < len(self._edited.course.waypoints):
            self._dragged[tab] = number
            self._edited.begin_move(number)
        if tab in self._dragged and place is not None:
            self._edited.move(self._dragged[tab], *to_odom(self._start, place[None])[0])
            self._changed = True
        if phase == 'end':
            self._dragged.pop(tab, None)

    def _change(self, word: str) -> None:
        edited = self._edited
        self._dragged.clear()  # in another tab: there may be fewer of them now
        {UNDO: edited.undo, DELETE: edited.delete_selected, CLEAR: edited.clear}[word]()
        self._show_settings()
        self._changed = True

    # Each by itself: the slider shows the speed of a file in tenths.
    def _on_speed(self) -> None:
        self._edited.set_speed(float(self._speed.value))
        self._changed = True

    def _on_loop(self) -> None:
        self._edited.set_loop(bool(self._loop.value))
        self._changed = True

    def _open(self, name: str) -> None:
        self._dragged.clear()
        if name == NEW:
            self._edited.load(course.EMPTY)
            self._name.value = NEW_NAME
            self._stands_in = None
            self._seen.clear()  # no file has what is edited now
        elif self._read(self._folder / f'{name}.yaml'):
            self._name.value = name
        else:
            return
        self._show_settings()
        self._edit.value = True
        self._set_editing(True)
        self._changed = True

    def _read(self, file: Path) -> bool:
        stamp = course.stamp(file)
        try:
            self._edited.load(course.load(file))
        except course.CourseRefused as error:
            self._notify(f'{file.stem} cannot be edited', str(error), True)
            return False
        self._hold(file, stamp)
        return True

    def _hold(self, file: Path, stamp: tuple[int, ...] | None) -> None:
        self._seen[file] = stamp
        self._stands_in = file, self._edited.course

    def _follow_file(self) -> None:
        """Take what somebody else has written into the file, if nothing was changed here."""
        if self._stands_in is None or self._dragged:
            return
        file, as_it_was = self._stands_in
        now = course.stamp(file)
        if now in (None, self._seen[file], self._tried) or as_it_was != self._edited.course:
            return
        self._tried = now
        if self._read(file):
            self._show_settings()
            self._changed = True

    def _show_settings(self) -> None:
        self._speed.value = round(self._edited.course.speed_m_s, 1)
        self._loop.value = self._edited.course.loop

    def draw(self) -> None:
        """Draw what has changed; once a frame, however much was clicked."""
        if not self._changed:
            return
        self._changed = False
        for name in (_PATH, _TOO_NEAR):
            self._server.scene.remove_by_name(name)
        self._colors = frozenset()
        if not self._editing:
            self._discs.show(np.zeros((0, 3)))
            return
        points = np.array([(p.x_m, p.y_m) for p in self._edited.course.waypoints]).reshape(-1, 2)
        place = self._edited.selected
        self._discs.show(
            lifted(to_world(self._start, points), self._height_m),
            highlighted=slice(0) if place is None else slice(place, place + 1),
            note='' if place is None else f'  ({points[place][0]:.2f}, {points[place][1]:.2f})',
        )
        try:
            seen = course.preview(self._edited.course, self._start, self._world.obstacles)
        except course.CourseRefused as error:
            few = len(points) < 2
            self._say('two waypoints make a course' if few else str(error), palette.SCARCE)
            return
        self._show_path(seen.line, seen.clearance_m)
        least = float(seen.clearance_m.min())
        words = f'passes {least:.2f} m from {seen.nearest}' if seen.nearest else 'nothing near'
        if least <= 0.0:
            words = f'touches {seen.nearest}'
        color = _clearance_color(least)
        enough = '' if least >= ENOUGH_M else f'; keep {SCARCE_M} m from bumpers and wheels'
        self._say(f'{len(points)} waypoints; {words}{enough}', color)

    def _show_path(self, line: Array, clearance_m: Array) -> None:
        if len(line) < 2:
            return
        each = [_clearance_color(float(distance_m)) for distance_m in clearance_m]
        self._colors = frozenset(each)
        points, colors = lifted(line, self._height_m + 0.02), np.array(each, dtype=np.uint8)
        add_line(
            self._server,
            _PATH,
            points,
            np.stack([colors[:-1], colors[1:]], axis=1),
            thickness_px=4.0,
        )
        # Over everything: it is the obstacle in the way that would hide it.
        near = (clearance_m < SCARCE_M)[:-1] & (clearance_m < SCARCE_M)[1:]
        if near.any():
            self._server.scene.add_line_segments(
                _TOO_NEAR,
                np.stack([points[:-1], points[1:]], axis=1)[near].astype(np.float32),
                palette.BLOCKED,
                thickness=7.0,
                thickness_units='screen',
            )

    def _say(self, text: str, color: palette.Rgb) -> None:
        self._verdict.content = (
            f'<div data-verdict style="{_ROOM};padding-left:.6em;'
            f'white-space:pre-wrap;border-left:.4em solid {palette.css(color)}">'
            f'{escape(text)}</div>'
        )

    def _save(self) -> Path | None:
        name = self._name.value.strip()
        try:
            self._check_seen(course.file_of(self._folder, name))
            file = course.save(self._edited.course, self._folder, name)
        except course.CourseRefused as error:
            self._notify('Not saved', str(error), True)
            return None
        self._hold(file, course.stamp(file))
        self.look_for_files()
        self._notify('Saved', str(file), False)
        return file

    def _check_seen(self, file: Path) -> None:
        """Refuse, once, to replace what somebody else has written."""
        now = course.stamp(file)
        if now is None or now == self._seen.get(file):
            return
        was_here = file in self._seen
        self._seen[file] = now
        how = 'not as it was opened or saved here' if was_here else 'there already'
        raise course.CourseRefused(
            f'{file.name} is {how}: save again to replace it, or take another name'
        )

    def look_for_files(self) -> None:
        """Offer the files that are there now, and show the one that is edited as it is now."""
        try:
            offered = (NEW, *course.files_in(self._folder))
        except OSError:  # the process has too many files open, or a network does not answer
            return
        if offered != tuple(self._file.options):
            self._file.options = offered
        self._follow_file()

    def _save_and_drive(self) -> None:
        file = self._save()
        if file is not None:
            self._drive(file)
