# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The environment keeps Gymnasium's rules, and its rewards are the grader's score."""

from collections.abc import Callable
import copy
import math
from pathlib import Path
import pickle
import subprocess
import sys
from typing import Any

import gymnasium
from gymnasium.utils.env_checker import check_env
from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course, parse_course
from husky_driver.drive import Drive
from husky_grader.run.in_process import drive_with
from husky_grader.scoring import judge
import numpy as np
import pytest

Env = gymnasium.Env[Any, Any]
Make = Callable[..., Env]
DriveEpisode = Callable[[Env], tuple[float, bool, bool, dict[str, Any]]]


def go(env: Env, *action: float) -> tuple[float, bool, bool, dict[str, Any]]:
    """Give one action until the episode is over; return the sum of rewards, and how it ended."""
    worth, ended, cut, info = 0.0, False, False, dict[str, Any]()
    while not ended and not cut:
        seen, reward, ended, cut, info = env.step(np.array(action))
        assert seen in env.observation_space
        worth += float(reward)
    return worth, ended, cut, info


@pytest.mark.parametrize('settings', [{}, {'laser_beams': 0, 'frame_skip': 5, 'noise': True}])
def test_gymnasium_finds_nothing_wrong(make: Make, settings: dict[str, Any]) -> None:
    check_env(make(**settings).unwrapped, skip_render_check=True)


def test_the_lab_s_driver_drives_as_without_gymnasium(
    make: Make, courses: Path, drive_episode: DriveEpisode
) -> None:
    route = plan_route(load_course(courses / 'straight.yaml'))
    record = drive_with(Drive(route).step)  # no IMU: an observation has none
    env = make(course=str(courses / 'straight.yaml'))
    worth, ended, cut, info = drive_episode(env)
    assert (ended, cut, info['passed'], info['reasons']) == (True, False, True, ())
    assert worth == pytest.approx(info['score'])
    assert info['score'] == judge(read_run(record), route).score
    # Bit for bit, until the episode is over; the driver's own ends when it is content.
    rows = np.array(env.unwrapped._rows).reshape(-1, 11)  # type: ignore[attr-defined]
    assert len(rows) > 100
    assert rows.tobytes() == record.rows[: len(rows), 0].tobytes()


def test_backwards_and_round_corners_the_path_is_followed(
    make: Make, tmp_path: Path, drive_episode: DriveEpisode
) -> None:
    course = tmp_path / 'back.yaml'
    course.write_text(
        'corners: sharp\nspeed: 0.8\n'
        'waypoints: [[0, 0], [1, 0], [1, -1], {x: 1, y: -0.3, reverse: true, speed: 0.3}]\n'
    )
    env = make(course=course, laser_beams=0)
    seen, _ = env.reset()
    assert seen['asked_speed'] == pytest.approx(0.8)
    assert seen['path_left'] == pytest.approx(2.7, abs=0.01)
    # Around the corner of the first metre: the fourth place is at 0.8 m, the tenth at 2 m.
    assert seen['path'][[3, 9]].tolist() == [
        pytest.approx([0.8, 0.0], abs=0.01),
        pytest.approx([1.0, -1.0], abs=0.01),
    ]
    worth, ended, _, info = drive_episode(env)
    seen = env.unwrapped._observation()  # type: ignore[attr-defined]
    assert (ended, info['passed']) == (True, True)
    assert worth == pytest.approx(info['score'])
    assert worth > 90.0
    assert seen['asked_speed'] == pytest.approx(-0.3)
    assert seen['path_left'] < 0.25


def test_a_touch_ends_an_episode_and_costs_what_it_costs(make: Make, tmp_path: Path) -> None:
    course = tmp_path / 'through.yaml'  # the barrier
    course.write_text('waypoints: [[0, 0], [1, 0], [4.5, 0]]\n')
    env = make(course=str(course), laser_beams=0)
    env.reset()
    worth, ended, cut, info = go(env, 0.8, 0.0)
    assert (ended, cut, info['passed']) == (True, False, False)
    assert info['parts']['collisions'] == 0.65
    assert 0.0 < info['score'] < 50.0
    assert worth == pytest.approx(info['score'])
    assert any('touched' in reason for reason in info['reasons'])


def test_who_is_lost_or_out_of_time_is_told_so(make: Make) -> None:
    env = make(laser_beams=0, lost_m=0.5)
    env.reset()
    worth, ended, cut, info = go(env, -0.5, 0.0)
    assert (ended, cut) == (True, False)
    assert worth == pytest.approx(info['score'], abs=1e-9)
    env = make(laser_beams=0, time_limit_sec=1.0, frame_skip=3)
    env.reset()
    worth, ended, cut, info = go(env, 0.0, 0.0)
    assert (ended, cut, worth) == (False, True, 0.0)
    assert info['time_sec'] == pytest.approx(1.0, abs=0.06)
    with pytest.raises(RuntimeError, match=r'the episode is over.*call reset\(\)'):
        env.step(np.zeros(2))


def test_progress_is_rewarded_at_once(make: Make) -> None:
    env = make(laser_beams=0)
    env.reset()
    env.unwrapped.step(np.array([0.0, -0.4]))
    turned = [float(env.step(np.array([0.0, -0.4]))[1]) for _ in range(60)]
    driven = [float(env.step(np.array([0.6, 0.0]))[1]) for _ in range(60)]
    assert sum(driven) > 1.0 > abs(sum(turned))
    assert sum(reward > 0.0 for reward in driven) > 40


@pytest.mark.parametrize(
    ('time_sec', 'offset_m', 'worth'),
    [
        (11.5, 0.1, 40.0),  # half of the path, and 80 of 100 points for one that still drives
        (5.0, 0.0, 40.0),  # sooner and nearer than full marks ask for is worth no more
        (11.5, -0.3, 20.0),
        (11.5, 0.6, 0.0),
        (20.0, 0.1, 40.0 * 11.5 / 20.0),
        (99.0, 0.1, 20.0),
    ],
)
def test_the_estimate_is_of_way_time_and_tracking(
    time_sec: float, offset_m: float, worth: float
) -> None:
    from husky_gym.progress import Progress
    from husky_gym.running_score import RunningScore

    place = Progress(plan_route(parse_course('waypoints: [[0, 0], [6, 8]]')))
    score = RunningScore(par_time_sec=20.0, length_m=10.0)
    for along_m in (5.0, 3.0):  # and back again
        place.follow(0.6 * along_m - 0.8 * offset_m, 0.8 * along_m + 0.6 * offset_m)
        assert place.along_m == pytest.approx(along_m)
        assert place.offset_m == pytest.approx(offset_m)
        assert place.away_m == pytest.approx(abs(offset_m))
        score.add(place, speed_m_s=-0.5)  # backwards counts as well
    place.follow(-0.6, -0.8)
    assert place.away_m == pytest.approx(1.0)
    place.offset_m = 5.0
    score.add(place, speed_m_s=0.0)  # of one that stands nothing counts
    assert score.value(time_sec) == pytest.approx(worth)


BAD_ACTIONS = [
    [math.nan, 0.0],
    [0.0, math.inf],
    [0.5],
    [[0.5, 0.5]],
    [0.1, 0.2, 0.3],
    'ahead',
    None,
]


@pytest.mark.parametrize('action', BAD_ACTIONS, ids=repr)
def test_a_bad_action_is_refused_in_one_line(make: Make, action: Any) -> None:
    env = make(laser_beams=0)
    env.reset()
    with pytest.raises(ValueError, match='allowed are two finite numbers') as refused:
        env.step(np.array(action) if isinstance(action, list) else action)
    assert '\n' not in str(refused.value)
    assert env.step(np.zeros(2))[0] in env.observation_space


@pytest.mark.parametrize(
    ('settings', 'message'),
    [
        ({'floor': 'ice'}, "floor='ice': allowed is one of ideal, asphalt, concrete_indoor"),
        ({'frame_skip': 0}, 'frame_skip=0: allowed is a whole number from 1 to 50'),
        ({'laser_beams': 721}, 'laser_beams=721: allowed is a whole number from 0 to 720'),
        ({'laser_beams': 1}, 'laser_beams=1: allowed is 0, none, or from 2 to 720'),
        ({'laser_rate_hz': 0}, 'laser_rate_hz=0: allowed is a number from 0.1 to 50'),
        ({'noise': 'much'}, "noise='much': allowed is true or false"),
        ({'course': 'none.yaml'}, 'none.yaml: no such file'),
        ({'world': 'none.xml'}, "world='none.xml': no such file"),
        ({'start_x': -8.0, 'start_y': -10.0}, 'would start inside jersey_barrier'),
        ({'lasers': 0}, 'lasers: no such setting; allowed are course, world, start_x'),
        ({'render_mode': 'human'}, "render_mode='human': allowed is rgb_array or None"),
    ],
)
def test_a_bad_setting_is_refused(settings: dict[str, Any], message: str) -> None:
    from husky_gym.environment import HuskyPlaypen

    with pytest.raises(ValueError, match=r'\S') as refused:
        HuskyPlaypen(**settings)
    assert message in str(refused.value)
    assert '\n' not in str(refused.value)


def test_a_setting_may_be_drawn_by_numpy() -> None:
    from husky_gym.settings import EnvironmentSettings

    draw = np.random.default_rng(1)
    drawn: dict[str, Any] = {
        'frame_skip': draw.integers(1, 9),
        'floor': draw.choice(['grass', 'wet']),
        'lost_m': np.float32(0.5),
    }
    settings = EnvironmentSettings(**drawn)
    assert type(settings.frame_skip) is int
    assert type(settings.floor) is str
    assert settings.lost_m == 0.5


@pytest.mark.parametrize('again', [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copy_is_a_new_one_with_the_same_settings(
    make: Make, again: Callable[[Env], Env]
) -> None:
    env = make(laser_beams=0, noise=True, random_start_m=0.3, frame_skip=5)
    seen, _ = env.reset(seed=1)
    env.step(np.ones(2))
    other = again(env)
    with pytest.raises(RuntimeError, match=r'none has begun: call reset\(\)'):
        other.step(np.ones(2))
    seen_there, _ = other.reset(seed=1)
    assert {name: seen[name].tolist() for name in seen} == {
        name: seen_there[name].tolist() for name in seen
    }


def test_without_gymnasium_it_says_how_to_get_it() -> None:
    program = 'import sys\nsys.modules["gymnasium"] = None\nimport husky_gym'
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True)
    assert '-r requirements/gym.in` installs it' in done.stderr.splitlines()[-1]


def test_reset_knows_no_options(make: Make) -> None:
    env = make(laser_beams=0)
    with pytest.raises(ValueError, match='reset knows none; give settings to make'):
        env.reset(options={'course': 'other.yaml'})
    with pytest.raises(RuntimeError, match=r'none has begun: call reset\(\) first'):
        env.unwrapped.step(np.zeros(2))


def test_the_camera_draws_or_says_what_is_missing(make: Make) -> None:
    env = make(render_mode='rgb_array', laser_beams=0, frame_skip=5)
    assert env.metadata['render_fps'] == 10
    env.reset()
    try:
        before = env.render()
    except RuntimeError as error:
        assert 'install EGL' in str(error)
        assert 'set render_mode to None' in str(error)
        return
    assert isinstance(before, np.ndarray)
    assert before.shape == (480, 640, 3)
    assert before.dtype == np.uint8
    for _ in range(10):
        env.step(np.array([0.0, 1.0]))
    after = env.render()
    assert isinstance(after, np.ndarray)
    assert np.abs(after.astype(int) - before).mean() > 1.0
