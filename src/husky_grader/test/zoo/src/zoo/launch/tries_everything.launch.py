# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launches a right talker, after a try at all that is not its own; run twice, it finds nothing."""

from contextlib import suppress
import os
from pathlib import Path
import signal
import sys

from launch import LaunchDescription
from launch_ros.actions import Node

FORGED = ('sitecustomize.py', 'usercustomize.py', 'forged.pth', 'lab.json', 'finding.json')


def generate_launch_description() -> LaunchDescription:
    """Print what it found of an earlier run, and what it wrote where others read."""
    home = Path.home()
    own = (home, home / '.ros', Path.cwd(), Path('/tmp'), Path('/dev/shm'))
    for left in (left for place in own for left in place.glob('*.kept')):
        print('found', left, flush=True)
    for place in own:
        with suppress(OSError):
            (place / 'launch.kept').write_text('for the next step')
    share = Path(__file__).resolve().parent
    reports = share.parents[6]
    others = [share, *share.parents[:6], reports, *map(Path, sys.path)]
    with suppress(OSError):
        others += reports.iterdir()
    for place in {*others, Path(sys.prefix), Path('/etc')}:
        for name in FORGED:
            with suppress(OSError):
                (place / name).write_text('import os; os._exit(7)')
                print('wrote', place / name, flush=True)
    for number in (signal.SIGTERM, signal.SIGKILL, signal.SIGSTOP):
        with suppress(OSError):
            os.kill(1, number)
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            signal.pause()
        os._exit(0)
    full = Path('/dev/shm/full')
    with suppress(OSError):
        full.write_bytes(bytes(100_000_000))
    full.unlink()  # or its own node would end
    os.write(1, b'no more than a line\n' * 250_000)
    for output in (1, 2):
        os.dup2(os.open(os.devnull, os.O_WRONLY), output)
    return LaunchDescription([Node(package='zoo', executable='talks_right')])
