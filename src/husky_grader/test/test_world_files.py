# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The files that a world of a rubric is made of."""

from pathlib import Path

from husky_grader.rubric.world_files import files_of_world


def write(path: Path, inside: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f'<mujoco>{inside}</mujoco>', encoding='utf-8')
    return path


def test_a_world_is_made_of_what_it_names_and_what_that_names(tmp_path: Path) -> None:
    rock = '<mesh file="rock.stl"/><mesh file="not_there.stl"/><hfield name="profile.png"/>'
    world = write(
        tmp_path / 'yard.xml',
        f'<compiler meshdir="meshes" texturedir=""/><asset>{rock}<model file="car.xml"/></asset>'
        '<include file="more/walls.xml"/><include file="nowhere.xml"/>',
    )
    robot = write(tmp_path / 'husky.xml', '<include file="yard.xml"/>')
    walls = write(tmp_path / 'more' / 'walls.xml', '<texture fileup="sky.png"/>')
    car = write(tmp_path / 'car.xml', '<mesh file="wheel.obj"/><include file="yard.xml"/>')
    odd = tmp_path / 'odd.xml'
    odd.write_text('<mujoco>')  # not well formed
    walls.write_text(walls.read_text().replace('</', '<include file="odd.xml"/></'))
    named = [tmp_path / name for name in ('meshes/rock.stl', 'sky.png', 'wheel.obj')]
    named[0].parent.mkdir()
    for path in (*named, tmp_path / 'rock.stl', tmp_path / 'profile.png'):
        path.touch()
    files = files_of_world(world)
    assert files[:2] == (world, robot)
    assert set(files) == {world, robot, walls, car, odd, tmp_path / 'rock.stl', *named}
    assert len(files) == 9


def test_a_world_needs_no_robot_beside_it(tmp_path: Path) -> None:
    world = write(tmp_path / 'yard.xml', '')
    assert files_of_world(world) == (world,)
    world.write_text('<mujoco>')  # which MuJoCo refuses, and tells why
    assert files_of_world(world) == (world,)
