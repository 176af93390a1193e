# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Presses Ctrl-C at every moment of the first second of every command.

    ./lab exec python3 benchmark/interrupts.py [--step SEC] [NAME...]

Each run must end within 2 s of it, without a traceback, with nothing left that it started.
"""

import argparse
import codecs
from collections.abc import Sequence
import contextlib
from dataclasses import dataclass
import fcntl
import os
from pathlib import Path
import pty
import signal
import subprocess
import sys
import tempfile
import termios
import threading
import time

ROOT = Path(__file__).resolve().parent.parent
COURSE = str(ROOT / 'config' / 'waypoints' / 'straight.yaml')
LAB = str(ROOT / 'lab')
END_WITHIN_SEC = 2.0
CTRL_C = b'\x03'
PAGE = ('--ros-args', '-p', 'port:=18380')
COMMANDS: dict[str, tuple[str, ...]] = {
    'ros2 topic list': ('ros2', 'topic', 'list'),
    'ros2 topic echo': ('ros2', 'topic', 'echo', '/chatter', 'std_msgs/msg/String'),
    'ros2 topic pub': ('ros2', 'topic', 'pub', '/chatter', 'std_msgs/msg/String', '{data: hi}'),
    'ros2 doctor': ('ros2', 'doctor'),
    'publisher': ('ros2', 'run', 'topic_demo', 'publisher'),
    'subscriber': ('ros2', 'run', 'topic_demo', 'subscriber'),
    'husky_sim': ('ros2', 'run', 'husky_sim', 'husky_sim'),
    'view': ('ros2', 'run', 'husky_view', 'view', *PAGE),
    'follow_path': ('ros2', 'run', 'husky_driver', 'follow_path', '--waypoints', COURSE),
    'check': ('ros2', 'run', 'husky_grader', 'check', COURSE),
    'grade': ('ros2', 'run', 'husky_grader', 'grade', COURSE, '--report', 'graded'),
    'rqt_graph': ('ros2', 'run', 'rqt_graph', 'rqt_graph'),
    'ros2 launch': ('ros2', 'launch', 'husky_sim', 'husky_playpen.launch.py', 'headless:=true'),
    'lab drive': (LAB, 'drive', '--no-view', '--report', 'driven'),
    'lab test': (LAB, 'test', 'test/test_drive.py'),
    'lab grade': (LAB, 'grade', COURSE, '--report', 'graded'),
    'lab view': (LAB, 'view', 'graded'),
    'lab exec': (LAB, 'exec', 'ros2', 'run', 'topic_demo', 'publisher'),
}
SIGNS = (
    'Traceback',
    '\nKeyboardInterrupt',
    'Fatal Python',
    'Exception ignored',
    'terminate called',
)


@dataclass(frozen=True)
class Ending:
    """How a command took Ctrl-C."""

    output: str  # after it
    ended_before: bool
    took_sec: float | None  # None: it had to be killed
    left: tuple[int, ...]  # processes of its session that lived on

    @property
    def is_clean(self) -> bool:
        """Tell whether a person has nothing to complain about."""
        told = any(sign in self.output for sign in SIGNS)
        return self.took_sec is not None and not self.left and not told


def interrupt(command: Sequence[str], *, after_sec: float, folder: Path) -> Ending:
    """Start a command on a terminal, and press Ctrl-C there after a time."""
    keyboard, terminal = pty.openpty()
    child = subprocess.Popen(
        command, cwd=folder, stdin=terminal, stdout=terminal, stderr=terminal,
        start_new_session=True, preexec_fn=_take_terminal,
    )  # fmt: skip
    os.close(terminal)
    read = Reader(keyboard)
    time.sleep(after_sec)
    before, ended_before = len(read.text), child.poll() is not None
    begun = time.monotonic()
    os.write(keyboard, CTRL_C)
    took_sec: float | None = None
    try:
        child.wait(END_WITHIN_SEC)
        took_sec = time.monotonic() - begun
    except subprocess.TimeoutExpired:
        pass
    while (left := _session(child.pid)) and time.monotonic() < begun + END_WITHIN_SEC:
        time.sleep(0.005)
    for pid in left:
        os.kill(pid, signal.SIGKILL)
    child.wait()
    read.to_end()
    os.close(keyboard)
    return Ending(read.text[before:].replace('^C', ''), ended_before, took_sec, left)


def _take_terminal() -> None:
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # a shell's background job ignores it


class Reader:
    """Reads what a terminal shows, beside."""

    def __init__(self, keyboard: int) -> None:
        self._keyboard = keyboard
        self.text = ''
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self) -> None:
        decoder = codecs.getincrementaldecoder('utf-8')('replace')
        with contextlib.suppress(OSError):  # the last program that had the terminal has ended
            while data := os.read(self._keyboard, 65536):
                self.text += decoder.decode(data)

    def to_end(self) -> None:
        self._thread.join(1.0)


def _session(leader: int) -> tuple[int, ...]:
    """Return the living processes of a session."""
    found = []
    for stat in Path('/proc').glob('[0-9]*/stat'):
        try:
            state, _, _, session = stat.read_text().rpartition(')')[2].split()[:4]
        except OSError:
            continue  # it has ended meanwhile
        if int(session) == leader and state != 'Z':
            found.append(int(stat.parent.name))
    return tuple(found)


def main() -> int:
    """Sweep, and print one line a command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('names', metavar='NAME', nargs='*', default=list(COMMANDS))
    parser.add_argument('--step', type=float, default=0.02, help='seconds between two moments')
    options = parser.parse_args()
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        moments = [i * options.step for i in range(round(1.0 / options.step) + 1)]
        for name in options.names:
            endings = {
                moment: interrupt(COMMANDS[name], after_sec=moment, folder=Path(folder))
                for moment in moments
            }
            unclean = {moment: end for moment, end in endings.items() if not end.is_clean}
            taken = [end for end in endings.values() if not end.ended_before]
            said = [len(end.output.strip().splitlines()) for end in taken]
            slowest = max(moments, key=lambda moment: endings[moment].took_sec or END_WITHIN_SEC)
            longest_sec = endings[slowest].took_sec or END_WITHIN_SEC
            print(
                f'{name:16} {len(unclean)} of {len(moments)} unclean, '
                f'{longest_sec:.2f} s at most, at {slowest:.2f} s; {said.count(0)} silent, '
                f'{said.count(1)} with one line, {max(said, default=0)} lines at most; '
                f'{len(endings) - len(taken)} had ended'
            )
            for moment, ending in unclean.items():
                print(f'--- at {moment:.2f} s: {ending.took_sec} s, left {ending.left}')
                print(ending.output[-1500:])
            sys.stdout.flush()
            bad += len(unclean)
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
