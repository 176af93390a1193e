#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Mend what libraries of the wheels call of libc: they call other functions in its place.

**pthread_cond_timedwait**: libraries wait for a condition until the last time there is. Their
compiler makes of such a wait one by another clock, and the time until then overflows. From a
negative time it returns at once, and has not given up the mutex that others need to make the
condition true. So they wait without a limit, as they mean to: unlimited_waits.c.

* The end of a participant waits for what its listener is being told at that moment of others that
  are discovered (`DomainParticipant::set_listener` of Fast DDS): one of some thousand nodes never
  ended, used a whole core, and heard no signal.
* `spin()` of rclpy's EventsExecutor waits for the next event: it never heard of one.

**shm_unlink**: a node takes the port in shared memory of one that was killed: Fast DDS removes it,
and makes another of that name. Those that run have the old one open. They look after 2 s to 3 s
whether who listened there lives, by whether it waits, or is at the same message for long: one that
was killed between the two is never found dead. Then all that they send to the new node is lost,
for as long as they run, in silence. So a port is marked as bad before it is removed, as Fast DDS
marks one that it finds dead, and all open the new one at once: removed_ports.c.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
import shutil
import subprocess
import sysconfig

from rosidl_typesupport_python.build_native import compile_library


@dataclass(frozen=True)
class Mend:
    """A function of a file in C beside this one, that is called in place of one of libc."""

    source: str  # without its suffix
    called: str
    function: str

    @property
    def library(self) -> str:
        return f'lib{self.source}.so'


WAITS = Mend('unlimited_waits', 'pthread_cond_timedwait', 'unlimited_cond_timedwait')
PORTS = Mend('removed_ports', 'shm_unlink', 'mark_and_unlink')


def main() -> None:
    """
    Make the libraries, and let each of the wheels that does not yet do so call them.

    :raises CalledProcessError: if TinyCC or patchelf refuses a file.
    """
    for mend, libraries in ((WAITS, waiting_libraries()), (PORTS, fast_dds())):
        source = Path(__file__).with_name(f'{mend.source}.c')
        compile_library(source, _lib() / mend.library)
        for library in libraries:
            if mend.library not in _patchelf('--print-needed', library).split():
                redirect(library, mend)


def waiting_libraries() -> list[Path]:
    """Return all libraries of ROS in the wheels that call `pthread_cond_timedwait`."""
    rclpy = Path(sysconfig.get_path('platlib'), 'rclpy')
    shared = _lib().glob('librmw_fastrtps_shared_cpp.so*')
    return sorted((*fast_dds(), *shared, *rclpy.glob('_rclpy_pybind11.*.so')))


def fast_dds() -> list[Path]:
    """Return Fast DDS of the wheels, under each of its names."""
    return sorted(_lib().glob('libfastrtps.so*'))


def redirect(library: Path, mend: Mend) -> None:
    """Change the name that a library calls, in a copy that then takes its place."""
    # What an interrupted set-up leaves is not taken for a library.
    new, names = (library.with_name(f'.{library.name}.{kind}') for kind in ('new', 'names'))
    names.write_text(f'{mend.called} {mend.function}\n', encoding='utf-8')
    shutil.copy2(library, new)
    _patchelf('--rename-dynamic-symbols', names, new)
    _patchelf('--add-needed', mend.library, new)
    names.unlink()
    new.replace(library)


def _lib() -> Path:
    return Path(sysconfig.get_path('data'), 'lib')


def _patchelf(*words: str | Path) -> str:
    command = [Path(sysconfig.get_path('scripts'), 'patchelf'), *words]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


if __name__ == '__main__':
    main()
