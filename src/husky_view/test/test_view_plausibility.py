# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the view believes of what it is told."""

from dataclasses import replace
from typing import Any

from husky_course.robot import RobotStart
from husky_sim.scene_topic import Scene, TRACK
from husky_sim.world import default_worlds, load_world, World
from husky_view.live.plausibility import SceneCheck
import numpy as np
import pytest


@pytest.fixture(scope='module')
def world() -> World:
    return load_world(str(default_worlds() / 'empty.xml'), (RobotStart(),))


def scene_of(world: World, x_m: float, time_sec: float) -> Scene:
    track = np.zeros((2, 1, len(TRACK)))
    track[:, 0, [0, 3]] = x_m
    times = np.array([time_sec - 0.004, time_sec])
    return Scene(paused=False, qpos=world.model.qpos0.copy(), time_sec=times, track=track)


def test_what_a_husky_does_is_drawn(world: World) -> None:
    check = SceneCheck(world)
    for frame in range(100):
        assert check.complaint(scene_of(world, frame * 0.033, 1.0 + frame * 0.033)) == ''
    assert check.complaint(scene_of(world, 0.0, 0.02)) == '', 'a reset'


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
def test_nonsense_is_not_drawn(
    world: World, field: str, place: Any, value: float, said: str
) -> None:
    scene = scene_of(world, 0.0, 1.0)
    getattr(scene, field)[place] = value
    assert SceneCheck(world).complaint(scene) == said


def test_a_scene_of_another_size_is_not_drawn(world: World) -> None:
    scene = replace(scene_of(world, 0.0, 1.0), qpos=np.zeros(3))
    assert 'instead of' in SceneCheck(world).complaint(scene)


def test_a_robot_that_was_put_elsewhere_is_drawn_there_with_the_next_scene(world: World) -> None:
    check = SceneCheck(world)
    assert check.complaint(scene_of(world, 0.0, 1.0)) == ''
    assert check.complaint(scene_of(world, 5.0, 1.03)) == 'a robot jumps 5.00 m in 0.026 s'
    assert check.complaint(scene_of(world, 5.0, 1.06)) == ''
