# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The waypoint editor in a real browser: what is clicked is saved, and driven."""

from collections.abc import Iterator, Sequence
import math
from pathlib import Path

from husky_course.robot import RobotStart
from husky_course.waypoints import load_course
from husky_sim.world import default_worlds, load_world
from husky_view.picture.camera import PANEL_PX, TOP_MARGIN
from husky_view.picture.geometry import bounds
from playpen_testing.browser import button, drag, errors, open_editor, Place, places
from playpen_testing.view_lab import Lab, view_lab
from playpen_testing.waiting import wait_until
from playwright.sync_api import Browser, expect, Page
import pytest

from husky_grader import check

SIZE = (1000, 700)
NAME = 'clicked'
FOV, CENTER_M, GROUND_M = math.radians(50.0), 0.5, 0.07
# In the world, which is the frame odom here: clear of every obstacle.
PLACES: tuple[Place, ...] = ((0.0, 0.0), (-2.0, 0.5), (-4.0, 0.0))


@pytest.fixture(scope='module')
def lab(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    with view_lab(tmp_path_factory.mktemp('editor'), browser) as started:
        yield started


@pytest.fixture(scope='module')
def page(lab: Lab) -> Page:
    """Open the editor and look from above."""
    page = lab.open(*SIZE)
    look_from_above(page)
    open_editor(page)
    page.get_by_label('Edit: click on the ground').check()
    verdict = page.locator('[data-verdict]')
    wait_until(verdict.is_visible, timeout_sec=30.0, what=lambda: f'a verdict: {lab.view.output}')
    return page


def on_screen(x: float, y: float) -> Place:
    """Return where the preset Top shows a place of the ground."""
    outlines = load_world(str(default_worlds() / 'playpen.xml'), [RobotStart()]).obstacles
    low_x, high_x, low_y, high_y = bounds(outlines, at_least_m=0.0)
    free = SIZE[0] - PANEL_PX
    half_m = TOP_MARGIN * max(high_y - low_y, (high_x - low_x) * SIZE[1] / free) / 2.0
    at = (low_x + high_x) / 2.0 + PANEL_PX * half_m / SIZE[1], (low_y + high_y) / 2.0
    # The ground is below what it looks at, and seems a little smaller.
    pixels = SIZE[1] / 2.0 / (half_m + (CENTER_M - GROUND_M) * math.tan(FOV / 2.0))
    return SIZE[0] / 2.0 + pixels * (x - at[0]), SIZE[1] / 2.0 - pixels * (y - at[1])


def pointed_at(page: Page) -> Place:
    """Return the place of the ground that the page tells, far away where it tells of none."""
    told = page.locator('#husky-pointer').inner_text().replace('\u2212', '-').split()
    return (float(told[1]), float(told[3])) if told else (math.inf, math.inf)


def look_from_above(page: Page) -> None:
    """Look from above, and wait for it: before, a click would be elsewhere on the ground."""
    button(page, 'Top').click()

    def is_above() -> bool:
        for place in ((0.0, 0.0), (-2.0, 0.5)):  # the page tells of a place when the mouse moves
            page.mouse.move(*on_screen(*place))
        return math.dist(pointed_at(page), place) < 0.1

    wait_until(is_above, timeout_sec=30.0, what=lambda: f'a look from above: {pointed_at(page)}')


def saved(lab: Lab) -> list[Place]:
    course = load_course(lab.folder / f'{NAME}.yaml')
    return [(point.x_m, point.y_m) for point in course.waypoints]


def distances(ones: Sequence[Place], others: Sequence[Place]) -> float:
    """Return the greatest distance between two lists of places."""
    return max(math.dist(one, other) for one, other in zip(ones, others, strict=True))


@pytest.mark.timeout(180)
def test_what_is_clicked_and_dragged_is_saved_and_valid(
    lab: Lab, page: Page, capsys: pytest.CaptureFixture[str]
) -> None:
    before = places(page)
    for count, place in enumerate(PLACES, start=1):
        page.mouse.click(*on_screen(*place))
        verdict = 'two waypoints' if count == 1 else f'{count} waypoints'
        expect(page.locator('[data-verdict]')).to_contain_text(verdict)
    after = places(page)
    for name in ('Undo', 'Save', 'Save and drive it'):
        assert after[name] == before[name], f'a press would end beside {name}'
    page.locator('//label[.="Save as"]/following::input').first.fill(NAME)
    button(page, 'Save').click()
    file = lab.folder / f'{NAME}.yaml'
    wait_until(file.is_file, timeout_sec=20.0, what=f'{file.name}')
    assert distances(saved(lab), PLACES) < 0.12
    drag(page, on_screen(*PLACES[2]), on_screen(-4.0, -2.0))
    button(page, 'Save').click()
    wait_until(
        lambda: math.dist(saved(lab)[2], (-4.0, -2.0)) < 0.25,
        timeout_sec=20.0,
        what=lambda: f'the third waypoint near (-4, -2): {saved(lab)}',
    )
    assert distances(saved(lab)[:2], PLACES[:2]) < 0.12, 'others moved as well'
    assert check.main([str(file)]) == 0, capsys.readouterr().err
    assert errors(page) == []


@pytest.mark.timeout(60)
def test_the_pointer_tells_where_it_is_and_what_is_there(page: Page) -> None:
    pointer = page.locator('#husky-pointer')
    page.mouse.move(*on_screen(-2.0, 0.5))
    expect(pointer).to_be_visible()
    assert math.dist(pointed_at(page), (-2.0, 0.5)) < 0.1
    page.mouse.move(*on_screen(2.45, 0.0))
    expect(pointer).to_contain_text('jersey_barrier_15')
    page.mouse.move(SIZE[0] - PANEL_PX / 2.0, 100.0)
    expect(pointer).to_be_hidden()


@pytest.mark.timeout(180)
def test_what_is_saved_is_what_is_driven(lab: Lab, page: Page) -> None:
    button(page, '2×').click()  # 5 is too fast for the executor of an early rclpy
    button(page, 'Save and drive it').click()
    goal = saved(lab)[-1]

    def arrived() -> bool:
        place = lab.truth.pose.pose.position
        return math.dist((place.x, place.y), goal) < 0.3

    wait_until(arrived, timeout_sec=90.0, what=lambda: lab.view.output)


@pytest.mark.timeout(120)
def test_waypoints_may_go_while_another_tab_drags_one(lab: Lab, page: Page) -> None:
    other = lab.open(*SIZE)
    look_from_above(other)
    open_editor(other)
    drag_at_once((page, PLACES[1], (-2.0, 1.5)), (other, PLACES[0], (0.0, -1.0)))

    def are_saved() -> bool:
        button(page, 'Save').click()
        return distances(saved(lab)[:2], [(0.0, -1.0), (-2.0, 1.5)]) < 0.25

    dragged = 'two that were dragged at once'
    wait_until(are_saved, timeout_sec=20.0, what=lambda: f'{dragged}: {saved(lab)}')
    page.mouse.move(*on_screen(*saved(lab)[2]))
    page.mouse.down()
    page.mouse.move(*on_screen(-4.0, -1.0), steps=5)
    verdict = page.locator('[data-verdict]')
    expect(verdict).to_contain_text('3 waypoints')
    button(other, 'Clear').click()
    expect(verdict).to_contain_text('two waypoints make')
    page.mouse.move(*on_screen(-4.0, -2.0), steps=5)
    page.mouse.up()
    page.mouse.click(*on_screen(*PLACES[0]))
    page.mouse.click(*on_screen(*PLACES[1]))
    expect(verdict).to_contain_text('2 waypoints')
    other.close()


@pytest.mark.timeout(120)
def test_a_change_of_the_loop_leaves_the_speed_of_a_file(lab: Lab, page: Page) -> None:
    file = opened(lab, page, 'speed: 0.85\nwaypoints: [[0, 0], [-2, 1], [-3, 0]]\n', count=3)
    page.get_by_label('Back to the first (loop)').check()

    def is_saved() -> bool:
        button(page, 'Save').click()
        return load_course(file).loop

    wait_until(is_saved, timeout_sec=20.0, what='a loop in the file')
    assert load_course(file).speed_m_s == 0.85


@pytest.mark.timeout(120)
def test_a_file_in_another_encoding_is_refused_on_the_page(lab: Lab, page: Page) -> None:
    text = '# \u00fcber die Wiese\nwaypoints:\n  - [0, 0]\n  - [2, 1]\n'
    (lab.folder / 'from_windows.yaml').write_bytes(text.encode('cp1252'))
    open_file(page, 'from_windows')
    expect(page.get_by_text('byte 0xfc is not UTF-8 text')).to_be_visible()
    assert lab.view.returncode is None, lab.view.output


@pytest.mark.timeout(120)
def test_the_page_shows_what_is_written_in_another_editor(lab: Lab, page: Page) -> None:
    file = opened(lab, page, 'waypoints: [[0, 0], [-2, 1], [-4, 0]]\n', count=3)
    verdict = page.locator('[data-verdict]')
    file.write_text('speed: 0.3\nwaypoints: [[0, 0], [-4, 0]]\n')
    expect(verdict).to_contain_text('2 waypoints')
    file.write_text('waypoints: [[0, 0], [-4, 0]\n')
    expect(page.get_by_text(f'{file.stem} cannot be edited')).to_be_visible()
    button(page, 'Save').click()  # what cannot be read is not replaced at once either
    expect(page.get_by_text(f'{file.name} is not as it was opened or saved here')).to_be_visible()
    file.write_text('speed: 0.3\nwaypoints: [[0, 0], [-4, 0], [-3, 0], [-2, 0]]\n')
    expect(verdict).to_contain_text('4 waypoints')
    button(page, 'Delete').click()
    expect(verdict).to_contain_text('3 waypoints')
    file.write_text('waypoints: [[0, 0], [-4, 0]]\n')
    button(page, 'Save').click()
    expect(page.get_by_text(f'{file.name} is not as it was').last).to_be_visible()
    expect(verdict).to_contain_text('3 waypoints')


@pytest.mark.timeout(120)
def test_a_file_changed_by_others_is_replaced_by_a_second_save(lab: Lab, page: Page) -> None:
    file = opened(lab, page, 'waypoints: [[0, 0], [-2, 1], [-4, 0], [-3, 0]]\n', count=4)
    button(page, 'Delete').click()
    expect(page.locator('[data-verdict]')).to_contain_text('3 waypoints')
    others = 'waypoints: [[0, 0], [-4, 0]]\n'
    file.write_text(others)
    button(page, 'Save').click()
    expect(page.get_by_text(f'{file.name} is not as it was opened or saved here')).to_be_visible()
    assert file.read_text() == others
    button(page, 'Save').click()
    wait_until(
        lambda: len(load_course(file).waypoints) == 3, timeout_sec=20.0, what='what was edited'
    )
    file.unlink()
    chosen = page.locator('//label[.="Open"]/following::input').first
    expect(chosen).not_to_have_value(file.stem)
    button(page, 'Save').click()
    wait_until(file.is_file, timeout_sec=20.0, what='what was edited, though its file went')


def drag_at_once(*tabs: tuple[Page, Place, Place]) -> None:
    """Drag something in each tab; in all of them the mouse is down before it moves."""
    for page, begin, _ in tabs:
        page.mouse.move(*on_screen(*begin))
        page.mouse.down()
    for page, _, end in tabs:
        page.mouse.move(*on_screen(*end), steps=5)
    for page, _, _ in tabs:
        page.mouse.up()


def opened(lab: Lab, page: Page, text: str, *, count: int) -> Path:
    """Write a file of so many waypoints, and open it on the page."""
    file = lab.folder / f'of_{count}.yaml'
    file.write_text(text)
    open_file(page, file.stem)
    expect(page.locator('[data-verdict]')).to_contain_text(f'{count} waypoints')
    return file


def open_file(page: Page, name: str) -> None:
    """Choose a waypoint file, as soon as it is offered."""
    page.locator('//label[.="Open"]/following::input').first.click()
    page.get_by_role('option', name=name, exact=True).click()
