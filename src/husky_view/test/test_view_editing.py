# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The editor as a page uses it, without a browser: which file is written, and with what."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from husky_course.robot import RobotStart
from husky_course.waypoints import Course, load_course, Waypoint
from husky_sim.world import default_worlds, load_world
from husky_view.editor.course import CourseRefused, EditableCourse, save
from husky_view.editor.editor import Editor, NEW
from husky_view.server import ActionQueue, close_server, PageServer
from playpen_testing.page_client import PageClient
from playpen_testing.waiting import wait_until
import pytest

# Looks down at the ground, as a page in which it is clicked on does.
CLICK = {
    'type': 'ScenePointerMessage',
    'event_type': 'click',
    'ray_direction': [0.0, 0.0, -1.0],
    'screen_pos': [[0.5, 0.5]],
    'modifier': None,
}
Told = tuple[str, str, bool]


class Desk:
    """An editor on a page, and somebody at it."""

    def __init__(self, server: PageServer, tab: PageClient, folder: Path) -> None:
        self.told: list[Told] = []
        self._tab, self._actions = tab, ActionQueue()
        self._editor = Editor(
            server,
            self._actions,
            load_world(str(default_worlds() / 'empty.xml'), (RobotStart(),)),
            folder=folder,
            ground_m=0.0,
            drive=lambda _: None,
            on_editing=lambda _: None,
            notify=lambda *told: self.told.append(told),
        )

    def set(self, label: str, value: object) -> None:
        self._tab.set(label, value)

    def click(self, x: float, y: float) -> None:
        """Click on the ground."""
        self._tab.send({**CLICK, 'ray_origin': [x, y, 5.0]})

    def wait_until(self, fact: Callable[[], object], what: str) -> None:
        """Run what was clicked until there is a fact."""

        def is_so() -> object:
            self._actions.run()
            self._editor.draw()
            return fact()

        wait_until(is_so, timeout_sec=10.0, what=lambda: f'{what}; told: {self.told}')

    def wait_for_verdict(self, text: str) -> None:
        self.wait_until(lambda: text in self._editor._verdict.content, f'the verdict {text!r}')

    def save(self) -> Told:
        """Save; return what is told of it."""
        before = len(self.told)
        self.set('Save', True)
        self.wait_until(lambda: len(self.told) > before, 'a word on what was saved')
        return self.told[-1]


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    (tmp_path / 'mine.yaml').write_text(
        'speed: 0.4\ntolerance: 0.7\ncorners: sharp\nwaypoints: [[0, 0], [2, 0], [2, 2]]\n'
    )
    server = PageServer('127.0.0.1', 18690, title='editing')
    with PageClient(server.address) as tab:
        yield Desk(server, tab, tmp_path)
    close_server(server)


def test_what_is_new_has_nothing_of_the_file_that_was_open(desk: Desk, tmp_path: Path) -> None:
    mine = tmp_path / 'mine.yaml'
    before = mine.read_text()
    desk.set('Open', 'mine')
    desk.wait_for_verdict('3 waypoints')
    desk.set('Open', NEW)
    desk.wait_for_verdict('two waypoints make')
    for place in ((0.0, 0.0), (1.0, 0.0)):
        desk.click(*place)
    desk.wait_for_verdict('2 waypoints')
    title, told, is_error = desk.save()
    assert (title, is_error) == ('Saved', False), told
    assert mine.read_text() == before, 'the file that was open before is lost'
    course = load_course(tmp_path / 'my_path.yaml')
    assert (course.speed_m_s, course.tolerance_m, course.corners) == (0.5, 0.25, 'smooth')
    desk.set('Save as', 'mine')
    title, told, _ = desk.save()
    assert (title, mine.read_text()) == ('Not saved', before), told
    assert told.startswith('mine.yaml is there already: save again to replace it')
    assert desk.save()[0] == 'Saved'
    assert mine.read_text() != before


def test_every_edit_is_undone_and_what_is_deleted_is_what_was_selected() -> None:
    edited, seen = EditableCourse(), list[list[float]]()

    def places() -> list[float]:
        return [waypoint.x_m for waypoint in edited.course.waypoints]

    for number in (1, 2, 3, 4):
        edited.add(number, 0.0)
        assert edited.selected == number - 1
    edited.begin_move(1)
    edited.move(1, 2.5, 0.0)
    for change in (
        edited.delete_selected,  # the one that was moved
        edited.delete_selected,  # none is selected any more: the last one
        edited.clear,
        edited.delete_selected,
        partial(edited.load, Course(name='', waypoints=(Waypoint(9.0, 0.0),))),
    ):
        change()
        seen.append(places())
    assert seen == [[1.0, 3.0, 4.0], [1.0, 3.0], [], [], [9.0]]
    undone = list[list[float]]()
    for _ in range(5):
        edited.undo()
        undone.append(places())
    assert undone == [[], [1.0, 3.0], [1.0, 3.0, 4.0], [1.0, 2.5, 3.0, 4.0], [1.0, 2.0, 3.0, 4.0]]


def test_what_the_driver_would_refuse_is_not_saved(tmp_path: Path) -> None:
    with pytest.raises(CourseRefused, match='waypoints'):
        save(Course(name='', waypoints=(Waypoint(1.0, 0.0),) * 2), tmp_path, 'twice')
    assert list(tmp_path.iterdir()) == []


def test_a_link_stays_one_and_what_it_leads_to_is_saved(tmp_path: Path) -> None:
    shared = tmp_path / 'shared' / 'course.yaml'
    shared.parent.mkdir()
    shared.write_text('waypoints: [[1, 0]]\n')
    here = tmp_path / 'here'
    here.mkdir()
    (here / 'mine.yaml').symlink_to(shared)
    save(Course(name='', waypoints=(Waypoint(2.0, 0.0), Waypoint(3.0, 0.0))), here, 'mine')
    assert (here / 'mine.yaml').is_symlink()
    assert [waypoint.x_m for waypoint in load_course(shared).waypoints] == [2.0, 3.0]
    assert [file.name for file in (*shared.parent.iterdir(), *here.iterdir())] == [
        'course.yaml',
        'mine.yaml',
    ]
