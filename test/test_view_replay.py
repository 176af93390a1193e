# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Replay of a recorded run in a real browser."""

from collections.abc import Iterator
from pathlib import Path
import signal
import time

from husky_sim.recorder import RunRecorder
from husky_sim.simulation import Simulation
from husky_sim.world import default_worlds
from playpen_testing.browser import Browser
from playpen_testing.page import button, number
from playpen_testing.processes import Process, Processes
from playpen_testing.tab import Tab
import pytest

from husky_sim.config import SimulationConfig

SECONDS = 6.0


@pytest.fixture(scope='module')
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Drive into the barrier in the middle, and keep the record as a report does."""
    folder = tmp_path_factory.mktemp('report')
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
            'ros2', 'run', 'husky_sim', 'replay', str(report), '--port', '18180'
        )
        started.wait_for_text('look at http://')
        yield started


@pytest.fixture(scope='module')
def page(replay: Process, browser: Browser) -> Iterator[Tab]:
    tab = browser.open(replay.output.split('look at ')[1].split()[0])
    yield tab
    tab.close()


def shown_sec(page: Tab) -> float:
    return float(page.run(number('time')).split()[0])


@pytest.mark.timeout(120)
def test_a_replay_jumps_to_the_collision_and_stands_there(page: Tab) -> None:
    collision = (
        "[...document.querySelectorAll('button')]"
        ".find((b) => b.textContent.includes('jersey_barrier_15'))"
    )
    named_sec = float(page.wait_for(f'{collision}.textContent').split()[0])
    page.click(collision)
    page.wait_for(
        f'parseFloat({number("time")}) === {named_sec}', what='the time of the collision'
    )
    assert page.run(number('collisions')) == '1'
    page.wait_for(button('Play'), what='a replay that stands')


@pytest.mark.timeout(120)
def test_the_slider_reaches_the_end_and_play_begins_again(page: Tab) -> None:
    page.run("document.querySelector('[role=slider]').focus() || true")
    page.key('keyDown', 'End')
    page.key('keyUp', 'End')
    page.wait_for(f'parseFloat({number("time")}) === {SECONDS}', what='the end of the run')
    page.click(button('Play'))
    page.wait_for(f'parseFloat({number("time")}) < {SECONDS}', what='the run once more')
    assert page.errors == []


@pytest.mark.timeout(60)
def test_ctrl_c_ends_a_replay_within_two_seconds(report: Path) -> None:
    with Processes() as processes:
        replay = processes.start(
            'ros2', 'run', 'husky_sim', 'replay', str(report), '--port', '18280'
        )
        replay.wait_for_text('look at http://')
        begun = time.monotonic()
        replay.signal(signal.SIGINT)
        assert replay.wait(timeout_sec=10.0) == 0
        assert time.monotonic() - begun < 2.0
        assert 'Traceback' not in replay.output
