# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Replay of a recorded run in a real browser."""

from collections.abc import Iterator
from pathlib import Path
import signal
import time

from husky_runtime.web_address import TOKEN_VARIABLE
from husky_sim.recording import RunRecorder
from husky_sim.simulation import Simulation
from husky_sim.world import default_worlds
from husky_view.gate.front_page import ALIVE, LOST, SILENT
from playpen_testing.browser import button, errors, number, open_page, places, wait_for
from playpen_testing.processes import Process, Processes
from playwright.sync_api import Browser, expect, Page
import pytest

from husky_sim.config import SimulationConfig

LAB = Path(__file__).resolve().parent.parent / 'lab'
SECONDS = 6.0
TIME = "parseFloat(document.querySelector('[data-number=time]').textContent)"
SLIDER = "document.querySelector('[role=slider]').getAttribute('aria-valuenow')"

# A browser lets new connections of a page wait where many have failed.
FAIL_AS_IN_MINUTES = """() => Promise.all([...Array(80)].map(() => new Promise((done) => {
  new WebSocket(location.href.replace('http', 'ws')).onerror = done;
})))"""


# As where a scene takes long to draw: the page presses Play when the test lets it look.
HOLD_LOOKS = """
const soon = window.setInterval.bind(window);
window.looks = -1;
window.setInterval = (look, ms) => look.name !== 'arrange' ? soon(look, ms) : soon(() => {
  if (window.looks < 0) return;
  look();
  window.looks += 1;
}, ms);
"""
DRAW_TWICE = 'new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))'
# As two tabs do it: neither has heard of the other's press.
PRESS_TWICE = 'each => { each.click(); each.click(); }'


@pytest.fixture(scope='module')
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Drive into the barrier in the middle, and keep the record as a report does."""
    folder = tmp_path_factory.mktemp('driven') / 'report'
    folder.mkdir()
    simulation = Simulation(SimulationConfig(world=str(default_worlds() / 'playpen.xml')))
    record = RunRecorder(simulation, folder / 'run.record')
    for _ in range(round(SECONDS / 0.02)):
        simulation.robots[0].controller.command(0.6, 0.0, time_sec=simulation.time_sec)
        simulation.advance()
        record.append()
    record.close()
    return folder


@pytest.fixture(scope='module')
def replay(report: Path) -> Iterator[Process]:
    with Processes() as processes:
        started = processes.start(
            'ros2', 'run', 'husky_view', 'replay', str(report), '--port', '18180'
        )
        started.wait_for_text('look at http://')
        yield started


@pytest.fixture(scope='module')
def page(replay: Process, browser: Browser) -> Iterator[Page]:
    opened = open_page(browser, replay.output.split('look at ')[1].split()[0])
    yield opened
    opened.close()


@pytest.mark.timeout(120)
def test_a_replay_jumps_to_the_collision_and_stands_there(page: Page) -> None:
    collision = page.get_by_role('button', name='jersey_barrier_15')
    named_sec = float(collision.inner_text().split()[0])
    collision.click()
    wait_for(page, f'{TIME} === {named_sec}')
    assert number(page, 'collisions').inner_text() == '1'
    button(page, 'Play').wait_for()


@pytest.mark.timeout(120)
def test_no_button_moves_as_there_is_more_to_be_seen(page: Page) -> None:
    slider, legend = page.get_by_role('slider'), page.locator('.husky-legend')
    # A key that is pressed while the page still hears of the jump would be lost.
    wait_for(page, f'Math.abs({SLIDER} - {TIME}) < 0.06')
    slider.press('End')
    button(page, 'Play').wait_for()
    slider.press('Home')
    expect(legend).to_have_text('')
    before = places(page)
    slider.press('End')
    expect(legend).to_contain_text('collision')
    assert {'Plots over the time', 'From the start'} <= before.keys()
    assert places(page) == before


@pytest.mark.timeout(120)
def test_the_slider_reaches_the_end_and_play_begins_again(page: Page) -> None:
    wait_for(page, f'{TIME} === {SECONDS}')
    button(page, 'Play').click()
    wait_for(page, f'{TIME} < {SECONDS}')
    assert errors(page) == []


@pytest.mark.timeout(120)
def test_a_button_that_is_pressed_twice_does_what_it_says(page: Page) -> None:
    collision = page.get_by_role('button', name='jersey_barrier_15')
    collision.click()
    at_sec = float(collision.inner_text().split()[0])
    wait_for(page, f'{TIME} === {at_sec}')
    button(page, '¼×').click()
    button(page, 'Play').evaluate(PRESS_TWICE)
    wait_for(page, f'{TIME} > {at_sec}')
    button(page, 'Pause').evaluate(PRESS_TWICE)
    button(page, 'Play').wait_for()
    button(page, '1×').click()


@pytest.mark.timeout(120)
def test_a_collision_clicked_before_the_scene_is_drawn_stands(
    report: Path, browser: Browser
) -> None:
    with Processes() as processes:
        replay = processes.start('ros2', 'run', 'husky_view', 'replay', str(report))
        replay.wait_for_text('look at http://')
        page = browser.new_page()
        page.add_init_script(HOLD_LOOKS)
        page.goto(replay.output.split('look at ')[1].split()[0], wait_until='commit')
        collision = page.get_by_role('button', name='jersey_barrier_15')
        at_sec = float(collision.inner_text().split()[0])
        wait_for(page, 'window.__viserMutable?.scene?.visible')
        collision.click()
        wait_for(page, f'{TIME} === {at_sec}')
        page.evaluate('window.looks = 0')
        wait_for(page, 'window.looks > 5')
        page.evaluate(DRAW_TWICE)
        button(page, '2×').click()  # the server has heard all that came before
        expect(button(page, '2×')).to_have_attribute('aria-pressed', 'true')
        assert button(page, 'Play').is_visible()
        assert page.evaluate(TIME) == at_sec
        page.close()


@pytest.mark.timeout(60)
def test_the_plots_are_drawn_when_they_are_opened(page: Page) -> None:
    page.get_by_text('Plots over the time').click()
    wait_for(page, "[...document.querySelectorAll('.uplot canvas')].some((c) => c.width > 100)")


def replayed(
    processes: Processes, command: tuple[str, ...], browser: Browser
) -> tuple[Process, Page]:
    """Start a replay, and open its page."""
    replay = processes.start(*command)
    replay.wait_for_text('look at http://')
    return replay, open_page(browser, replay.output.split('look at ')[1].split()[0])


@pytest.mark.timeout(120)
def test_a_page_outlives_its_replay_and_shows_the_next(
    report: Path, browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(TOKEN_VARIABLE, 'the-same-token')
    monkeypatch.chdir(report.parent)
    command = (str(LAB), 'view', '--port', '18280')  # the last report is what is played
    with Processes() as processes:
        first, page = replayed(processes, command, browser)
        expect(page).to_have_title('Husky replay')
        waiting = page.locator('#husky-waiting')
        expect(waiting).to_be_hidden()
        begun = time.monotonic()
        first.signal(signal.SIGINT)
        assert first.wait(timeout_sec=10.0) == 0
        assert time.monotonic() - begun < 2.0
        assert 'Traceback' not in first.output
        expect(waiting).to_have_text('Husky replay' + LOST)
        processes.start(*command)
        expect(waiting).to_be_hidden()
        page.close()


@pytest.mark.timeout(120)
def test_a_page_that_was_long_alone_shows_the_next_replay(
    report: Path, browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(TOKEN_VARIABLE, 'the-same-token')
    command = ('ros2', 'run', 'husky_view', 'replay', str(report), '--port', '19180')
    with Processes() as processes:
        first, page = replayed(processes, command, browser)
        first.signal(signal.SIGINT)
        assert first.wait(timeout_sec=10.0) == 0
        page.evaluate(FAIL_AS_IN_MINUTES)
        waiting = page.locator('#husky-waiting')
        expect(waiting).to_have_text('Husky replay' + LOST)
        processes.start(*command)
        expect(waiting).to_be_hidden(timeout=40_000)
        page.close()


@pytest.mark.timeout(120)
def test_a_page_whose_replay_stands_still_says_so(report: Path, browser: Browser) -> None:
    with Processes() as processes:
        command = ('ros2', 'run', 'husky_view', 'replay', str(report), '--port', '19080')
        stopped, page = replayed(processes, command, browser)
        waiting = page.locator('#husky-waiting')
        expect(waiting).to_be_hidden()
        page.route(f'**/{ALIVE}', lambda route: route.abort('connectionreset'))
        for _ in range(3):  # as where strangers have taken all connections but the page's own
            page.wait_for_event('requestfailed', lambda request: request.url.endswith(ALIVE))
        expect(waiting).to_be_hidden()
        page.unroute_all()
        stopped.signal(signal.SIGSTOP)
        expect(waiting).to_have_text('Husky replay' + SILENT, timeout=20_000)
        stopped.signal(signal.SIGCONT)
        expect(waiting).to_be_hidden(timeout=20_000)
        page.close()
