# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What Moodle takes back: a filled grading worksheet, and a zip of feedback files."""

import csv
from dataclasses import replace
from html import unescape
from pathlib import Path
import zipfile

from husky_grader.graded import Graded
from husky_grader.outputs import Outputs, read_gradebook, write_outputs
from husky_grader.submission import find_submissions
from playpen_testing.graded_class import full, HOSTILE, hostile, partial, refused, submission
import pytest

# As Moodle 4 writes it: quotes where there is a space, dates as people read them.
WORKSHEET = """\
Identifier,"Full name","Email address",Status,Grade,"Maximum grade","Grade can be changed",\
"Last modified (submission)","Last modified (grade)","Feedback comments"
"Participant 5001","Ann de Groot",ann@example.org,"Submitted for grading - ",,10.00,Yes,\
"Monday, 5 October 2026, 10:07 AM",-,
"Participant 5002","Çem ""C"" Öz",cem@example.org,"Submitted for grading - Graded - ",4.50,10.00,\
Yes,"Monday, 5 October 2026, 9:58 AM","Tuesday, 6 October 2026, 8:00 AM","<p>Well done,
Çem</p>"
"Participant 5003","Dan Li",dan@example.org,"Submitted for grading - ",,10.00,No,\
"Monday, 5 October 2026, 11:00 AM",-,
"Participant 5004","Faye Mensah",faye@example.org,"No submission - ",,10.00,Yes,-,-,
"""
GERMAN = """\
\ufeffID;"Vollständiger Name";E-Mail-Adresse;Status;Bewertung;Bestwertung;\
"Bewertung kann geändert werden";"Zuletzt geändert (Abgabe)";"Zuletzt geändert (Bewertung)";\
"Feedback als Kommentar"\r
Teilnehmer/in5001;"Ann de Groot";;Abgegeben;;20,00;Ja;-;-;\r
Teilnehmer/in5002;"Çem Öz";;Abgegeben;;20,00;Nein;-;-;\r
"""
GROUPS = """\
Identifier,"Full name",Status,Group,Grade,"Maximum grade","Grade can be changed",\
"Last modified (grade)"
"Participant 31","Ann de Groot","Submitted for grading - ","Team_A (1)",,10.00,Yes,-
"Participant 32","Çem Öz","Submitted for grading - ","Team_A (1)",,10.00,Yes,-
"Participant 7","Dan Li","Submitted for grading - ","Team B",,10.00,Yes,-
"Participant 33","Faye Mensah","No submission - ","Default group",,10.00,Yes,-
"""


@pytest.fixture
def everyone() -> list[Graded]:
    """Return what three students of the worksheet got, and one who is not in it."""
    return [
        partial(submission(1, lms='moodle'), drive=30.0),
        full(submission(2, lms='moodle')),
        full(submission(3, lms='moodle')),
        full(submission(9, lms='moodle')),
    ]


def table(path: Path, delimiter: str = ',') -> list[list[str]]:
    with path.open(newline='', encoding='utf-8-sig') as stream:
        return list(csv.reader(stream, delimiter=delimiter))


def outputs(folder: Path, everyone: list[Graded], worksheet: str) -> Outputs:
    """Write everything for a worksheet, which itself must stay as it is."""
    path = folder / 'Grades-CSE461-Lab 3-101.csv'
    path.write_text(worksheet, encoding='utf-8', newline='')
    book = read_gradebook(path, [one.submission for one in everyone])
    found = write_outputs(folder, everyone, title='Lab', gradebook=book)
    assert path.read_bytes() == worksheet.encode()
    return found


def test_a_worksheet_gets_grades_and_is_else_as_it_was(
    tmp_path: Path, everyone: list[Graded]
) -> None:
    notes = outputs(tmp_path, everyone, WORKSHEET).notes
    before = list(csv.reader(WORKSHEET.splitlines(keepends=True)))
    after = table(tmp_path / 'grades_for_moodle.csv')
    grade, comments = before[0].index('Grade'), before[0].index('Feedback comments')
    assert [row[grade] for row in after[1:]] == ['9.00', '10.00', '', '']
    for row, old in zip(after, before, strict=True):
        assert row[:grade] + row[grade + 1 : comments] == old[:grade] + old[grade + 1 : comments]
    assert after[1][comments].startswith('<p>Graded by ./lab grade: 90 of 100</p><ul><li>')
    assert '<li>drive, 30 of 40: touched cone_5001 at' in after[1][comments]
    assert after[2][comments] == '<p>Well done,\nÇem</p>'
    assert after[4][comments] == ''
    table_notes = [note for note in notes if note.startswith('grades_for_moodle.csv: ')]
    assert [note.partition(': ')[2] for note in table_notes] == [
        'not in it (1): student 9',
        'has handed in nothing, so the line stays as it is (1): Faye Mensah (Participant 5004)',
        'locked in Moodle, so no grade is written (1): Dan Li (Participant 5003)',
        'had another grade (1): Çem "C" Öz (Participant 5002) 4.50 -> 10.00',
        'has a comment already, which stays (1): Çem "C" Öz (Participant 5002)',
    ]
    page = unescape((tmp_path / 'class.html').read_text())
    assert [note for note in notes if note not in page] == []
    again = write_outputs(tmp_path, everyone[1:], title='Lab')  # without the worksheet
    left = 'of an earlier call, and left as it was (1): grades_for_moodle.csv'
    assert left in again.notes
    assert left in (tmp_path / 'class.html').read_text()
    assert table(tmp_path / 'grades_for_moodle.csv') == after


def test_a_comment_of_the_grader_is_replaced_by_the_next(
    tmp_path: Path, everyone: list[Graded]
) -> None:
    outputs(tmp_path, everyone, WORKSHEET)
    again = (tmp_path / 'grades_for_moodle.csv').read_text(encoding='utf-8')
    outputs(tmp_path, [full(submission(1, lms='moodle'))], again)
    ann = table(tmp_path / 'grades_for_moodle.csv')[1]
    assert ann[4] == '10.00'
    assert ann[-1].startswith('<p>Graded by ./lab grade: 100 of 100</p>')
    assert ann[-1].count('<p>') == 1


def test_a_german_worksheet_keeps_commas_and_semicolons(
    tmp_path: Path, everyone: list[Graded]
) -> None:
    outputs(tmp_path, everyone, GERMAN)
    path = tmp_path / 'grades_for_moodle.csv'
    assert path.read_bytes().startswith(b'\xef\xbb\xbfID;')
    assert path.read_bytes().count(b'\r\n') == 3
    _, ann, cem = table(path, ';')
    assert (ann[0], ann[4]) == ('Teilnehmer/in5001', '18,00')
    assert (cem[0], cem[4]) == ('Teilnehmer/in5002', '')


def test_every_member_of_a_group_gets_its_grade(tmp_path: Path) -> None:
    # Team A has the number 7 in the export, which is that of Dan in the worksheet.
    team_a = replace(submission(1, 'Team A (1)', lms='moodle'), user='7')
    team_b = replace(submission(2, 'Team B', lms='moodle'), user='8')
    # Moodle 4.0 gives a copy to each, with the number of the participant.
    faye = replace(submission(3, 'Default group-Faye Mensah', lms='moodle'), user='33')
    everyone = [full(team_a), partial(team_b, build=0.0), full(faye)]
    notes = outputs(tmp_path, everyone, GROUPS).notes
    rows = table(tmp_path / 'grades_for_moodle.csv')[1:]
    assert [row[4] for row in rows] == ['10.00', '10.00', '8.00', '10.00']
    with zipfile.ZipFile(tmp_path / 'feedback_for_moodle.zip') as archive:
        folders = [name.partition('/')[0] for name in archive.namelist()]
    assert folders == [
        'Team A (1)_31_assignsubmission_file',
        'Team A (1)_32_assignsubmission_file',
        'Team B_7_assignsubmission_file',
        'Default group-Faye Mensah_33_assignsubmission_file',
    ]
    assert any('turn feedback comments on' in note for note in notes)


def test_what_two_groups_could_be_goes_to_neither(tmp_path: Path) -> None:
    names = ('Team B', 'Team-B', 'Team A (1)')
    everyone = [full(submission(k, name, lms='moodle')) for k, name in enumerate(names)]
    notes = outputs(tmp_path, everyone, GROUPS).notes
    rows = table(tmp_path / 'grades_for_moodle.csv')[1:]
    assert [row[4] for row in rows] == ['10.00', '10.00', '', '']
    assert any('claimed by several' in note and 'Dan Li' in note for note in notes)
    with zipfile.ZipFile(tmp_path / 'feedback_for_moodle.zip') as archive:
        assert [name.split('_')[1] for name in archive.namelist()] == ['31', '32']


def test_who_was_refused_gets_a_comment_and_no_grade(
    tmp_path: Path, everyone: list[Graded]
) -> None:
    everyone[0] = refused(everyone[0].submission)
    everyone[1] = replace(refused(everyone[1].submission), undone=True)  # killed, or no room
    notes = outputs(tmp_path, everyone, WORKSHEET).notes
    ann = table(tmp_path / 'grades_for_moodle.csv')[1]
    assert ann[4] == ''
    assert ann[-1] == ('<p>Graded by ./lab grade: refused</p><p>a RAR archive; hand in a zip</p>')
    assert any('refused, so no grade is written (1): Ann' in note for note in notes)
    assert any('not graded, so no grade is written (1): Çem' in note for note in notes)


def test_a_comment_holds_no_html_of_a_student(tmp_path: Path, everyone: list[Graded]) -> None:
    everyone[0] = hostile(everyone[0].submission)
    outputs(tmp_path, everyone, WORKSHEET)
    comment = table(tmp_path / 'grades_for_moodle.csv')[1][-1]
    assert '&lt;script&gt;' in comment
    # PHP takes a backslash before a quote for more than Python does: there is no quote in it.
    assert [char for char in '"\n\x1b\u202e' if char in comment] == []


@pytest.mark.parametrize(
    ('old', 'new', 'message'),
    [
        ('"Maximum grade"', '"Scale"', 'neither a grading worksheet of Moodle .* its columns: Id'),
        (
            '10.00,No',
            'good,No',
            "line 4 of the table: 'good' is no greatest grade; .* not a scale",
        ),
        ('"Participant 5003"', 'Dan', "line 4 of the table: 'Dan' names no participant"),
        (',No,', ',', 'line 4 of the table has 9 cells, its header has 10; download it again'),
        ('"Dan Li"', '"Dan" Li', 'no CSV in UTF-8'),
        ('Participant 500', 'Participant 77', 'nobody who has handed in is in it; .* from Moodle'),
    ],
)
def test_a_worksheet_that_is_none_is_refused_in_a_line(
    tmp_path: Path, everyone: list[Graded], old: str, new: str, message: str
) -> None:
    assert old in WORKSHEET
    path = tmp_path / 'work\x1bsheet.csv'
    path.write_text(WORKSHEET.replace(old, new), encoding='utf-8')
    with pytest.raises(ValueError, match=message) as caught:
        read_gradebook(path, [one.submission for one in everyone])
    assert '\n' not in str(caught.value)
    assert '\x1b' not in str(caught.value)


@pytest.mark.parametrize(
    ('name', 'content', 'message'),
    [
        ('a.csv', b'', 'neither a grading worksheet .* its columns: none'),
        ('a.xlsx', b'PK\x03\x04\xff\xfe', 'no CSV in UTF-8'),
        ('a.csv', b'a\x00b,"c', 'no CSV in UTF-8|neither'),
        ('grades_for_moodle.csv', WORKSHEET.encode(), 'written by the grader'),
    ],
)
def test_a_file_that_is_no_table_is_refused(
    tmp_path: Path, name: str, content: bytes, message: str
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=message):
        read_gradebook(tmp_path / name, [submission(1, lms='moodle')])
    with pytest.raises(ValueError, match='not a file; give the CSV file of the LMS'):
        read_gradebook(tmp_path, [])


def test_feedback_goes_where_the_export_came_from(tmp_path: Path) -> None:
    """Names are read as Moodle reads them: five parts, the second a participant."""
    export = tmp_path / 'CSE461-Lab 3-101.zip'
    with zipfile.ZipFile(export, 'w') as archive:
        for folder in ('Ann de Groot_5001', 'Çem Öz_5002', 'Default group'):
            archive.writestr(f'{folder}_assignsubmission_file/ws/src/p/package.xml', '<package/>')
    found = find_submissions([str(export)])
    report = tmp_path / 'report'
    ann = report / 'Ann de Groot_5001' / 'drive'
    ann.mkdir(parents=True)
    (ann / 'report.html').write_text('how it drove')
    result = write_outputs(report, [full(one) for one in found], title='Lab')
    with zipfile.ZipFile(report / 'feedback_for_moodle.zip') as archive:
        files = {name: archive.read(name).decode() for name in archive.namelist()}
    parts = [name.split('_', 4) for name in files]
    assert {(part[1], part[2], part[3].partition('/')[0]) for part in parts} == {
        ('5001', 'assignsubmission', 'file'),
        ('5002', 'assignsubmission', 'file'),
    }
    assert files['Ann de Groot_5001_assignsubmission_file/drive_drive.html'] == 'how it drove'
    page = files['Ann de Groot_5001_assignsubmission_file/feedback.html']
    assert 'href="drive_drive.html"' in page
    assert 'Ann de Groot' in page
    assert (
        'feedback_for_moodle.zip, for want of a participant (1): Default group'
        in (result.notes[0])
    )
    assert 'where groups hand in, give the grading worksheet' in result.notes[1]


def test_a_name_does_not_send_feedback_to_somebody_else(tmp_path: Path) -> None:
    one = submission(1, f'x_5002_assignsubmission_file/../{HOSTILE}', lms='moodle')
    write_outputs(tmp_path, [full(one)], title='Lab')
    with zipfile.ZipFile(tmp_path / 'feedback_for_moodle.zip') as archive:
        (name,) = archive.namelist()
    assert name.count('/') == 1
    assert name.split('_')[1:] == ['5001', 'assignsubmission', 'file/feedback.html']
