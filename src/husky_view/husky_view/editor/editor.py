# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The editor of waypoint files, a folder of the panel.

A click on the ground adds a waypoint, a click on a waypoint selects it, and one is moved by
dragging it. All but the elements' own callbacks runs on the thread that does the work.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from husky_sim.world import World
import numpy as np
import numpy.typing as npt
import viser

from husky_view.editor import course
from husky_view.editor.draft import Draft
from husky_view.editor.editor_marks import clearance_color, EditorMarks, ENOUGH_M, SCARCE_M
from husky_view.picture import palette
from husky_view.picture.marks import lifted
from husky_view.picture.planar import on_ground, to_odom, to_world
from husky_view.picture.scene import ABOVE_GROUND_M
from husky_view.work import Work

Array = npt.NDArray[np.float64]

NEW = '(new)'
UNDO, DELETE, CLEAR = 'Undo', 'Delete', 'Clear'
DRIVE = 'Save and drive it'
EDIT = 'Edit: click on the ground'


class Editor:
    """
    Edits one course, in the frame odom of one robot.

    :param drive: called with a saved file to drive it; None where nobody can.
    :param tell: called with a title, a text and whether it is an error.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        work: Work,
        world: World,
        *,
        folder: Path,
        ground_m: float,
        drive: Callable[[Path], None],
        tell: Callable[[str, str, bool], None],
    ) -> None:
        self.draft = Draft()
        self._server = server
        self._work = work
        self._world = world
        self._start = world.robots[0]
        self._folder = folder
        self._height_m = ground_m + ABOVE_GROUND_M
        self._drive = drive
        self._tell = tell
        self._marks = EditorMarks(server, self._on_drag)
        self._dragged: int | None = None
        self._editing = False
        with server.gui.add_folder('Waypoints', expand_by_default=False):
            self._add_elements(server.gui)

    def choose_robot(self, place: int) -> None:
        """Edit in the frame odom of another robot."""
        self._start = self._world.robots[place]
        self._show()

    def close(self) -> None:
        """Let go of the clicks on the ground."""
        self._set_editing(False)

    def _add_elements(self, gui: viser.GuiApi) -> None:
        later = self._work.put
        self._file = gui.add_dropdown('Open', (NEW, *course.files_in(self._folder)))
        self._file.on_update(lambda event: later(lambda: self._open(event.target.value)))
        self._edit = gui.add_checkbox(EDIT, False)
        self._edit.on_update(lambda event: later(lambda: self._set_editing(event.target.value)))
        change = gui.add_button_group('Change', (UNDO, DELETE, CLEAR))
        change.on_click(lambda event: later(lambda: self._on_change(event.target.value)))
        self._speed = gui.add_slider('Speed, m/s', 0.1, 1.0, 0.1, self.draft.content.speed_m_s)
        self._loop = gui.add_checkbox('Back to the first (loop)', False)
        for element in (self._speed, self._loop):
            element.on_update(lambda event: event.client and later(self._on_settings))
        self._verdict = gui.add_html('')
        self._name = gui.add_text('Save as', 'my_path')
        gui.add_button('Save').on_click(lambda _: later(self._save))
        gui.add_button(DRIVE, color='green').on_click(lambda _: later(self._save_and_drive))

    def _set_editing(self, editing: bool) -> None:
        if editing == self._editing:
            return
        self._editing = editing
        if editing:
            self._server.scene.on_click()(self._on_click)
        else:
            self._server.scene.remove_click_callback(self._on_click)
        self._show()

    def _on_click(self, event: Any) -> None:
        place = on_ground(event.ray_origin, event.ray_direction, self._height_m)
        if place is not None:
            self._work.put(lambda: self._click(place))

    def _click(self, place: Array) -> None:
        x, y = to_odom(self._start, place[None])[0]
        meant = self.draft.nearest(x, y)
        if meant is None:
            self.draft.add(x, y)
        else:
            self.draft.selected = meant
        self._show()

    def _on_drag(self, event: Any) -> None:
        if not self._editing:
            return
        eye = np.asarray(event.client.camera.position)
        place = on_ground(eye, np.asarray(event.end_position) - eye, self._height_m)
        phase, number = event.phase, event.instance_index
        self._work.put(lambda: self._drag(phase, number, place))

    def _drag(self, phase: str, number: int | None, place: Array | None) -> None:
        if phase == 'start' and number is not None and number < len(self.draft.content.points):
            self._dragged = number
            self.draft.begin_move(number)
        if self._dragged is not None and place is not None:
            self.draft.move(self._dragged, *to_odom(self._start, place[None])[0])
            self._show()
        if phase == 'end':
            self._dragged = None

    def _on_change(self, word: str) -> None:
        {UNDO: self.draft.undo, DELETE: self.draft.delete_selected, CLEAR: self.draft.clear}[
            word
        ]()
        self._show_settings()
        self._show()

    def _on_settings(self) -> None:
        self.draft.set(speed_m_s=float(self._speed.value), loop=bool(self._loop.value))
        self._show()

    def _open(self, name: str) -> None:
        if name == NEW:
            self.draft.clear()
        else:
            try:
                self.draft.load(course.load(self._folder / f'{name}.yaml'))
            except course.CourseRefused as error:
                self._tell(f'{name} cannot be edited', str(error), True)
                return
            self._name.value = name
        self._show_settings()
        self._edit.value = True
        self._set_editing(True)
        self._show()

    def _show_settings(self) -> None:
        self._speed.value = round(self.draft.content.speed_m_s, 1)
        self._loop.value = self.draft.content.loop

    def _show(self) -> None:
        if not self._editing:
            self._marks.clear()
            return
        points = np.array([(p.x, p.y) for p in self.draft.content.points]).reshape(-1, 2)
        marks = lifted(to_world(self._start, points), self._height_m)
        self._marks.show_points(marks, self.draft.selected)
        try:
            found = course.preview(self.draft, self._start, self._world.obstacles)
        except course.CourseRefused as error:
            self._marks.show_path(None, self._height_m)
            few = len(points) < 2
            self._say('two waypoints make a course' if few else str(error), palette.SCARCE)
            return
        self._marks.show_path(found, self._height_m + 0.02)
        least = float(found.clearance_m.min())
        words = 'touches something' if least <= 0.0 else f'passes {least:.2f} m from something'
        color = clearance_color(least)
        enough = '' if least >= ENOUGH_M else f'; keep {SCARCE_M} m at least'
        self._say(f'{len(points)} waypoints; {words}{enough}', color)

    def _say(self, text: str, color: palette.Rgb) -> None:
        self._verdict.content = (
            '<div data-verdict style="margin:0 1em .6em;padding-left:.6em;font-size:.85em;'
            f'white-space:pre-wrap;border-left:.4em solid {palette.css(color)}">{text}</div>'
        )

    def _save(self) -> Path | None:
        try:
            file = course.save(self.draft, self._folder, self._name.value.strip())
        except course.CourseRefused as error:
            self._tell('Not saved', str(error), True)
            return None
        self.look_for_files()
        self._tell('Saved', str(file), False)
        return file

    def look_for_files(self) -> None:
        """Offer the files that are there now; call it now and then."""
        offered = (NEW, *course.files_in(self._folder))
        if offered != tuple(self._file.options):
            self._file.options = offered

    def _save_and_drive(self) -> None:
        file = self._save()
        if file is not None:
            self._drive(file)
