# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The grades of a class as JSON, in the shape that config/grades.schema.json describes."""

from collections.abc import Sequence
import json
from pathlib import Path

from husky_course.files import replacing

from husky_grader.graded import Graded


def write_grades_json(path: Path, everyone: Sequence[Graded], *, title: str) -> None:
    """
    Write the file, whole or not at all.

    :raises OSError: when it cannot be written.
    """
    content = {'title': title, 'submissions': [one.entry() for one in everyone]}
    with replacing(path) as part:
        part.write_text(json.dumps(content, indent=2) + '\n', encoding='utf-8')
