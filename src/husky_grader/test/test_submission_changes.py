# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Submissions that change while they are read, as where students can write into the folder."""

import os
from pathlib import Path

from husky_grader.submission import Limits, Refused
from husky_grader.submission.entries import folder_entries
from husky_grader.submission.limits import Meter
import pytest


@pytest.mark.parametrize('what', ['link', 'link to a folder', 'pipe', 'folder', 'nothing'])
def test_what_is_put_in_the_place_of_a_file_is_not_read(tmp_path: Path, what: str) -> None:
    secret = tmp_path / 'secret'
    (secret / 'inner').mkdir(parents=True)
    (secret / 'inner' / 'a').write_text('of the grader')
    place = tmp_path / 'ann' / 'src' / 'inner' / 'a'
    place.parent.mkdir(parents=True)
    place.write_text('of Ann')
    found = folder_entries(tmp_path / 'ann', Meter(Limits()))
    entry = next(each for each in found if each.name == 'a')
    assert b''.join(entry.chunks()) == b'of Ann'
    place.unlink()
    if what == 'link':
        place.symlink_to(secret / 'inner' / 'a')
    elif what == 'link to a folder':
        place.parent.rmdir()
        place.parent.symlink_to(secret / 'inner')
    elif what == 'pipe':
        os.mkfifo(place)
    elif what == 'folder':
        place.mkdir()
    with pytest.raises(Refused, match=r'^src/inner/a changed while it was read; grade a copy'):
        list(entry.chunks())


def test_a_folder_that_became_a_link_is_not_listed(tmp_path: Path) -> None:
    secret = tmp_path / 'secret'
    secret.mkdir()
    (secret / 'a').write_text('of the grader')
    source = tmp_path / 'ann' / 'src'
    source.mkdir(parents=True)
    found = folder_entries(tmp_path / 'ann', Meter(Limits()))
    assert next(found).path == 'src'
    source.rmdir()
    source.symlink_to(secret)
    with pytest.raises(Refused, match=r'^src changed while it was read'):
        list(found)
