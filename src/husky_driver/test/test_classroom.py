# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import csv
import os
from pathlib import Path
import signal
import subprocess
import sys

from husky_driver.classroom import Classroom, names_of
from husky_driver.grade import main as grade
from husky_driver.grading import Graded
import pytest

SHORT = 'speed: 0.8\nwaypoints: [[0, 0], [-1, 0]]\n'


@pytest.fixture
def files(tmp_path: Path) -> list[str]:
    """Return three students' files of one name: good, broken, and through the barrier."""
    texts = {
        'ann': SHORT,
        'bob': 'speed: fast\nloop: yes\n',
        'cem': 'waypoints: [[0, 0], [3, 0]]\n',
    }
    for name, text in texts.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / 'path.yaml').write_text(text)
    return [str(tmp_path / name / 'path.yaml') for name in texts]


def test_a_broken_file_does_not_stop_the_others(
    files: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert grade([*files, '--report', str(tmp_path / 'report')]) == 1
    with (tmp_path / 'report' / 'grades.csv').open(newline='') as stream:
        rows = list(csv.DictReader(stream))
    assert [row['file'] for row in rows] == files
    assert [row['passed'] for row in rows] == ['True', 'False', 'False']
    assert float(rows[0]['score']) == 100.0
    assert 'waypoints: missing' in rows[1]['reasons']
    assert 'touched jersey_barrier_15' in rows[2]['reasons']
    assert (tmp_path / 'report' / 'ann_path' / 'report.html').is_file()
    table = capsys.readouterr().out.splitlines()
    assert table[0] == 'ann_path  100.0  passed'
    assert table[1].startswith('bob_path    0.0  refused     line 1, column 1: waypoints: missing')
    assert table[1].endswith('(and 2 more)')
    assert table[2].startswith('cem_path')


def test_what_was_graded_is_not_graded_again_until_it_changes(
    files: list[str], tmp_path: Path
) -> None:
    room = Classroom(files[:1], tmp_path / 'report')
    (first,) = room.grade()
    report = tmp_path / 'report' / 'path' / 'report.json'
    written = report.stat().st_mtime_ns
    (second,) = Classroom(files[:1], tmp_path / 'report').grade()
    assert second.report == first.report
    assert report.stat().st_mtime_ns == written
    Path(files[0]).write_text(SHORT.replace('-1', '-1.5'))
    (third,) = Classroom(files[:1], tmp_path / 'report').grade()
    assert third.report is not None
    assert third.report['path_length_m'] == pytest.approx(1.5)


def test_what_is_no_file_at_all_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / 'pipe.yaml')  # whoever opens it waits for ever
    (tmp_path / 'zero.yaml').symlink_to('/dev/zero')  # whoever reads it never ends
    files = [str(tmp_path / name) for name in ('pipe.yaml', 'zero.yaml', 'none.yaml')]
    results = Classroom(files, tmp_path / 'report', jobs=1).grade()
    assert all('line 1, column 1: not a file' in graded.refused for graded in results[:2])
    assert 'no such file' in results[2].refused


def test_a_class_that_is_interrupted_goes_on_where_it_was(tmp_path: Path) -> None:
    files = [tmp_path / f'student_{number}.yaml' for number in range(4)]
    for number, file in enumerate(files):
        file.write_text(SHORT.replace('-1', f'-{number + 1}'))
    command = [sys.executable, '-m', 'husky_driver.grade', *map(str, files), '--jobs', '1']
    command += ['--report', str(tmp_path / 'report')]
    environment = {**os.environ, 'PYTHONPATH': ':'.join(sys.path)}
    with subprocess.Popen(
        command, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as running:
        assert running.stderr is not None
        assert running.stderr.readline() == '1 of 4  student_0 100.0\n'
        os.killpg(running.pid, signal.SIGINT)
        said = running.stderr.read()
        assert running.wait(timeout=10.0) == 130
    assert 'interrupted; the same command goes on where it was' in said
    assert 'Traceback' not in said
    assert not (tmp_path / 'report' / 'grades.csv').exists()
    first = tmp_path / 'report' / 'student_0' / 'report.json'
    written = first.stat().st_mtime_ns
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert [line.split()[:2] for line in done.stdout.splitlines()[:4]] == [
        [f'student_{number}', '100.0'] for number in range(4)
    ]
    assert first.stat().st_mtime_ns == written, 'it was graded twice'


def test_a_file_that_takes_too_long_costs_only_itself(files: list[str], tmp_path: Path) -> None:
    seen: list[tuple[int, Graded]] = []
    room = Classroom(
        [files[2], files[0]],
        tmp_path,
        jobs=1,
        timeout_sec=0.0,
        done=lambda number, graded: seen.append((number, graded)),
    )
    results = room.grade()
    assert [graded.refused for graded in results] == ['took longer than 0 s'] * 2
    assert len(seen) == 2


def test_files_of_one_name_are_told_apart_by_their_folders() -> None:
    assert names_of(['a.yaml', 'b.yaml']) == ['a', 'b']
    assert names_of(['ann/p.yaml', 'bob/p.yaml']) == ['ann_p', 'bob_p']
    assert names_of(['x/ann/w/p.yaml', 'x/bob/w/p.yaml']) == ['ann_w_p', 'bob_w_p']
