# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What Canvas takes back: a filled gradebook, and a zip of feedback files."""

from collections.abc import Sequence
import csv
from dataclasses import replace
import io
from pathlib import Path
import tarfile
import zipfile

from husky_grader.graded import Graded
from husky_grader.outputs import Outputs, read_gradebook, write_outputs
from husky_grader.submission import find_submissions
from playpen_testing.graded_class import full, partial, refused, submission
import pytest

# As Canvas writes it: a row on posting, one on points, totals that it computes itself.
GRADEBOOK = '''\
Student,ID,SIS User ID,SIS Login ID,Section,Notes,Lab 2 (700),Lab 3 (701),\
Assignments Current Points,Current Score (2026),Final Grade
,,,,,,,Manual Posting,,,
    Points Possible,,,,,,5.00,20.00,(read only),(read only),(read only)
"de Groot, Ann",5001,s1,ann@example.org,CSE461-07,shy,4.50,,9.50,90.00,A
"=""=1+1""",5002,s2,cem@example.org,CSE461-07,,5.00,12.50,17.50,80.00,B
"Li, Dan",5003,s3,dan@example.org,CSE461-08,,,EX,0.00,,
"Student, Test",5004,,test,CSE461-07,,,N/A,0.00,,
'''


def outputs(
    folder: Path, everyone: Sequence[Graded], gradebook: str, *, title: str = 'Lab 3'
) -> Outputs:
    """Write everything for a gradebook, which itself must stay as it is."""
    path = folder / '2026-11-22T1200_Grades-CSE461.csv'
    path.write_text(gradebook, encoding='utf-8', newline='')
    book = read_gradebook(path, [one.submission for one in everyone], title=title)
    found = write_outputs(folder, everyone, title='Lab', gradebook=book)
    assert path.read_bytes() == gradebook.encode()
    return found


def table(path: Path, delimiter: str = ',') -> list[list[str]]:
    with path.open(newline='', encoding='utf-8') as stream:
        return list(csv.reader(stream, delimiter=delimiter))


@pytest.fixture
def everyone() -> list[Graded]:
    """Return what three students of the gradebook got, and one who is not in it."""
    students = [submission(number, lms='canvas') for number in (1, 2, 3, 9)]
    return [partial(students[0], drive=25.0), *map(full, students[1:])]


def test_a_gradebook_gets_scores_in_the_column_of_the_lab(
    tmp_path: Path, everyone: list[Graded]
) -> None:
    notes = outputs(tmp_path, everyone, GRADEBOOK).notes
    assert table(tmp_path / 'grades_for_canvas.csv') == [
        ['Student', 'ID', 'SIS User ID', 'SIS Login ID', 'Section', 'Lab 3 (701)'],
        ['', '', '', '', '', 'Manual Posting'],
        ['    Points Possible', '', '', '', '', '20.00'],
        ['de Groot, Ann', '5001', 's1', 'ann@example.org', 'CSE461-07', '17.00'],
        ['="=1+1"', '5002', 's2', 'cem@example.org', 'CSE461-07', '20.00'],
        ['Li, Dan', '5003', 's3', 'dan@example.org', 'CSE461-08', 'EX'],
        ['Student, Test', '5004', '', 'test', 'CSE461-07', 'N/A'],
    ]
    assert notes == [
        'grades_for_canvas.csv: not in it (1): student 9',
        'grades_for_canvas.csv: has handed in nothing, so the line stays as it is (1): '
        'Student, Test',
        'grades_for_canvas.csv: excused or without the assignment, so no score is written (1): '
        'Li, Dan EX',
        'grades_for_canvas.csv: had another score (1): ="=1+1" 12.50 -> 20.00',
    ]


def test_who_was_refused_gets_no_score(tmp_path: Path, everyone: list[Graded]) -> None:
    everyone[0] = replace(refused(everyone[0].submission), undone=True)  # killed, or no room
    everyone[1] = refused(everyone[1].submission)
    notes = outputs(tmp_path, everyone, GRADEBOOK).notes
    assert table(tmp_path / 'grades_for_canvas.csv')[4][-1] == '12.50'
    assert 'grades_for_canvas.csv: refused, so no score is written (1): ="=1+1"' in notes
    assert 'grades_for_canvas.csv: not graded, so no score is written (1): de Groot, Ann' in notes


def test_a_gradebook_with_semicolons_and_names_in_two_columns(
    tmp_path: Path, everyone: list[Graded]
) -> None:
    text = (
        'LastName;FirstName;ID;SIS Login ID;Section;Lab 3 (701)\r\n'
        '    Points Possible;;;;;8,00\r\n'
        'de Groot;Ann;5001;ann;CSE461;\r\n'
    )
    outputs(tmp_path, everyone, text, title='')  # there is one column only
    assert table(tmp_path / 'grades_for_canvas.csv', ';')[-1][-1] == '6,80'
    assert (tmp_path / 'grades_for_canvas.csv').read_bytes().count(b'\r\n') == 3


@pytest.mark.parametrize(
    ('old', 'new', 'title', 'message'),
    [
        ('', '', 'Lab 9', "'Lab 9' or the only one; it has: Lab 2 .700., Lab 3 .701.; delete"),
        (' (70', ' 70', 'Lab 3', 'or the only one; it has: none'),
        ('Points Possible', 'Points', 'Lab 3', 'it has no row Points Possible'),
        (',20.00,(', ',,(', 'Lab 3', "Lab 3 .701. has '' points possible; .* above 0 in Canvas"),
        ('Section', 'Group', 'Lab 3', 'nor a gradebook of Canvas .* its columns: Student, ID'),
        (',500', ',77', 'Lab 3', 'nobody who has handed in is in it; .* from Canvas'),
    ],
)
def test_a_gradebook_that_is_not_clear_is_refused_in_a_line(
    tmp_path: Path, everyone: list[Graded], old: str, new: str, title: str, message: str
) -> None:
    assert old in GRADEBOOK
    with pytest.raises(ValueError, match=message) as caught:
        outputs(tmp_path, everyone, GRADEBOOK.replace(old, new), title=title)
    assert '\n' not in str(caught.value)
    assert not (tmp_path / 'grades_for_canvas.csv').exists()


def test_numbers_of_another_lms_are_not_those_of_canvas(tmp_path: Path) -> None:
    gradescope = [full(submission(1, lms='gradescope'))]
    with pytest.raises(ValueError, match='nobody who has handed in is in it'):
        outputs(tmp_path, gradescope, GRADEBOOK)


def archive_of(names: dict[str, bytes], *, tar: bool = False) -> bytes:
    stream = io.BytesIO()
    if tar:
        with tarfile.open(fileobj=stream, mode='w:gz') as archive:
            for name, content in names.items():
                entry = tarfile.TarInfo(name)
                entry.size = len(content)
                archive.addfile(entry, io.BytesIO(content))
    else:
        with zipfile.ZipFile(stream, 'w') as zipped:
            for name, content in names.items():
                zipped.writestr(name, content)
    return stream.getvalue()


def user_and_file(name: str) -> tuple[str, str]:
    """Return what Canvas reads out of the name of a file that is uploaded."""
    words = [word for word in name.split('_') if word != 'LATE']
    if words[0] == 'anon':
        return words[1], words[2]
    user, file = [word for word in words if word.isdecimal()][:2]
    return user, file


def test_feedback_has_the_kind_and_numbers_of_what_was_handed_in(tmp_path: Path) -> None:
    """Canvas shows it under the name of what was handed in: a zip must be one."""
    workspace = {'src/p/package.xml': b'<package/>'}
    handed = {
        'degrootann_5001_90001_CSE461_07_03.zip': archive_of(workspace),
        'özcem_LATE_5002_90002_my_ws.tar.gz': archive_of(workspace, tar=True),
        'lidan_5003_90003_report.pdf': b'%PDF-1.4',
        'lidan_5003_90005_ws-1.zip': archive_of(workspace),
        'anon_aB3dE_90006_ws.zip': archive_of(workspace),
        'mensahfaye_5004_90007_path.yaml': b'waypoints: [[0, 0], [1, 0]]\n',
        'tosam_5005_text.html': b'<p>hello</p>',
    }
    export = tmp_path / 'submissions.zip'
    export.write_bytes(archive_of(handed))
    everyone = [full(one) for one in find_submissions([str(export)])]
    report = tmp_path / 'report'
    notes = write_outputs(report, everyone, title='Lab').notes
    with zipfile.ZipFile(report / 'feedback_for_canvas.zip') as archive:
        files = {user_and_file(name): archive.read(name) for name in archive.namelist()}
        assert set(archive.namelist()) <= set(handed)
    assert set(files) == {
        ('5001', '90001'),
        ('5002', '90002'),
        ('5003', '90005'),
        ('5004', '90007'),
        ('aB3dE', '90006'),
    }
    for whose in (('5001', '90001'), ('5003', '90005'), ('aB3dE', '90006')):
        with zipfile.ZipFile(io.BytesIO(files[whose])) as zipped:
            assert zipped.namelist() == ['feedback.html']
    with tarfile.open(fileobj=io.BytesIO(files['5002', '90002']), mode='r:gz') as tar:
        assert tar.getnames() == ['feedback.html']
    text = files['5004', '90007'].decode()
    assert text.startswith('100 of 100\npackage topic_demo, 10 of 10: ')
    assert notes == [
        'not in feedback_for_canvas.zip, for want of a file that was handed in (1): tosam_5005'
    ]


def test_the_same_class_gives_the_same_archive(tmp_path: Path, everyone: list[Graded]) -> None:
    tar = replace(submission(7, lms='canvas'), kind='tar')
    archives = []
    for name in ('one', 'other'):
        write_outputs(tmp_path / name, [*everyone, full(tar)], title='Lab')
        archives.append((tmp_path / name / 'feedback_for_canvas.zip').read_bytes())
    assert archives[0] == archives[1]


def test_a_name_that_is_no_text_costs_nobody_the_feedback(tmp_path: Path) -> None:
    files = (('student_5001_9001_\udcff.zip', '\udcff.zip'),)
    one = replace(submission(1, 'Ann \udcff', lms='canvas'), files=files)
    write_outputs(tmp_path, [full(one)], title='Lab')
    with zipfile.ZipFile(tmp_path / 'feedback_for_canvas.zip') as archive:
        assert archive.namelist() == ['student_5001_9001_?.zip']
    assert r'Ann \xff' in (tmp_path / one.id / 'index.html').read_text()


def test_a_folder_in_the_place_of_a_file_costs_nobody_the_outputs(tmp_path: Path) -> None:
    (tmp_path / 'export' / 'deann_5001_90001_lab' / 'src').mkdir(parents=True)
    (tmp_path / 'export' / 'tosam_5005_90002_lab.zip').write_bytes(b'PK\x05\x06' + bytes(18))
    submissions = find_submissions([str(tmp_path / 'export')])
    assert [(each.lms, each.kind) for each in submissions] == [
        ('canvas', 'folder'),
        ('canvas', 'zip'),
    ]
    written = write_outputs(tmp_path / 'class', list(map(full, submissions)), title='Lab')
    assert (tmp_path / 'class' / 'class.html').is_file()
    assert written.notes == [
        'not in feedback_for_canvas.zip, for want of a file that was handed in (1): deann_5001'
    ]
    with zipfile.ZipFile(tmp_path / 'class' / 'feedback_for_canvas.zip') as archive:
        assert archive.namelist() == ['tosam_5005_90002_lab.zip']
