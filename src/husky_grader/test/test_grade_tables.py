# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The grades of a class as CSV and as JSON."""

import csv
import json
from pathlib import Path
from typing import Any

from husky_grader.graded import StepGrade
from husky_grader.lab.lab import table
from husky_grader.outputs import OUTPUT_FILES, write_outputs
from husky_grader.submission import find_submissions
import jsonschema
from playpen_testing.graded_class import a_class, full, HOSTILE, partial, refused, submission
import pytest

CONFIG = Path(__file__).resolve().parents[3] / 'config'


@pytest.fixture
def schema() -> Any:
    text = (CONFIG / 'grades.schema.json').read_text()
    return jsonschema.Draft202012Validator(json.loads(text))


@pytest.mark.parametrize('size', [0, 60])
def test_grades_json_has_the_shape_of_its_schema(tmp_path: Path, schema: Any, size: int) -> None:
    everyone = a_class(size)
    write_outputs(tmp_path, everyone, title='Lab')
    schema.check_schema(schema.schema)
    content = json.loads((tmp_path / 'grades.json').read_text())
    assert list(schema.iter_errors(content)) == []
    assert content['title'] == 'Lab'
    assert content['submissions'] == [one.entry() for one in everyone]


def test_the_schema_refuses_what_it_does_not_describe(tmp_path: Path, schema: Any) -> None:
    write_outputs(tmp_path, [full(submission(1))], title='Lab')
    text = (tmp_path / 'grades.json').read_text()
    for old, new in (('"points"', '"score"'), ('"most": 10.0', '"most": "10"')):
        assert list(schema.iter_errors(json.loads(text.replace(old, new))))


def test_grades_csv_has_a_column_for_each_step(tmp_path: Path) -> None:
    everyone = [
        partial(submission(1, late=True), drive=36.0, publisher=0.0),
        refused(submission(2)),
        full(submission(3, HOSTILE)),
    ]
    write_outputs(tmp_path, everyone, title='Lab')
    with (tmp_path / 'grades.csv').open(newline='', encoding='utf-8') as stream:
        ann, bob, cem = csv.DictReader(stream)
    steps = ['package topic_demo (of 10)', 'build (of 20)', 'publisher (of 30)', 'drive (of 40)']
    assert list(ann) == [
        *('id', 'name', 'user', 'emails', 'late', 'points', 'most', 'refused'),
        *steps,
        'why',
    ]
    assert [ann[step] for step in steps] == ['10.0', '20.0', '0.0', '36.0']
    assert (ann['points'], ann['late'], ann['user']) == ('66.0', 'late', '5001')
    assert ann['why'].startswith('publisher: it hears nothing of /odometry/filtered')
    assert 'drive: touched cone_5001' in ann['why']
    assert bob['refused'] == '/exports/folder.zip: a RAR archive; hand in a zip'
    assert [bob[step] for step in steps] == [''] * 4
    assert cem['name'].startswith("'=HYPERLINK")
    assert "\\x1b[2J;'=1+1" in cem['name']


def test_no_submission_takes_the_place_of_what_is_written(tmp_path: Path) -> None:
    for name in ('ann', *OUTPUT_FILES):
        (tmp_path / f'{name.upper()}.zip').touch()
    found = find_submissions([str(tmp_path)], taken=OUTPUT_FILES)
    ids = [one.id.casefold() for one in found]
    assert 'ann' in ids
    assert set(ids) & set(OUTPUT_FILES) == set()


def test_the_table_of_one_tells_halves_of_points() -> None:
    steps = [StepGrade('build', 2.5, 2.5, 'built'), StepGrade('drive', 10.0, 5.0, 'half')]
    assert table(steps).splitlines() == [
        'build   2.5 of  2.5  built',
        'drive   5.0 of   10  half',
        'total   7.5 of 12.5',
    ]
