# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The same settings, seeds and actions give the same observations, bit for bit, anywhere."""

from collections.abc import Callable, Iterator
import hashlib
from itertools import pairwise
import multiprocessing
from typing import Any

import gymnasium
from husky_gym.environment import HuskyPlaypen
import numpy as np
import pytest

Make = Callable[..., gymnasium.Env[Any, Any]]

SETTINGS: dict[str, Any] = {
    'noise': True,
    'random_start_m': 0.2,
    'random_start_rad': 0.3,
    'laser_beams': 45,
}


def actions() -> Iterator[np.ndarray[Any, np.dtype[np.float32]]]:
    chance = np.random.default_rng(3)
    for _ in range(60):
        yield chance.uniform(-1.0, 1.0, 2).astype(np.float32)


def episode_digest(env: Any, seed: int | None) -> str:
    """Return a digest of all that an episode shows and pays."""
    digest = hashlib.sha256()
    seen, info = env.reset(seed=seed)
    digest.update(repr(info).encode())
    for action in actions():
        for name in sorted(seen):
            digest.update(seen[name].tobytes())
        seen, reward, _, _, info = env.step(action)
        digest.update(repr((reward, info)).encode())
    return digest.hexdigest()


def digest_of_new(seed: int) -> str:
    return episode_digest(HuskyPlaypen(**SETTINGS), seed)


def test_a_seed_repeats_after_another_episode_and_in_another_process(make: Make) -> None:
    env = make(**SETTINGS)
    first = episode_digest(env, 5)
    other = episode_digest(env, 6)
    going_on = episode_digest(env, None)
    assert len({first, other, going_on}) == 3
    assert episode_digest(env, 5) == first
    with multiprocessing.get_context('spawn').Pool(1) as pool:
        assert pool.apply(digest_of_new, (5,)) == first


def test_a_row_of_processes_sees_what_one_alone_sees() -> None:
    kinds = [
        gymnasium.make_vec('husky_gym:HuskyPlaypen-v0', 2, vectorization_mode=mode, **SETTINGS)
        for mode in ('sync', 'async')
    ]
    try:
        for envs in kinds:
            envs.reset(seed=1)
        for action in actions():
            alone, beside = (envs.step(np.stack([action, -action])) for envs in kinds)
            for name, values in alone[0].items():
                assert values.tobytes() == beside[0][name].tobytes(), name
            assert alone[1].tolist() == beside[1].tolist()
    finally:
        for envs in kinds:
            envs.close()


def test_a_random_start_is_known_to_odometry_and_free(make: Make) -> None:
    # 1.4 m ahead of this start stands the barrier.
    env = make(start_x=1.0, random_start_m=1.0, random_start_rad=1.5, laser_beams=0)
    places = set()
    for seed in range(5):
        seen, info = env.reset(seed=seed)
        husky = env.unwrapped.husky  # type: ignore[attr-defined]
        assert info['odometry'][:2] == pytest.approx(husky.place)
        assert husky.robot.state.yaw == pytest.approx(info['odometry'][2])
        assert np.abs(seen['odometry'][:3]).max() > 0.0
        env.step(np.zeros(2))
        assert not husky.simulation.unreported_touches()
        places.add(husky.place)
    assert len(places) == 5


def test_where_no_start_is_free_that_is_said(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    env = make(random_start_m=0.1, laser_beams=0)
    husky = env.unwrapped.husky  # type: ignore[attr-defined]
    monkeypatch.setattr(husky, 'is_free', lambda _: False)
    with pytest.raises(ValueError, match='no free place among 1000; start farther away'):
        env.reset()


def test_the_ground_and_the_noise_are_those_asked_for(make: Make) -> None:
    digests = [
        episode_digest(make(laser_beams=0, **more), 1)
        for more in ({}, {'floor': 'gravel'}, {'noise': True}, {})
    ]
    assert len(set(digests)) == 3
    assert digests[0] == digests[3]


def test_fewer_beams_are_the_same_scan_with_gaps(make: Make) -> None:
    scans = [make(laser_beams=beams).reset(seed=1)[0]['laser'] for beams in (720, 2)]
    assert scans[1].tolist() == scans[0][[0, -1]].tolist()
    assert scans[0].min() > 0.1
    assert len(np.unique(scans[0])) > 300


def test_a_scan_stays_until_the_next_one(make: Make) -> None:
    env = make(laser_rate_hz=10.0)
    scans = [env.reset()[0]['laser']]
    for _ in range(20):
        scans.append(env.step(np.array([0.5, 0.5]))[0]['laser'])
    fresh = [not np.array_equal(*pair) for pair in pairwise(scans)]
    assert sum(fresh) == 4
    assert [place % 5 for place in np.flatnonzero(fresh)] == [4] * 4
