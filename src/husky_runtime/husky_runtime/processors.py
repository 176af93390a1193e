# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How many processors there are to work with."""

from collections.abc import Iterator
import math
import os
from pathlib import Path

OWN_GROUPS = Path('/proc/self/cgroup')
GROUPS = Path('/sys/fs/cgroup')


def usable_processors() -> int:
    """
    Return how many this process may use; all of the machine where the system does not say.

    A container may be given the time of a few and yet see those of the whole machine.
    """
    if hasattr(os, 'sched_getaffinity'):  # not on macOS
        count = len(os.sched_getaffinity(0))
    else:
        count = os.cpu_count() or 1
    return max(1, min([count, *map(math.ceil, _quotas())]))


def _quotas() -> Iterator[float]:
    """Yield the processors' worth of time that each of this process's cgroups is given."""
    for folder, is_v2 in _groups():
        try:
            if is_v2:
                quota, period = (folder / 'cpu.max').read_text().split()
            else:
                names = ('cpu.cfs_quota_us', 'cpu.cfs_period_us')
                quota, period = ((folder / name).read_text() for name in names)
            if quota != 'max' and int(quota) > 0:  # -1 where there is no limit
                yield int(quota) / int(period)
        except (OSError, ValueError):
            pass  # not told, as of the outermost


def _groups() -> Iterator[tuple[Path, bool]]:
    """
    Yield the cgroups that may limit this process, and whether they are of version 2.

    In a container the outermost that is seen is mostly its own, whatever its name outside.
    """
    try:
        lines = OWN_GROUPS.read_text().splitlines()
    except OSError:  # not Linux
        return
    for line in lines:
        _, controllers, path = line.split(':', 2)
        if not controllers or 'cpu' in controllers.split(','):
            inner = GROUPS / controllers / path.lstrip('/')
            for folder in (inner, *inner.parents):
                if folder.is_relative_to(GROUPS / controllers):
                    yield folder, not controllers
