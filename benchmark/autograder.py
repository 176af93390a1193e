# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Grade the lab sheet's solution as Gradescope does by default: in half a core and 768 MB.

The zip is made and unpacked, and its run_autograder grades the solution as root without the right
to namespaces, in a cgroup. What is printed is the wall time, the points, and the memory: the most
that programs held (pages of files, which the kernel can drop, left out), the most with these, and
how many processes were killed for want of it. Run it as root with
`./lab exec python3 benchmark/autograder.py [--set-up] [--runs N] [--mb MB] [--cores CORES]`; with
--set-up, setup.sh first sets up a lab of its own, as in Gradescope's image: that takes minutes and
1 GB. Exit status 1 if points are missing.
"""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
import json
import os
from pathlib import Path
import subprocess
import sys
import tempfile
import time
import zipfile

from husky_grader.autograder.gradescope_zip import make_gradescope
from husky_grader.playpen import default_rubric
from husky_grader.rubric.rubric_file import load_rubric

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / 'test'))

from playpen_testing.container import in_container  # noqa: E402
from playpen_testing.solution import write_solution  # noqa: E402

CGROUPS = Path('/sys/fs/cgroup')
CPU_PERIOD_USEC = 100_000
SAMPLE_SEC = 0.1
SYSTEM = '/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin'


@dataclass
class Cgroup:
    """A cgroup of version 2, or two of version 1."""

    cpu: Path
    memory: Path
    is_unified: bool
    held: list[int] = field(default_factory=list)  # bytes of the programs, sampled

    def sample(self) -> None:
        used = _numbers(self.memory / 'memory.stat')
        names = ('anon', 'shmem') if self.is_unified else ('total_rss', 'total_shmem')
        self.held.append(sum(used.get(name, 0) for name in names))

    @property
    def most_bytes(self) -> int:
        name = 'memory.peak' if self.is_unified else 'memory.max_usage_in_bytes'
        return int((self.memory / name).read_text())

    @property
    def killed(self) -> int:
        name = 'memory.events' if self.is_unified else 'memory.oom_control'
        return _numbers(self.memory / name)['oom_kill']


def _numbers(file: Path) -> dict[str, int]:
    return {name: int(value) for name, value in map(str.split, file.read_text().splitlines())}


@contextmanager
def cgroup_of(cores: float, mb: int) -> Iterator[Cgroup]:
    """Make a cgroup with so many cores and so much memory."""
    name, quota = f'autograder_{os.getpid()}', str(round(cores * CPU_PERIOD_USEC))
    is_unified = (CGROUPS / 'cgroup.controllers').is_file()
    if is_unified:
        made = Cgroup(CGROUPS / name, CGROUPS / name, is_unified)
        made.cpu.mkdir()
        (made.cpu / 'cpu.max').write_text(f'{quota} {CPU_PERIOD_USEC}')
        (made.memory / 'memory.max').write_text(str(mb * 2**20))
    else:
        made = Cgroup(CGROUPS / 'cpu' / name, CGROUPS / 'memory' / name, is_unified)
        made.cpu.mkdir()
        made.memory.mkdir()
        (made.cpu / 'cpu.cfs_period_us').write_text(str(CPU_PERIOD_USEC))
        (made.cpu / 'cpu.cfs_quota_us').write_text(quota)
        (made.memory / 'memory.limit_in_bytes').write_text(str(mb * 2**20))
    try:
        yield made
    finally:
        for place in {made.cpu, made.memory}:
            place.rmdir()


def grade(autograder: Path, lab: Path, cgroup: Cgroup) -> float:
    """Run the script in the cgroup; return the wall time."""
    enter = f'echo $$ >{cgroup.cpu}/cgroup.procs; echo $$ >{cgroup.memory}/cgroup.procs'
    script = [str(autograder / 'source' / 'run_autograder')]
    begun_sec = time.monotonic()
    with subprocess.Popen(
        ['bash', '-c', f'{enter}; exec "$@"', 'bash', *in_container(script)],
        cwd=autograder,
        env={'PATH': SYSTEM, 'HUSKY_AUTOGRADER': str(autograder), 'HUSKY_LAB': str(lab)},
        stdout=subprocess.DEVNULL,
    ) as running:
        while running.poll() is None:
            cgroup.sample()
            time.sleep(SAMPLE_SEC)
    return time.monotonic() - begun_sec


def unpack(place: Path) -> Path:
    """Make what Gradescope's /autograder is, with the solution handed in."""
    make_gradescope(place / 'autograder.zip', load_rubric(default_rubric()))
    autograder = place / 'autograder'
    with zipfile.ZipFile(place / 'autograder.zip') as archive:
        archive.extractall(autograder / 'source')
    for name in ('setup.sh', 'run_autograder'):
        (autograder / 'source' / name).chmod(0o755)
    (autograder / 'submission').mkdir()
    write_solution(autograder / 'submission')
    return autograder


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--set-up', action='store_true')
    parser.add_argument('--runs', type=int, default=3)
    parser.add_argument('--mb', type=int, default=768)
    parser.add_argument('--cores', type=float, default=0.5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o755)
        autograder, lab = unpack(Path(name)), ROOT
        if options.set_up:
            begun_sec = time.monotonic()
            script = str(autograder / 'source' / 'setup.sh')
            environment = {'PATH': SYSTEM, 'HUSKY_AUTOGRADER': str(autograder)}
            subprocess.run(in_container([script]), env=environment, check=True)
            print(f'set up in {time.monotonic() - begun_sec:.0f} s')
            lab = autograder / 'lab'
        is_good = True
        for _ in range(options.runs):
            with cgroup_of(options.cores, options.mb) as cgroup:
                took_sec = grade(autograder, lab, cgroup)
                results = json.loads((autograder / 'results' / 'results.json').read_text())
                print(
                    f'{took_sec:.0f} s, {results["score"]:g} points, '
                    f'{max(cgroup.held) / 2**20:.0f} MB held, '
                    f'{cgroup.most_bytes / 2**20:.0f} MB with files, {cgroup.killed} killed; '
                    f'{results["output"]}',
                    flush=True,
                )
            is_good = (
                is_good
                and bool(results.get('tests'))
                and all(test['status'] == 'passed' for test in results['tests'])
            )
    return 0 if is_good else 1


if __name__ == '__main__':
    sys.exit(main())
