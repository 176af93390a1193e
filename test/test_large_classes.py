# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The files in docs/large_classes, run as they are with a share for each of two machines."""

from collections.abc import Mapping
import os
from pathlib import Path
import shutil
import subprocess
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[1]
FILES = ROOT / 'docs' / 'large_classes'
SECRET = {'HUSKY_GRADING_SECRET': 'b' * 32}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with an export of Moodle, and with the lab as the machines see it."""
    for number, name in enumerate(('Ann Lee', 'Bob Roy')):
        place = tmp_path / 'handed_in' / f'{name}_{1000 + number}_assignsubmission_file'
        place.mkdir(parents=True)
        (place / 'path.yaml').write_text('waypoints: [[0, 0], [-0.5, 0]]\n')
    shutil.make_archive(str(tmp_path / 'submissions'), 'zip', tmp_path / 'handed_in')
    # The class is one of waypoint files, for which there is nothing to build.
    rubric = ROOT / 'config' / 'rubrics' / 'path.yaml'
    (tmp_path / 'lab').write_text(
        f'#!/usr/bin/env bash\nexec python3 -m husky_grader.grade "${{@:2}}" --rubric {rubric}\n'
    )
    (tmp_path / 'lab').chmod(0o755)
    return tmp_path


def run(text: str, folder: Path, variables: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(
        ['bash', '-euc', text],
        cwd=folder,
        env={**os.environ, 'XDG_STATE_HOME': str(folder / 'state'), **variables},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done


def read(name: str) -> dict[Any, Any]:
    """Return a YAML file; there, `on` is a truth value, as in every YAML 1.1."""
    content: dict[Any, Any] = yaml.safe_load((FILES / name).read_text())
    return content


def graded(folder: Path) -> list[str]:
    """Return who was graded, by shards."""
    return sorted(
        str(path.parent.relative_to(folder)) for path in folder.glob('shards/*/*/lab.json')
    )


def uploaded(job: Mapping[str, Any], folder: Path) -> list[Path]:
    """Return the files in an artifact: in the first folder of its path, without the others."""
    (step,) = (each for each in job['steps'] if 'upload-artifact' in each.get('uses', ''))
    top, *others = step['with']['path'].split()
    assert all(each.startswith(f'!{top}/') for each in others)
    left_out = {path for each in others for path in folder.glob(each[1:])}
    files = (path for path in (folder / top).rglob('*') if path.is_file())
    return [path for path in files if left_out.isdisjoint(path.parents)]


def test_the_slurm_array_grades_a_class(folder: Path) -> None:
    text = (FILES / 'slurm.sbatch').read_text()
    assert '$LAB/lab grade --lab $HANDED_IN --report class --collect $SHARDS/*' in text
    given = {'LAB': '.', 'HANDED_IN': 'submissions.zip', 'SHARDS': 'shards', **SECRET}
    for number in ('1', '2'):
        task = {'SLURM_ARRAY_TASK_ID': number, 'SLURM_ARRAY_TASK_COUNT': '2'}
        run(text, folder, {**given, **task})
    assert [name[:12] for name in graded(folder)] == ['shards/1/Ann', 'shards/2/Bob']


def test_the_kubernetes_job_grades_a_share(folder: Path) -> None:
    spec = read('kubernetes.yaml')['spec']
    (container,) = spec['template']['spec']['containers']
    names = {each['name']: each.get('value') for each in container['env']}
    assert names['COUNT'] == str(spec['completions'])
    assert 'HUSKY_GRADING_SECRET' in names
    pod = {'JOB_COMPLETION_INDEX': '1', 'COUNT': '2', 'CLASS': '.', **SECRET}
    run(container['command'][-1], folder, pod)
    assert [name[:12] for name in graded(folder)] == ['shards/2/Bob']


def test_the_matrix_of_github_grades_a_class(folder: Path) -> None:
    jobs = read('github_matrix.yml')['jobs']
    jail, share = (step for step in jobs['grade']['steps'] if 'run' in step)
    same_jail, together = (step for step in jobs['collect']['steps'] if 'run' in step)
    assert same_jail == jail  # what is missing is graded in the second job
    run(share['run'], folder, {'SHARD': '1', 'COUNT': '2', **SECRET})
    (ann,) = folder.glob('shards/1/*/lab.json')
    done = run(together['run'], folder, SECRET)  # the other machine has never answered
    assert [line.split()[0] for line in done.stdout.splitlines()[:2]] == ['Ann', 'Bob']
    collected = {path.stat().st_mtime_ns for path in folder.glob('class/*/lab.json')}
    assert len(collected) == 2
    assert ann.stat().st_mtime_ns in collected, 'it was graded again'


def test_no_name_that_a_student_gave_keeps_a_share_from_github(folder: Path) -> None:
    for report in ('shards/1/Ann', 'class/Ann', 'report'):
        (folder / report).mkdir(parents=True)
        (folder / report / 'lab.json').touch()
        (folder / report / '.graded').touch()
        for place in ('built', 'handed_in', 'running-1a2b3c4d'):
            (folder / report / place / 'src').mkdir(parents=True)
            (folder / report / place / 'src' / 'a:b').touch()
    jobs = read('github_matrix.yml')['jobs']
    of_one = read('../workflows/grade.yml')['jobs']['grade']
    for job in (jobs['grade'], jobs['collect'], of_one):
        assert sorted(path.name for path in uploaded(job, folder)) == ['.graded', 'lab.json']
