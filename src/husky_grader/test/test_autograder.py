# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The scripts that others run to grade a submission, run as they are."""

from collections.abc import Mapping, Sequence
import io
import json
import os
from pathlib import Path
import shutil
import subprocess
import sys
import tarfile
from typing import Any
import zipfile

from husky_course.record import FILE_NAME, read_record
from husky_grader.autograder.gradescope_zip import make_gradescope
from husky_grader.autograder.packed_lab import packed_lab
from husky_grader.playpen import default_rubric
from husky_grader.rubric.rubric_file import load_rubric
from playpen_testing.autograder_shapes import check_classroom50, check_gradescope
from playpen_testing.container import in_container
from playpen_testing.solution import write_solution
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[3]
DOCS = ROOT / 'docs'
COURSE = 'speed: 0.8\nwaypoints: [[0, 0], [1.5, -1.0]]\n'
DRIVING = """
title: Driving
world: worlds/yard.xml
steps:
  - kind: build
    points: 10
  - kind: drive
    points: 30
    package: my_driver
    executable: follow_path
    courses:
      - file: courses/short.yaml
"""
YARD = '<mujoco><option timestep="0.004"/><include file="ground.xml"/></mujoco>'
GROUND = '<mujoco><worldbody><geom type="plane" size="9 9 1"/></worldbody></mujoco>'
LOOKING = """
title: Looking
steps:
  - kind: package
    points: 10
    package: my_driver
    dependencies: [rclpy, geometry_msgs]
  - kind: package
    points: 10
    package: topic_demo
"""


@pytest.fixture(scope='module')
def rubric_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('rubric')
    (folder / 'courses').mkdir()
    (folder / 'courses' / 'short.yaml').write_text(COURSE)
    (folder / 'worlds').mkdir()
    (folder / 'worlds' / 'yard.xml').write_text(YARD)
    (folder / 'worlds' / 'ground.xml').write_text(GROUND)
    (folder / 'driving.yaml').write_text(DRIVING)
    return folder / 'driving.yaml'


@pytest.fixture(scope='module')
def packed(rubric_file: Path) -> Path:
    """Return the zip for Gradescope."""
    make_gradescope(rubric_file.with_name('autograder.zip'), load_rubric(rubric_file))
    return rubric_file.with_name('autograder.zip')


@pytest.fixture
def autograder(tmp_path: Path, packed: Path) -> Path:
    """Return what Gradescope's /autograder is, with an empty submission."""
    folder = tmp_path / 'autograder'
    for name in ('source', 'submission', 'results'):
        (folder / name).mkdir(parents=True)
    with zipfile.ZipFile(packed) as archive:
        archive.extractall(folder / 'source')
    return folder


def write_driver(folder: Path, rubric_file: Path) -> Path:
    """Write a workspace with a driver of the short course; return it."""
    workspace = write_solution(folder, rubric_file.parent / 'courses' / 'short.yaml')
    shutil.rmtree(workspace / 'src' / 'topic_demo')
    return workspace


def graded(autograder: Path, words: Sequence[str] = (), **more: str) -> dict[str, Any]:
    """Let Gradescope's script grade what was handed in; return results.json."""
    settings = {'HUSKY_AUTOGRADER': str(autograder), 'HUSKY_LAB': str(ROOT), **more}
    done = subprocess.run(
        [*words, 'bash', str(autograder / 'source' / 'run_autograder')],
        cwd=autograder,
        env={**os.environ, **settings},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    results: dict[str, Any] = json.loads((autograder / 'results' / 'results.json').read_text())
    check_gradescope(results)
    return results


def test_the_zip_has_two_scripts_a_rubric_and_the_lab(tmp_path: Path) -> None:
    rubric = load_rubric(default_rubric())
    for name in ('one.zip', 'two.zip'):
        make_gradescope(tmp_path / name, rubric)
    assert (tmp_path / 'one.zip').read_bytes() == (tmp_path / 'two.zip').read_bytes()
    with zipfile.ZipFile(tmp_path / 'one.zip') as archive:
        modes = {entry.filename: entry.external_attr >> 16 for entry in archive.infolist()}
        lab = io.BytesIO(archive.read('lab.tar.gz'))
    assert sorted(modes) == [
        *('lab.tar.gz', 'rubric.txt', 'rubric/rubrics/ros_packages_and_topics.yaml'),
        *('rubric/waypoints/central_barrier.yaml', 'run_autograder', 'setup.sh'),
    ]
    assert (modes['setup.sh'], modes['run_autograder']) == (0o755, 0o755)
    with tarfile.open(fileobj=lab) as packed:
        names = packed.getnames()
        assert packed.getmember('lab').mode == 0o755
        assert packed.getmember('lab').mtime > 315_532_800  # 1980, where a wheel's times begin
    assert {'requirements/ros.in', 'worlds/playpen.xml', 'src/husky_grader/setup.py'} <= set(names)
    made = ('.venv', '.git', 'build', 'install', 'log', 'report')
    assert [name for name in names if name.startswith(made) or '__pycache__' in name] == []


def test_a_lab_that_is_no_clone_is_packed_too(tmp_path: Path, rubric_file: Path) -> None:
    lab = tmp_path / 'lab'
    for name in ('src/husky_sim/__pycache__', 'config', '.venv/bin'):
        (lab / name).mkdir(parents=True)
    for name in ('lab', 'config/a.yaml', 'src/husky_sim/__pycache__/a.pyc', '.venv/bin/python'):
        (lab / name).write_text('')
    make_gradescope(tmp_path / 'a.zip', load_rubric(rubric_file), lab=lab)
    with zipfile.ZipFile(tmp_path / 'a.zip') as archive:
        packed = io.BytesIO(archive.read('lab.tar.gz'))
    with tarfile.open(fileobj=packed) as names:
        assert names.getnames() == ['config/a.yaml', 'lab']
    with pytest.raises(ValueError, match='not the folder of the lab'):
        make_gradescope(tmp_path / 'b.zip', load_rubric(rubric_file), lab=tmp_path)


def test_a_clone_that_git_does_not_read_is_refused(tmp_path: Path) -> None:
    (tmp_path / '.git').mkdir()  # as one of another user, git takes it for none
    (tmp_path / 'lab').touch()
    with pytest.raises(ValueError, match='git does not tell which files are of the lab: fatal: '):
        packed_lab(tmp_path)


def test_a_course_named_by_its_place_here_is_refused(rubric_file: Path) -> None:
    wrong = rubric_file.with_name('wrong.yaml')
    wrong.write_text(DRIVING.replace('courses/short', f'{rubric_file.parent}/courses/short'))
    with pytest.raises(ValueError, match=r'names the file .* by its place on this computer'):
        make_gradescope(wrong.with_suffix('.zip'), load_rubric(wrong))
    assert not wrong.with_suffix('.zip').exists()


def test_set_up_unpacks_the_lab_and_fails_loudly(autograder: Path) -> None:
    # Without a Python: what comes after is the set-up that `./lab` itself is tested by.
    done = subprocess.run(
        ['bash', str(autograder / 'source' / 'setup.sh')],
        env={
            'HUSKY_AUTOGRADER': str(autograder),
            'PATH': os.environ['PATH'],
            'PYTHON': '/nowhere',
        },
        capture_output=True,
        text=True,
    )
    assert done.returncode == 2, done.stderr
    assert 'Python 3.10 to 3.14 is needed' in done.stderr.splitlines()[-1]
    assert (autograder / 'source').stat().st_mode & 0o777 == 0o700
    assert (autograder / 'lab' / 'lab').read_text() == (ROOT / 'lab').read_text()


@pytest.mark.timeout(180)
def test_a_good_driver_gets_every_point_on_gradescope(autograder: Path, rubric_file: Path) -> None:
    write_driver(autograder / 'submission', rubric_file)
    is_root = os.geteuid() == 0
    results = graded(autograder, in_container([]) if is_root else ())
    assert results['score'] == 40.0, results
    assert [test['status'] for test in results['tests']] == ['passed', 'passed']
    time, error = results['leaderboard']
    assert (time['name'], error['name']) == ('time', 'tracking error')
    assert 1.5 < time['value'] < 10.0
    assert 0.0 <= error['value'] < 0.1
    record = read_record(autograder / 'report' / 'drive' / FILE_NAME)
    assert Path(record.world).name == 'yard.xml'
    if is_root:
        assert 'in the sandbox "user"' in results['output']
        assert (autograder / 'report' / 'drive').stat().st_mode & 0o77 == 0


def test_a_submission_without_packages_is_told_so(autograder: Path) -> None:
    results = graded(autograder)
    assert results['score'] == 0
    assert 'no package in it' in results['output']


@pytest.mark.parametrize(
    ('settings', 'said'),
    [
        ({'HUSKY_LAB': '/nowhere'}, 'not your fault: please tell the course staff'),
        ({'HUSKY_WITHIN_SEC': '0.2'}, 'Grading took longer than 0.2 s'),
    ],
)
def test_a_grader_that_fails_says_so(
    autograder: Path, settings: Mapping[str, str], said: str
) -> None:
    results = graded(autograder, **settings)
    assert results['score'] == 0
    assert said in results['output']


def test_classroom_50_gets_its_result(tmp_path: Path) -> None:
    checkout, bundle = tmp_path / 'robotics-lab-2-octocat', tmp_path / 'bundle'
    bundle.mkdir()
    checkout.mkdir()
    shutil.copy(DOCS / 'classroom50' / 'autograder.py', bundle)
    (bundle / 'rubric.yaml').write_text(LOOKING)
    shutil.copytree(
        ROOT / 'src' / 'husky_driver' / 'template' / 'my_driver', checkout / 'src' / 'my_driver'
    )
    (checkout / 'result.json').symlink_to('somewhere_else')
    for module in ('husky_grader', 'json', 'pip'):
        (checkout / f'{module}.py').write_text("raise SystemExit('a module of the student')\n")
    site = 'https://github.com/robotics/robotics-lab-2-octocat'
    runner = {
        **{'CLASSROOM': 'robotics', 'ASSIGNMENT': 'lab-2', 'ASSIGNMENT_TYPE': 'individual'},
        **{'OWNER': 'octocat', 'SUBMISSION_TAG': 'submit/2026-11-22T20-00-00Z-a1b2c3d'},
        **{'COMMIT_URL': f'{site}/commit/a1b2c3d', 'RELEASE_URL': f'{site}/releases/tag/a'},
    }
    subprocess.run(
        [sys.executable, bundle / 'autograder.py'],
        cwd=checkout,
        env={**os.environ, **runner, 'HUSKY_LAB': str(ROOT)},
        check=True,
    )
    result = json.loads((checkout / 'result.json').read_text())
    check_classroom50(result)
    assert (result['score'], result['max-score']) == (10, 20)
    assert not (checkout / 'somewhere_else').exists()


def run_steps(
    workflow: Path, folder: Path, names: Sequence[str] = (), **settings: str
) -> dict[str, int]:
    """
    Run what a workflow's steps run, until one fails; return the exit status of each by name.

    :param names: of the only ones to run.
    """
    content = yaml.safe_load(workflow.read_text())
    given = {name: str(value) for name, value in content['env'].items()}
    summary = {'GITHUB_STEP_SUMMARY': str(folder / 'summary.md')}
    statuses = {}
    for step in content['jobs']['grade']['steps']:
        if 'run' in step and (not names or step['name'] in names):
            done = subprocess.run(
                ['bash', '--noprofile', '--norc', '-eo', 'pipefail', '-c', step['run']],
                cwd=folder,
                env={**os.environ, **given, **summary, **settings},
            )
            statuses[step['name']] = done.returncode
            if done.returncode:
                break
    return statuses


def test_the_workflow_is_one_that_github_takes() -> None:
    check = ['-m', 'check_jsonschema', '--builtin-schema', 'vendor.github-workflows']
    file = str(DOCS / 'workflows' / 'grade.yml')
    done = subprocess.run([sys.executable, *check, file], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_workflow_grades_and_holds_to_its_threshold(tmp_path: Path) -> None:
    (tmp_path / 'lab').symlink_to(ROOT)
    template = ROOT / 'src' / 'husky_driver' / 'template' / 'my_driver'
    shutil.copytree(template, tmp_path / 'submission' / 'src' / 'my_driver')
    (tmp_path / 'submission' / 'rubric.yaml').write_text(LOOKING)
    workflow, settings = DOCS / 'workflows' / 'grade.yml', {'RUBRIC': 'rubric.yaml'}
    statuses = run_steps(workflow, tmp_path, **settings, PASS_PERCENT='50')
    names = ('Set the lab up', 'Allow the jail', 'Grade', 'Hold to the threshold')
    assert statuses == dict.fromkeys(names, 0)
    last = run_steps(workflow, tmp_path, names[-1:], **settings, PASS_PERCENT='60')
    assert last == {'Hold to the threshold': 1}
    summary = (tmp_path / 'summary.md').read_text().splitlines()
    assert (summary[0], summary[-1]) == ('```text', '```')
    assert summary[-2].split() == ['total', '10.0', 'of', '20']
    assert (tmp_path / 'report' / 'lab.json').is_file()


def test_the_workflow_says_what_cannot_be_graded(tmp_path: Path) -> None:
    (tmp_path / 'lab').symlink_to(ROOT)
    (tmp_path / 'submission').mkdir()
    statuses = run_steps(DOCS / 'workflows' / 'grade.yml', tmp_path)
    assert statuses == {'Set the lab up': 0, 'Allow the jail': 0, 'Grade': 1}
    assert 'an empty folder' in (tmp_path / 'summary.md').read_text()
