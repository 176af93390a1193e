# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which scenes the view draws, and which simulator they are of."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from husky_course.robot import RobotStart
from husky_runtime.settings import settings_of
from husky_sim.scene_topic import Scene, TRACK, world_key
from husky_sim.world import default_worlds, load_world, World
from husky_view.live.checks import (
    DISCOVERY_SEC,
    SceneCheck,
    SILENCE_SEC,
    SimulatorMonitor,
    State,
)
import numpy as np
import pytest

from husky_sim.config import DriveConfig


@pytest.fixture(scope='module')
def world() -> World:
    return load_world(str(default_worlds() / 'empty.xml'), (RobotStart(),))


def scene_of(world: World, x_m: float, time_sec: float) -> Scene:
    track = np.zeros((2, 1, len(TRACK)))
    track[:, 0, [0, 3]] = x_m
    times = np.array([time_sec - 0.004, time_sec])
    return Scene(paused=False, qpos=world.model.qpos0.copy(), time_sec=times, track=track)


def test_a_drive_and_a_reset_are_drawn(world: World) -> None:
    check = SceneCheck(world)
    for frame in range(100):
        assert check.error_in(scene_of(world, frame * 0.033, 1.0 + frame * 0.033)) == ''
    assert check.error_in(scene_of(world, 0.0, 0.02)) == '', 'a reset'


def test_a_robot_at_the_greatest_limit_of_speed_is_drawn(world: World) -> None:
    (limit,) = (each for each in settings_of(DriveConfig) if each.name == 'speed_limit_m_s')
    check = SceneCheck(world)
    for frame in range(20):  # as fast as possible: 0.4 s of simulated time from one to the next
        time_sec = 1.0 + frame * 0.4
        assert check.error_in(scene_of(world, limit.high * time_sec, time_sec)) == ''


@pytest.mark.parametrize(
    ('field', 'place', 'value', 'said'),
    [
        ('qpos', 1, np.nan, 'a joint position is no number'),
        ('qpos', slice(3, 7), 0.0, 'an orientation is no rotation: its length is not 1'),
        ('track', (1, 0, 4), np.inf, 'a track position is no number'),
        ('track', (1, 0, 4), 4.4e87, 'a robot is 4.4e+87 m away'),
        ('track', (1, 0, 0), 3.0, 'a robot jumps 3.00 m in 0.004 s'),
        ('time_sec', 1, np.nan, 'the time is no number'),
    ],
)
def test_an_invalid_scene_is_not_drawn(
    world: World, field: str, place: Any, value: float, said: str
) -> None:
    scene = scene_of(world, 0.0, 1.0)
    getattr(scene, field)[place] = value
    assert SceneCheck(world).error_in(scene) == said


def test_a_scene_of_another_size_is_not_drawn(world: World) -> None:
    scene = replace(scene_of(world, 0.0, 1.0), qpos=np.zeros(3))
    assert 'instead of' in SceneCheck(world).error_in(scene)


def test_only_the_first_scene_after_a_jump_is_invalid(world: World) -> None:
    check = SceneCheck(world)
    assert check.error_in(scene_of(world, 0.0, 1.0)) == ''
    assert check.error_in(scene_of(world, 5.0, 1.03)) == 'a robot jumps 5.00 m in 0.026 s'
    assert check.error_in(scene_of(world, 5.0, 1.06)) == ''


def test_a_silent_simulator_is_gone_and_its_next_run_is_shown() -> None:
    monitor = SimulatorMonitor('playpen', now_sec=0.0)
    assert monitor.state(now_sec=DISCOVERY_SEC) is State.HERE, 'discovery takes its time'
    assert monitor.accept('playpen', 'first', now_sec=4.0)
    assert monitor.state(now_sec=4.0 + SILENCE_SEC) is State.HERE
    assert monitor.state(now_sec=4.1 + SILENCE_SEC) is State.GONE
    assert monitor.accept('playpen', 'second', now_sec=9.0)
    assert monitor.state(now_sec=9.1) is State.HERE


def test_of_two_simulators_the_first_is_shown() -> None:
    monitor = SimulatorMonitor('playpen', now_sec=0.0)
    for frame in range(30):
        assert monitor.accept('playpen', 'first', now_sec=frame / 30.0)
        assert not monitor.accept('playpen', 'second', now_sec=frame / 30.0)
    assert monitor.state(now_sec=1.0) is State.TWO
    assert not monitor.accept('', '', now_sec=1.0), 'no scene at all'


def test_scenes_of_another_world_are_not_drawn_in_this_one() -> None:
    monitor = SimulatorMonitor('playpen', now_sec=0.0)
    assert monitor.accept('playpen', 'first', now_sec=0.0)
    for frame in range(90):
        assert not monitor.accept('field', 'second', now_sec=frame / 30.0)
    assert monitor.state(now_sec=3.0) is State.ANOTHER_WORLD


def test_a_world_is_identified_by_its_content_not_its_path(tmp_path: Path) -> None:
    worlds = default_worlds()
    copy = tmp_path / 'mine.xml'
    copy.write_text((worlds / 'empty.xml').read_text())
    start = (RobotStart(),)
    key = world_key(load_world(str(worlds / 'empty.xml'), start))
    assert world_key(load_world(str(copy), start)) == key
    others = [
        load_world(str(worlds / 'playpen.xml'), start),
        load_world(str(copy), (RobotStart(x=1.0),)),
        load_world(str(copy), (RobotStart(name='alpha'), RobotStart(name='beta', x=3.0))),
    ]
    assert len({key, *map(world_key, others)}) == 4
