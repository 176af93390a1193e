# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""worlds/playpen.xml against a table of the original's obstacles."""

import csv
from pathlib import Path
from typing import Any

from husky_course.robot import RobotStart
from husky_sim.world.world import load_world, World
import mujoco
import numpy as np
import pytest

# Poses and masses are those of the world state block of clearpath_playpen.world, outlines those
# of its collision boxes and of the meshes it names.
TABLE = Path(__file__).with_name('playpen_obstacles.csv')
OBSTACLES = list(csv.DictReader(TABLE.read_text(encoding='utf-8').splitlines()))


@pytest.fixture(scope='module')
def playpen() -> World:
    worlds = Path(__file__).resolve().parents[3] / 'worlds'
    return load_world(str(worlds / 'playpen.xml'), [RobotStart()])


def numbers(row: dict[str, str], *columns: str) -> Any:
    return pytest.approx([float(row[column]) for column in columns], abs=1e-6)


def test_the_world_has_the_34_obstacles_of_the_original(playpen: World) -> None:
    assert sorted(o.name for o in playpen.obstacles) == sorted(row['name'] for row in OBSTACLES)
    assert len(OBSTACLES) == 34


@pytest.mark.parametrize('row', OBSTACLES, ids=lambda row: row['name'])
def test_an_obstacle_stands_where_the_original_has_it(playpen: World, row: dict[str, str]) -> None:
    body = playpen.model.body(row['name'])
    turn = np.zeros(4)
    mujoco.mju_euler2Quat(turn, [float(row[a]) for a in ('roll', 'pitch', 'yaw')], 'XYZ')
    assert body.pos.tolist() == numbers(row, 'x', 'y', 'z')
    assert abs(float(body.quat @ turn)) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize('row', OBSTACLES, ids=lambda row: row['name'])
def test_an_obstacle_has_the_outline_of_the_original(playpen: World, row: dict[str, str]) -> None:
    outline = next(o for o in playpen.obstacles if o.name == row['name'])
    size = outline.size if outline.type == 'rect' else (2.0 * outline.size[0],) * 2
    assert outline.type == row['outline']
    assert (outline.x, outline.y) == pytest.approx((float(row['x']), float(row['y'])), abs=1e-4)
    assert outline.yaw == pytest.approx(float(row['yaw']), abs=1e-3)
    assert size == pytest.approx((float(row['length']), float(row['width'])), abs=1e-3)


@pytest.mark.parametrize(
    'row', [row for row in OBSTACLES if row['mass']], ids=lambda row: row['name']
)
def test_what_can_be_pushed_weighs_what_the_original_weighs(
    playpen: World, row: dict[str, str]
) -> None:
    body = playpen.model.body(row['name'])
    assert body.dofnum[0] == 6
    assert body.mass[0] == float(row['mass'])
    assert body.inertia.tolist() == numbers(row, 'ixx', 'iyy', 'izz')
    assert body.ipos.tolist() == pytest.approx([0.0, 0.0, float(row['com_z'])])


def test_everything_else_cannot_be_pushed(playpen: World) -> None:
    for row in OBSTACLES:
        if not row['mass']:
            assert playpen.model.body(row['name']).weldid[0] == 0


def test_ten_seconds_move_no_obstacle_by_a_bit(playpen: World) -> None:
    data = mujoco.MjData(playpen.model)
    bodies = [playpen.model.body(row['name']).id for row in OBSTACLES]
    mujoco.mj_step(playpen.model, data)
    before = data.xpos[bodies].copy()
    mujoco.mj_step(playpen.model, data, nstep=5000)
    assert (data.xpos[bodies] == before).all()


def test_a_woken_obstacle_settles_within_three_centimetres(playpen: World) -> None:
    model = mujoco.MjModel.from_xml_path(playpen.path)
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=2500)
    for row in OBSTACLES:
        body = model.body(row['name'])
        moved = abs(data.xpos[body.id] - body.pos)
        assert moved.max() < 0.03, f'{row["name"]} moved by {moved}'
        if row['mass']:
            assert abs(data.qvel[body.dofadr[0] :][:6]).max() < 2e-3, f'{row["name"]} still moves'
