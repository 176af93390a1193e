# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Grade twenty submissions on a quiet machine, a busy one and half of a core; all must agree.

They are graded alone, beside four spinning processes, and in a cgroup with 0.5 CPU. What is
compared is each lab.json, byte for byte, without what the students' programs have printed, which
may have the time in it. Run it with
`./lab exec python3 benchmark/same_everywhere.py [NAME...]`; names are those of submissions.
A cgroup takes the right to make one (root, in a container often not): where there is none, a line
says so. Exit status 1 if two differ.
"""

from argparse import ArgumentParser
from collections.abc import Iterator
from contextlib import contextmanager
import json
import os
from pathlib import Path
import subprocess
import sys
import tempfile
import time

from repeatability import load, SPINNING
from twenty_submissions import COURSE, hand_in, RUBRIC, SUBMISSIONS

PERIOD_USEC, QUOTA_USEC = 100_000, 50_000  # 0.5 CPU
EMPTY_WITHIN_SEC = 10.0
CGROUPS = Path('/sys/fs/cgroup')


@contextmanager
def half_a_core() -> Iterator[Path | None]:
    """Make a cgroup with 0.5 CPU, of version 2 or 1; None where that is not allowed."""
    unified = (CGROUPS / 'cgroup.controllers').is_file()
    place = (CGROUPS if unified else CGROUPS / 'cpu') / f'same_everywhere_{os.getpid()}'
    try:
        place.mkdir()
    except OSError:
        yield None
        return
    try:
        if unified:
            (place / 'cpu.max').write_text(f'{QUOTA_USEC} {PERIOD_USEC}')
        else:
            (place / 'cpu.cfs_period_us').write_text(str(PERIOD_USEC))
            (place / 'cpu.cfs_quota_us').write_text(str(QUOTA_USEC))
        yield place
    except OSError:  # the controller is not given to us
        yield None
    finally:
        remove(place)


def remove(cgroup: Path) -> None:
    """Remove a cgroup when the last of its processes has ended, which was just killed."""
    deadline = time.monotonic() + EMPTY_WITHIN_SEC
    while True:
        try:
            return cgroup.rmdir()
        except OSError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)


def grade(folder: Path, report: Path, cgroup: Path | None = None) -> dict[str, str]:
    """Grade all of a folder; return what is compared of each."""
    command = [sys.executable, '-m', 'husky_grader.grade', '--lab']
    command += [str(each) for each in sorted((folder / 'handed_in').iterdir())]
    command += ['--rubric', str(folder / 'rubric.yaml'), '--report', str(report)]
    if cgroup is not None:
        enter = f'echo $$ >{cgroup}/cgroup.procs && exec "$@"'
        command = ['bash', '-c', enter, 'bash', *command]
    begun = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True)
    print(f'{report.name}: {time.monotonic() - begun:.0f} s', flush=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    files = sorted(report.rglob('lab.json'))
    return {str(file.parent.relative_to(report)): compared(file) for file in files}


def compared(file: Path) -> str:
    content = json.loads(file.read_text())
    for step in content['steps']:
        del step['printed']
    return json.dumps(content, indent=2)


def show(name: str, quiet: str, other: str) -> None:
    """Print the lines in which two results differ."""
    for before, after in zip(quiet.splitlines(), other.splitlines(), strict=False):
        if before != after:
            print(f'  {name}\n    {before.strip()}\n    {after.strip()}')


def main() -> int:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('names', metavar='NAME', nargs='*')
    names = parser.parse_args().names
    if unknown := set(names) - set(SUBMISSIONS):
        parser.error(f'{", ".join(sorted(unknown))}: allowed are {", ".join(SUBMISSIONS)}')
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        hand_in(folder / 'handed_in')
        for name in SUBMISSIONS if names else ():
            if name not in names:
                (folder / 'handed_in' / name).rename(folder / f'not_{name}')
        (folder / 'course.yaml').write_text(COURSE)
        (folder / 'rubric.yaml').write_text(RUBRIC)
        quiet = grade(folder, folder / 'quiet')
        for name, result in quiet.items():
            print(f'  {name}: {json.loads(result)["score"]:.1f}')
        with load(SPINNING):
            results = {'busy': grade(folder, folder / 'busy')}
        with half_a_core() as cgroup:
            if cgroup is None:
                print('no cgroup can be made here: nothing is graded in 0.5 CPU')
            else:
                results['half a core'] = grade(folder, folder / 'half a core', cgroup)
        same = True
        for how, found in results.items():
            differing = [name for name in quiet if found.get(name) != quiet[name]]
            print(f'{how}: {len(quiet) - len(differing)} of {len(quiet)} the same')
            for name in differing:
                show(name, quiet[name], found.get(name, ''))
            same = same and not differing
    return 0 if same else 1


if __name__ == '__main__':
    sys.exit(main())
