#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let Fast DDS of the wheels wait without a limit where it means to.

The end of a participant waits for what its listener is being told at that moment, without a limit
(`DomainParticipant::set_listener`; it is told of participants that are discovered). The wheels'
compiler makes of that a wait by another clock, and the time until then overflows. From a negative
time `pthread_cond_timedwait` returns at once, and has not given up the mutex that the listener
needs: one of some thousand nodes never ended, used a whole core, and heard no signal.

So Fast DDS gets another function to wait with, that of unlimited_waits.c.
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
    Make the library, and let each Fast DDS of this Python that does not yet do so call it.

    :raises CalledProcessError: if TinyCC or patchelf refuses a file.
    """
    lib = Path(sysconfig.get_path('data')) / 'lib'
    compile_library(Path(__file__).with_suffix('.c'), lib / LIBRARY)
    for fast_dds in sorted(lib.glob('libfastrtps.so*')):
        if LIBRARY not in _patchelf('--print-needed', fast_dds).split():
            redirect(fast_dds)


def redirect(fast_dds: Path) -> None:
    """Change the name that a library waits by, in a copy that then takes its place."""
    new, names = fast_dds.with_suffix('.new'), fast_dds.with_suffix('.names')
    names.write_text(_RENAMED, encoding='utf-8')
    shutil.copy2(fast_dds, new)
    _patchelf('--rename-dynamic-symbols', names, new)
    _patchelf('--add-needed', LIBRARY, new)
    names.unlink()
    new.replace(fast_dds)


def _patchelf(*words: str | Path) -> str:
    command = [Path(sysconfig.get_path('scripts'), 'patchelf'), *words]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


if __name__ == '__main__':
    main()
