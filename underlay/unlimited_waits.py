#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let the wheels wait without a limit where they mean to.

Libraries of theirs have waits for a condition that end at the last time there is. Their compiler
makes of such a wait one by another clock, and the time until then overflows. From a negative time
`pthread_cond_timedwait` returns at once, and has not given up the mutex that others need to make
the condition true.

* The end of a participant waits for what its listener is being told at that moment of others that
  are discovered (`DomainParticipant::set_listener` of Fast DDS): one of some thousand nodes never
  ended, used a whole core, and heard no signal.
* `spin()` of rclpy's EventsExecutor waits for the next event: it never heard of one.

So they get another function to wait with, that of unlimited_waits.c.
"""

from __future__ import annotations

from pathlib import Path
import shutil
import subprocess
import sysconfig

from rosidl_typesupport_python.build_native import compile_library

LIBRARY = 'libunlimited_waits.so'
_RENAMED = 'pthread_cond_timedwait unlimited_cond_timedwait\n'


def main() -> None:
    """
    Make the library, and let each that waits and does not yet do so call it.

    :raises CalledProcessError: if TinyCC or patchelf refuses a file.
    """
    compile_library(Path(__file__).with_suffix('.c'), _lib() / LIBRARY)
    for library in waiting_libraries():
        if LIBRARY not in _patchelf('--print-needed', library).split():
            redirect(library)


def waiting_libraries() -> list[Path]:
    """Return all libraries of ROS in the wheels that call `pthread_cond_timedwait`."""
    lib, rclpy = _lib(), Path(sysconfig.get_path('platlib'), 'rclpy')
    shared = (*lib.glob('libfastrtps.so*'), *lib.glob('librmw_fastrtps_shared_cpp.so*'))
    return sorted((*shared, *rclpy.glob('_rclpy_pybind11.*.so')))


def redirect(library: Path) -> None:
    """Change the name that a library waits by, in a copy that then takes its place."""
    # What an interrupted set-up leaves is not taken for a library.
    new, names = (library.with_name(f'.{library.name}.{kind}') for kind in ('new', 'names'))
    names.write_text(_RENAMED, encoding='utf-8')
    shutil.copy2(library, new)
    _patchelf('--rename-dynamic-symbols', names, new)
    _patchelf('--add-needed', LIBRARY, new)
    names.unlink()
    new.replace(library)


def _lib() -> Path:
    return Path(sysconfig.get_path('data'), 'lib')


def _patchelf(*words: str | Path) -> str:
    command = [Path(sysconfig.get_path('scripts'), 'patchelf'), *words]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


if __name__ == '__main__':
    main()
