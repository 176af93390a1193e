# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Run a step of the set-up and say how far it is; what the step prints is appended to a file.

    set_up_progress.py {pip|colcon} NUMBER LOG COMMAND...

NUMBER is how many packages there are, for pip about. On a terminal a bar shows them and goes with
the step; elsewhere a line comes now and then. The exit status is that of the command. It runs in
any Python, before anything is installed.
"""

from __future__ import annotations

from pathlib import Path
import re
import shutil
import signal
import subprocess
import sys
import time

LOOK_SEC = 0.2
LINE_EVERY_SEC = 15.0
TELLS_AFTER_SEC = 3.0  # how long the rest will take
WIDTH = 24
INTERRUPTED = 130
LITTLE = 0.02


class Pip:
    """Gets all packages, and then installs them without a word about each."""

    def __init__(self, expected: int, program: str) -> None:
        """
        Prepare.

        :param program: the Python that pip runs in, of a virtual environment.
        """
        self.doing = 'looking for packages'
        self._expected = expected
        self._lib = Path(program).parent.parent / 'lib'
        self._got: set[str] = set()
        self._to_install = 0
        self._before = 0

    def read(self, line: str) -> None:
        """Take a line that it has printed."""
        if found := re.match(r' *(?:Collecting|Requirement already satisfied:) ([\w.-]+)', line):
            self._got.add(found[1].lower())
        elif found := re.match(r' *Downloading .*?([^/\s]+?)-[^/\s]*( \(.*\))', line):
            self.doing = f'downloading {found[1]}{found[2]}'
        elif line.startswith('Installing collected packages:'):
            self._to_install, self._before = line.count(',') + 1, self._installed()

    def part(self) -> float:
        """Return how much is done, from 0 to 1: half of the time goes by for each of the two."""
        if not self._to_install:
            return min(len(self._got) / self._expected, 1.0) / 2.0
        count = min(max(self._installed() - self._before, 0), self._to_install)
        self.doing = f'installing {count} of {self._to_install} packages'
        return 0.5 + count / self._to_install / 2.0

    def _installed(self) -> int:
        return len(list(self._lib.glob('python3*/site-packages/*.dist-info')))


class Colcon:
    """Starts and finishes packages."""

    def __init__(self, packages: int, _program: str) -> None:
        self.doing = 'building'
        self._packages = packages
        self._finished = 0

    def read(self, line: str) -> None:
        """Take a line that it has printed."""
        if found := re.match(r'Starting >>> (\w+)', line):
            self.doing = f'building {found[1]}'
        elif line.startswith('Finished <<<'):
            self._finished += 1

    def part(self) -> float:
        """Return how much is done, from 0 to 1."""
        return min(self._finished / self._packages, 1.0)


Step = Pip | Colcon
STEPS: dict[str, type[Pip] | type[Colcon]] = {'pip': Pip, 'colcon': Colcon}


class Display:
    """What stands on stderr."""

    def __init__(self) -> None:
        self._is_bar = sys.stderr.isatty()
        self._began_sec = self._said_sec = time.monotonic()

    def show(self, step: Step) -> None:
        """Show how far a step is."""
        part, now_sec = step.part(), time.monotonic()
        text = f'{step.doing}{_left(now_sec - self._began_sec, part)}'
        if self._is_bar:
            done = round(WIDTH * part)
            width = _columns()
            bar = f'lab: [{"#" * done}{"." * (WIDTH - done)}] {text}'
            self._write('\r' + bar[:width].ljust(width))
        elif now_sec - self._said_sec > LINE_EVERY_SEC:
            self._said_sec = now_sec
            self._write(f'lab: {part:.0%}, {text}\n')

    def close(self) -> None:
        """Leave the line empty."""
        if self._is_bar:
            self._write('\r' + ' ' * _columns() + '\r')

    def _write(self, text: str) -> None:
        sys.stderr.write(text)
        sys.stderr.flush()


def _columns() -> int:
    """Return how many the bar may take."""
    # Of a terminal that does not tell its size, Python 3.10 says 0, and later ones say 80.
    return max((shutil.get_terminal_size().columns or 80) - 1, 10)


def _left(passed_sec: float, part: float) -> str:
    if passed_sec < TELLS_AFTER_SEC or not LITTLE < part < 1.0 - LITTLE:
        return ''
    return f', about {passed_sec * (1.0 - part) / part:.0f} s left'


def run() -> int:  # not main(), whose entry point `ros2 doctor` would miss
    """Run the command to its end."""
    kind, number, log, *command = sys.argv[1:]
    step = STEPS[kind](int(number), command[0])
    display = Display()
    ends_with_me = [sys.executable, str(Path(__file__).with_name('parent_death.py'))]
    with Path(log).open('a') as written, Path(log).open(errors='replace') as reads:
        reads.seek(0, 2)
        with subprocess.Popen(
            [*ends_with_me, *command], stdout=written, stderr=subprocess.STDOUT
        ) as running:
            try:
                rest = ''
                while running.poll() is None:
                    time.sleep(LOOK_SEC)
                    *lines, rest = (rest + reads.read()).split('\n')
                    for line in lines:
                        step.read(line)
                    display.show(step)
            except KeyboardInterrupt:  # which the command has got, too
                signal.signal(signal.SIGINT, signal.SIG_IGN)
                running.wait()
                return INTERRUPTED
            finally:
                display.close()
    return running.returncode


if __name__ == '__main__':
    sys.exit(run())
