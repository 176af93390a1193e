# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The zip that Gradescope makes an autograder of: this lab, a rubric and two scripts."""

from collections.abc import Iterator
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from husky_course.files import replacing

from husky_grader.autograder.packed_lab import LAB, packed_lab
from husky_grader.autograder.packed_rubric import packed_rubric
from husky_grader.rubric.steps import Rubric

SCRIPTS = ('setup.sh', 'run_autograder')
LAB_FILE = 'lab.tar.gz'
RUBRIC_FOLDER = 'rubric'
RUBRIC_NAME_FILE = 'rubric.txt'  # holds the path of the rubric in its folder
_PLACE = Path(__file__).with_name('gradescope_scripts')
_EXECUTABLE = 0o755


def make_gradescope(zip_path: Path, rubric: Rubric, *, lab: Path = LAB) -> None:
    """
    Write the zip, whole or not at all; the same files give the same bytes.

    :param lab: the folder of the lab that is to grade.
    :raises ValueError: when the rubric or the lab cannot be taken elsewhere.
    :raises OSError: when it cannot be written.
    """
    content = list(_content(rubric, lab))
    with (
        replacing(zip_path) as part,
        ZipFile(part, 'w', compression=ZIP_DEFLATED) as archive,
    ):
        for name, data in content:
            entry = ZipInfo(name)
            entry.external_attr = (_EXECUTABLE if name in SCRIPTS else 0o644) << 16
            entry.compress_type = ZIP_DEFLATED
            archive.writestr(entry, data)


def _content(rubric: Rubric, lab: Path) -> Iterator[tuple[str, bytes]]:
    """Yield names and contents."""
    packed = packed_rubric(rubric)
    for script in SCRIPTS:
        yield script, (_PLACE / script).read_bytes()
    yield RUBRIC_NAME_FILE, f'{packed.rubric}\n'.encode()
    for path, source in sorted(packed.files.items()):
        yield f'{RUBRIC_FOLDER}/{path}', source.read_bytes()
    yield LAB_FILE, packed_lab(lab)
