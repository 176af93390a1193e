# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A class that hands in waypoint files, graded by a rubric for such files."""

import json
from pathlib import Path
import shutil

from husky_grader.grade import main as grade
from husky_grader.playpen import config_folder, default_course
from husky_grader.rubric.rubric_file import load_rubric, parse_rubric
from husky_sim.world import default_worlds
import pytest

RUBRIC = config_folder() / 'rubrics' / 'path.yaml'
STEP = '{kind: path, points: 100, passes: [{x: 1, y: 0}, {x: 0, y: 0}], within: 0.2}'
ONE = ['--jobs', '1']  # a worker takes longer to start than these files
THERE_AND_BACK = f'title: There and back\nsteps:\n  - {STEP}\n'


@pytest.fixture(autouse=True)
def state(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the grader's secret away from the user's own; and there is no sandbox at all."""
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path_factory.mktemp('state')))
    monkeypatch.setenv('PATH', '')


def test_a_class_of_waypoint_files_is_graded_without_a_sandbox(tmp_path: Path) -> None:
    handed_in, report = tmp_path / 'handed_in', tmp_path / 'report'
    handed_in.mkdir()
    shutil.copyfile(default_course(), handed_in / 'ann.yaml')
    (handed_in / 'bob.yaml').write_text('waypoints: [[0, 0], [-1, 0]]\n')
    (handed_in / 'cem.yaml').write_text('speed: fast\n')
    (handed_in / 'dan' / 'src' / 'p').mkdir(parents=True)
    (handed_in / 'dan' / 'src' / 'p' / 'package.xml').write_text('<package/>')
    command = ['--lab', str(handed_in), '--rubric', str(RUBRIC), *ONE, '--report', str(report)]
    assert grade(command) == 1
    ann, bob, cem, dan = json.loads((report / 'grades.json').read_text())['submissions']
    assert (ann['points'], ann['refused']) == (100.0, None)
    assert bob['points'] == pytest.approx(40.0)
    assert bob['steps'][0]['why'].startswith(
        'the path leaves out (4.1, -3.2): it comes no nearer than 5.20 m, allowed are 1 m'
    )
    assert (cem['points'], cem['refused']) == (0.0, None)
    assert cem['steps'][0]['why'].startswith('line 1, column 1: waypoints: missing')
    assert dan['refused'].endswith(
        "a workspace; the rubric 'A path around the central barrier' asks for a waypoint file"
    )
    assert (report / 'ann' / 'path' / 'report.html').is_file()


def test_one_that_is_interrupted_is_not_said_to_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr('husky_grader.lab_grading.grade_submission', interrupted)
    command = ['--lab', str(default_course()), '--rubric', str(RUBRIC)]
    assert grade([*command, '--report', str(tmp_path / 'report')]) == 130
    assert capsys.readouterr().err == '\ninterrupted\n'  # the same command begins anew


def test_nothing_of_an_older_submission_is_shown(tmp_path: Path) -> None:
    handed_in, report = tmp_path / 'ann', tmp_path / 'report'
    file = handed_in / 'ann.yaml'
    command = ['--lab', str(handed_in), '--rubric', str(RUBRIC), '--report', str(report)]
    handed_in.mkdir()
    shutil.copyfile(default_course(), file)
    assert grade(command) == 0
    assert 'path/report.html' in (report / 'index.html').read_text()
    shutil.copytree(report / 'path', report / 'staff' / 'path_2')  # as of a hidden course
    (report / 'path_like').mkdir()
    shutil.copyfile(report / 'path' / 'report.html', report / 'path_like' / 'report.html')
    file.write_text('speed: fast\n')
    assert grade(command) == 1
    assert 'report.html' not in (report / 'index.html').read_text()
    kept = sorted(path.parent.name for path in report.rglob('report.html'))
    assert kept == ['path_like']  # which is somebody else's
    file = file.rename(handed_in / 'second try.yaml')
    assert grade(command) == 1
    assert [copy.name for copy in (report / 'handed_in').glob('*.yaml')] == [file.name]
    file.write_bytes(b'Rar!')
    file.rename(handed_in / 'third try.rar')
    assert grade(command) == 2
    assert '100.0' not in (report / 'index.html').read_text()
    assert 'refused' in (report / 'index.html').read_text()
    assert not (report / 'lab.json').exists()
    assert list((report / 'handed_in').glob('*.*')) == []


@pytest.mark.parametrize(
    ('course', 'points'),
    [
        ('waypoints: [[0, 0], [1, 0], [0, 0]]', 100.0),
        ('waypoints: [[0, 0], [1, 0]]', 0.0),  # not back again
    ],
)
def test_points_count_in_their_order(tmp_path: Path, course: str, points: float) -> None:
    (tmp_path / 'rubric.yaml').write_text(THERE_AND_BACK)
    (tmp_path / 'handed_in.yaml').write_text(course)
    report = tmp_path / 'report'
    command = ['--lab', str(tmp_path / 'handed_in.yaml'), '--report', str(report)]
    grade([*command, '--rubric', str(tmp_path / 'rubric.yaml')])
    assert json.loads((report / 'lab.json').read_text())['score'] == pytest.approx(points)


def test_what_a_drive_did_is_told_once(tmp_path: Path) -> None:
    (course := tmp_path / 'ann.yaml').write_text('waypoints: [[0, 0], [6, 0]]')
    command = ['--lab', str(course), '--rubric', str(RUBRIC)]
    assert grade([*command, '--report', str(tmp_path / 'report')]) == 1
    why = json.loads((tmp_path / 'report' / 'lab.json').read_text())['steps'][0]['why']
    assert why.startswith('1 collision, 0 are allowed; the path leaves out (4.1, -3.2): ')
    assert why.count('touched jersey_barrier_15') == 1, why


def test_a_path_almost_near_enough_is_told_by_how_much(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (rubric := tmp_path / 'rubric.yaml').write_text(THERE_AND_BACK.replace('y: 0}', 'y: 0.203}'))
    (course := tmp_path / 'ann.yaml').write_text('waypoints: [[0, 0], [1, 0], [0, 0]]')
    command = ['--lab', str(course), '--rubric', str(rubric)]
    grade([*command, '--report', str(tmp_path / 'report')])
    told = 'the path leaves out (1, 0.203): it comes no nearer than 0.203 m, allowed are 0.2 m'
    assert told in capsys.readouterr().out


def test_a_path_is_driven_in_the_world_of_the_rubric(tmp_path: Path) -> None:
    world = shutil.copyfile(default_worlds() / 'empty.xml', tmp_path / 'yard.xml')
    rubric, report = tmp_path / 'rubric.yaml', tmp_path / 'report'
    rubric.write_text(f'world: yard.xml\n{THERE_AND_BACK}'.replace('x: 1', 'x: 4'))
    (tmp_path / 'ann.yaml').write_text('waypoints: [[0, 0], [4, 0], [0, 0]]')
    command = ['--lab', str(tmp_path / 'ann.yaml'), '--rubric', str(rubric)]
    command += ['--report', str(report), '--shard', '1/1']
    assert grade(command) == 0  # in the playpen there is a barrier
    block = '<body name="shed" pos="2 0 0.5"><geom type="box" size="0.3 0.3 0.5"/></body>'
    world.write_text(world.read_text().replace('</worldbody>', f'{block}</worldbody>'))
    assert grade(command) == 1  # nothing of the former world is kept
    (ann,) = json.loads((report / 'grades.json').read_text())['submissions']
    assert 'touched shed' in ann['steps'][0]['why']


def test_a_rubric_is_for_files_or_for_workspaces() -> None:
    assert load_rubric(RUBRIC).is_of_files
    with pytest.raises(ValueError, match=r'steps\[0\]: it is for a waypoint file; a rubric has'):
        parse_rubric(f'title: Both\nsteps:\n  - {STEP}\n  - {{kind: build, points: 1}}\n')


def test_no_copy_takes_the_place_of_what_was_handed_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    handed_in = tmp_path / 'handed_in'
    handed_in.mkdir()
    monkeypatch.chdir(tmp_path)
    for file in (handed_in / 'ann.yaml', tmp_path / 'bob.yaml'):
        shutil.copyfile(default_course(), file)
        assert grade(['--lab', str(file), '--rubric', str(RUBRIC), '--report', '.']) == 2
        told = f'--report .: there the report on {file.stem} would lie in what was handed in; '
        assert capsys.readouterr().err == f'{told}name another folder\n'
    assert list(handed_in.iterdir()) == [handed_in / 'ann.yaml']


def test_a_report_among_what_was_handed_in_is_none_of_it(
    tmp_path: Path,
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    rubric = tmp_path_factory.mktemp('rubric') / 'rubric.yaml'
    rubric.write_text(THERE_AND_BACK)
    for name in ('ann', 'bob'):
        (tmp_path / f'{name}.yaml').write_text('waypoints: [[0, 0], [1, 0], [0, 0]]')
    monkeypatch.chdir(tmp_path)
    for _ in range(2):
        assert grade(['--lab', '.', '--rubric', str(rubric), *ONE]) == 0
    entries = json.loads((tmp_path / 'report' / 'grades.json').read_text())['submissions']
    assert [each['id'] for each in entries] == ['ann', 'bob']
    (tmp_path / 'cem').mkdir()
    (tmp_path / 'dan').symlink_to('dan')
    capsys.readouterr()
    assert grade(['--lab', '.', '--rubric', str(rubric), '--report', '.']) == 2
    told = '--report .: there the report on cem would lie in what was handed in; name another'
    assert capsys.readouterr().err == f'{told} folder\n'


@pytest.mark.parametrize(
    ('names', 'expected'),
    [
        (['deann_5101_90001_lab.yaml', 'ecem_5102_90002_lab.yaml'], ['deann_5101', 'ecem_5102']),
        (['one/package.xml', 'two/package.xml'], ['class']),
    ],
)
def test_who_has_handed_in_is_found_again_beside_the_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: list[str], expected: list[str]
) -> None:
    rubric, place = tmp_path / 'rubric.yaml', tmp_path / 'class'
    rubric.write_text(THERE_AND_BACK)
    for name in names:
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_text('waypoints: [[0, 0], [1, 0], [0, 0]]')
    monkeypatch.chdir(place)
    for _ in range(2):
        grade(['--lab', '.', '--rubric', str(rubric), *ONE, '--shard', '1/1'])
        entries = json.loads((place / 'report' / 'grades.json').read_text())['submissions']
        assert [each['id'] for each in entries] == expected


def test_what_a_later_call_finds_elsewhere_has_no_old_notes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / 'rubric.yaml').write_text(THERE_AND_BACK)
    for export in ('monday', 'friday'):
        for number in (101, 102):
            folder = tmp_path / export / f'Ann {number}_{number}_assignsubmission_file'
            folder.mkdir(parents=True)
            (folder / 'p.yaml').write_text('waypoints: [[0, 0], [1, 0], [0, 0]]')
    monkeypatch.chdir(tmp_path)
    command = ['--rubric', 'rubric.yaml', *ONE, '--report', 'report', '--lab']
    assert grade([*command, 'monday', 'friday']) == 0
    assert 'replaces' in (tmp_path / 'report' / 'class.html').read_text()
    for exports, places in (
        ([str(tmp_path / 'monday'), 'friday'], [str(tmp_path / 'monday')]),
        (['friday'], []),
    ):
        assert grade([*command, *exports]) == 0
        entries = json.loads((tmp_path / 'report' / 'grades.json').read_text())['submissions']
        for entry in entries:
            name = f'{entry["name"]}_{entry["id"][-3:]}_assignsubmission_file'
            lines = [f'replaces one that was given before it: {each}/{name}' for each in places]
            assert entry['notes'] == lines
            page = (tmp_path / 'report' / entry['id'] / 'index.html').read_text()
            assert 'replaces' not in page  # a student sees no place of this machine
    for export in ('monday', 'friday'):
        shutil.rmtree(tmp_path / export / name)
    capsys.readouterr()
    assert grade([*command, 'monday', 'friday']) == 0
    told = capsys.readouterr().err
    assert 'Ann 101_101: replaces one that was given before it: monday/' in told
    left = 'of an earlier call, and left as it was (4): class.html, grades.csv, grades.json, feed'
    assert f'report: {left}' in told  # which have both
