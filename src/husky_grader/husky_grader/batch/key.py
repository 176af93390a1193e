# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The key of a result: a hash of all that it depends on, and of nothing else."""

from collections.abc import Iterable, Mapping
from functools import lru_cache
import hashlib
from importlib.metadata import version
from pathlib import Path
import platform

from husky_course.files import first_bytes
from husky_course.robot import RobotStart
from husky_sim.errors import SimulatorError
from husky_sim.world import default_worlds, load_world

import husky_course
import husky_driver
import husky_grader
from husky_grader.clone import CLONE
import husky_runtime
import husky_sim

PROGRAM_ENDINGS = ('.py', '.c', '.css', '.jinja')
MOST_BYTES = 10_000_000  # of a file that are read; of a larger one count its size and time, too
UNDERLAY = CLONE / 'underlay'
"""What the wheels of Jazzy lack, and programs of students run with."""
_PACKAGES = (husky_course, husky_driver, husky_grader, husky_runtime, husky_sim)


def versions() -> dict[str, str]:
    """Return the versions of what a result depends on besides the lab's own files."""
    return {
        'python': platform.python_version(),
        'mujoco': version('mujoco'),
        'numpy': version('numpy'),
        'machine': platform.machine(),  # another processor may round a sum of products otherwise
    }


def key_of(files: Iterable[Path], settings: Mapping[str, object]) -> str:
    """
    Return the key of a result.

    :param files: the content of these; a device or a pipe, which may never end, counts by a mark.
    :param settings: what else it depends on.
    """
    digest = hashlib.sha256(_programs())
    for name, value in sorted(settings.items()):
        digest.update(f'{name}={value!r}\n'.encode(errors='surrogateescape'))
    for path in files:
        digest.update(_digest(path))
    return digest.hexdigest()


@lru_cache(maxsize=1)
def world_digest(world: str) -> str:
    """
    Return a hash of what MuJoCo makes of a world, with all the files that it is made of.

    :param world: MJCF file; empty: the playpen.
    """
    try:
        return load_world(world or str(default_worlds() / 'playpen.xml'), [RobotStart()]).digest
    except SimulatorError as error:  # which each result will say
        return str(error)


@lru_cache(maxsize=1)
def _programs() -> bytes:
    """Return a hash of the lab's programs and of versions."""
    digest = hashlib.sha256(repr(sorted(versions().items())).encode())
    for folder in (*(Path(package.__path__[0]) for package in _PACKAGES), UNDERLAY):
        for path in sorted(path for path in folder.rglob('*') if path.suffix in PROGRAM_ENDINGS):
            digest.update(_digest(path))
    return digest.digest()


def _digest(path: Path) -> bytes:
    digest = hashlib.sha256()
    try:
        if path.is_file():
            digest.update(first_bytes(path, MOST_BYTES))
            about = path.stat()
            if about.st_size > MOST_BYTES:
                digest.update(repr((about.st_size, about.st_mtime_ns)).encode())
            return digest.digest()
    except (OSError, ValueError):
        pass
    return hashlib.sha256(b'?').digest()
