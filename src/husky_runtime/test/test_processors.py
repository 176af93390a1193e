# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How many processors are used, by what the system tells of them."""

import os
from pathlib import Path

from husky_runtime.processors import usable_processors
import pytest

from husky_runtime import processors

V1 = 'groups/cpu,cpuacct/'


def test_processors_are_counted_with_and_without_affinity(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(processors, 'OWN_GROUPS', tmp_path / 'not Linux')
    monkeypatch.setattr(os, 'sched_getaffinity', lambda _: {3, 5, 8})
    assert usable_processors() == 3
    monkeypatch.delattr(os, 'sched_getaffinity')
    monkeypatch.setattr(os, 'cpu_count', lambda: 6)
    assert usable_processors() == 6
    monkeypatch.setattr(os, 'cpu_count', lambda: None)
    assert usable_processors() == 1


@pytest.mark.parametrize(
    ('own', 'files', 'count'),
    [
        ('0::/', {'groups/cpu.max': '50000 100000'}, 1),
        ('0::/a/b', {'groups/a/cpu.max': '250000 100000', 'groups/a/b/cpu.max': 'max 100000'}, 3),
        ('0::/a/b', {'groups/a/cpu.max': '250000 100000', 'groups/a/b/cpu.max': '20000 10000'}, 2),
        ('0::/its/name/outside', {'groups/cpu.max': '400000 100000'}, 4),
        ('0::/../..', {'groups/cpu.max': 'max 100000'}, 64),
        ('0::/', {'groups/cpu.max': 'what nobody knows'}, 64),
        (
            '7:pids:/b\n3:cpu,cpuacct:/a\n0::/',
            {f'{V1}/a/cpu.cfs_quota_us': '150000', f'{V1}/a/cpu.cfs_period_us': '100000'},
            2,
        ),
        (
            '3:cpu,cpuacct:/\n0::/',
            {f'{V1}/cpu.cfs_quota_us': '-1', f'{V1}/cpu.cfs_period_us': '100000'},
            64,
        ),
    ],
)
def test_the_share_that_a_container_has_is_not_exceeded(
    own: str, files: dict[str, str], count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, text in {'own': own, **files}.items():
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f'{text}\n')
    monkeypatch.setattr(processors, 'OWN_GROUPS', tmp_path / 'own')
    monkeypatch.setattr(processors, 'GROUPS', tmp_path / 'groups')
    monkeypatch.setattr(os, 'sched_getaffinity', lambda _: set(range(64)))
    assert usable_processors() == count
