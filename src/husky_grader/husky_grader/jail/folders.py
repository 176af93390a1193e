# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What of the host's files there is in a jail, and which of the environment's variables."""

from collections.abc import Iterable, Mapping
from fnmatch import fnmatchcase
import os
from pathlib import Path
import sys
from typing import Literal, NamedTuple

from husky_grader.clone import CLONE
from husky_grader.jail.limits import Limits, MB

# The programs that start a command and hold a network, and the Python by which they run: not that
# of .venv, which looks for more.
INSIDE = Path(__file__).with_name('inside.py').resolve()
LOOPBACK = Path(__file__).with_name('loopback.py').resolve()
PYTHON = Path(sys.executable).resolve()

# What programs need of the system.
_SYSTEM = ('/usr', '/bin', '/sbin', '/lib', '/lib32', '/lib64', '/libx32')
# And what of /etc: the dynamic linker, names of users and computers, languages, time.
_ETC = (
    *('alternatives', 'ld.so.cache', 'ld.so.conf', 'ld.so.conf.d', 'fonts', 'ssl/openssl.cnf'),
    *('group', 'hosts', 'nsswitch.conf', 'passwd', 'protocols', 'services', 'os-release'),
    *('locale.alias', 'locale.conf', 'localtime', 'mime.types', 'timezone'),
)
# The folders of the clone by which ROS runs; what else lies there may be reports of others.
_ROS = ('.venv', 'underlay')
# The lab's own packages: there are solutions among them, and how they are judged.
OWN_PACKAGES = (
    *('husky_course', 'husky_driver', 'husky_grader', 'husky_gym', 'husky_runtime', 'husky_sim'),
    *('husky_view', 'topic_demo'),
)

# Variables that programs of ROS read, and no other: among those are tokens and passwords.
_ALLOWED = (
    *('PATH', 'LANG', 'LANGUAGE', 'LC_*', 'TZ', 'LD_LIBRARY_PATH', 'VIRTUAL_ENV'),
    *('PYTHONPATH', 'PYTHONUNBUFFERED', 'PYTHONDONTWRITEBYTECODE'),
    *('AMENT_PREFIX_PATH', 'CMAKE_PREFIX_PATH', 'COLCON_PREFIX_PATH', 'COLCON_PYTHON_EXECUTABLE'),
    *('ROS_DISTRO', 'ROS_VERSION', 'ROS_PYTHON_VERSION', 'ROS_PYTHON_CHECK_FIELDS'),
    *('RMW_IMPLEMENTATION', 'FASTRTPS_DEFAULT_PROFILES_FILE', 'HUSKY_LAB_ROS'),
    '_ROS_WHEELS_BOOTSTRAP_COMPLETE',
)
# These lead to what is read.
_PATHS = ('AMENT_PREFIX_PATH', 'CMAKE_PREFIX_PATH', 'COLCON_PREFIX_PATH', 'PYTHONPATH')
# Memory in each jail.
_TEMPORARY, _SHARED = '/tmp', '/dev/shm'
_LIBRARIES, _PROFILES = 'LD_LIBRARY_PATH', 'FASTRTPS_DEFAULT_PROFILES_FILE'


class Mount(NamedTuple):
    """Something that is at a place in a jail."""

    kind: Literal['read', 'write', 'memory']
    source: str  # the path outside, without links; of memory its size in bytes
    target: str


def mounts_of(
    folder: Path, readable: Iterable[Path], limits: Limits, *, without: Iterable[str] = ()
) -> list[Mount]:
    """
    Return what is in a jail, what holds others before them.

    :param folder: what may be written, at the same path as outside.
    :param readable: besides the system and the lab.
    :param without: packages that the terminal's workspaces must not bring along.
    """
    own = (
        Mount('memory', str(limits.temporary_mb * MB), _TEMPORARY),
        Mount('memory', str(limits.shared_mb * MB), _SHARED),
        Mount('write', str(folder.resolve()), str(folder.resolve())),
    )
    apart = (folder.resolve(), Path(_TEMPORARY), Path(_SHARED))
    shown = read_mounts(readable, apart=apart, without=without)
    return sorted((*shown, *own), key=lambda mount: Path(mount.target).parts)


def read_mounts(
    readable: Iterable[Path], *, apart: Iterable[Path] = (), without: Iterable[str] = ()
) -> list[Mount]:
    """
    Return what can only be read in a jail: the system, the lab, and more.

    :param apart: what a folder that a variable names must not hold, or it is not shown.
    :param without: as of `mounts_of`.
    """
    readable = tuple(readable)
    home = Path(os.path.expanduser('~'))  # noqa: PTH111  # the other raises where there is none
    ros = _ros((*([home] if home.is_absolute() else []), *apart, *readable), without)
    places = {*map(Path, _SYSTEM), *(Path('/etc', name) for name in _ETC), *ros, *readable}
    ways = {way for place in places for way in (place.absolute(), place.resolve()) if way.exists()}
    return [
        Mount('read', str(way.resolve()), str(way))
        for way in sorted(ways)
        if ways.isdisjoint(way.parents)
    ]


def _ros(apart: Iterable[Path], without: Iterable[str]) -> set[Path]:
    """
    Return where ROS is read from, and the Python by which programs run.

    Not what holds one of the folders apart: others' files lie beside it.
    """
    found = {INSIDE.parent, Path(sys.prefix), Path(sys.base_prefix), *_links_of(sys.executable)}
    found |= {CLONE / name for name in _ROS}
    for variable in (*_PATHS, _LIBRARIES, _PROFILES):
        found |= {Path(entry) for entry in _shown(os.environ.get(variable, ''), without)}
    above = {way for each in apart for way in (each, *each.parents)}
    truly_above = {way for each in apart for way in (each.resolve(), *each.resolve().parents)}
    return {
        path
        for path in found
        if path.is_absolute() and path not in above and path.resolve() not in truly_above
    }


def _shown(entries: str, without: Iterable[str]) -> list[str]:
    """
    Return the entries of a list of folders that hold none of the lab's own packages.

    Nor any of those without which programs run: whoever has sourced a solution would lend it to
    them. But what holds rclpy is ROS.
    """
    own, solved = _places(OWN_PACKAGES), _places(without)
    return [
        entry
        for entry in entries.split(':')
        if entry
        and not _holds(entry, own)
        and (not _holds(entry, solved) or _holds(entry, _places(['rclpy'])))
    ]


def _places(packages: Iterable[str]) -> list[str]:
    return [place for name in packages for place in (name, f'share/{name}')]


def _holds(folder: str, places: Iterable[str]) -> bool:
    # A thousand of these for each jail: to make a Path takes longer than to look.
    return any(map(os.path.isdir, (f'{folder}/{place}' for place in places)))


def _links_of(program: str) -> list[Path]:
    """Return a program and the links that lead to it."""
    ways = [Path(program)]
    while ways[-1].is_symlink():
        ways.append(Path(os.path.normpath(ways[-1].parent / ways[-1].readlink())))
    return ways


def environment_for(
    folder: Path, given: Mapping[str, str], *, without: Iterable[str] = ()
) -> dict[str, str]:
    """
    Return what a jailed program starts with: variables of ROS, a home, and the given.

    :param without: as of `mounts_of`.
    """
    allowed = {
        name: value
        for name, value in os.environ.items()
        if any(fnmatchcase(name, pattern) for pattern in _ALLOWED)
    }
    for name in allowed.keys() & set(_PATHS):
        allowed[name] = ':'.join(_shown(allowed[name], without))
    own = {'HOME': str(home_of(folder)), 'USER': 'student', 'LOGNAME': 'student'}
    own['PYTHONUTF8'] = '1'  # that of the grader's terminal is nothing to a student's program
    # Or numpy starts a thread for each processor in every program: on a large server more than
    # the limit of tasks, and they spin for a while.
    own['OPENBLAS_NUM_THREADS'] = '1'
    return {**allowed, **own, **given}


def home_of(folder: Path) -> Path:
    return folder / 'home'


def give(folder: Path, user: int) -> None:
    """
    Make a user the owner of a folder and all that is in it.

    A file with another name elsewhere is left alone: somebody else's may have been linked here.
    """
    os.chown(folder, user, user)
    for place, folders, files in os.walk(folder):
        for name in (*folders, *files):
            path = Path(place, name)
            if name in folders or path.lstat().st_nlink == 1:
                os.chown(path, user, user, follow_symlinks=False)
