# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Files that are written whole or not at all."""

from pathlib import Path
import resource

from husky_course.files import replacing
import pytest


def test_no_file_takes_the_place_of_a_device() -> None:
    with (
        pytest.raises(FileExistsError, match='a device, no file'),
        replacing(Path('/dev/null')),  # root could
    ):
        raise AssertionError('it gave a name to write to')


def test_a_file_takes_its_place_when_it_is_whole(tmp_path: Path) -> None:
    file = tmp_path / 'file'
    file.symlink_to('/dev/null')
    with replacing(file) as part:
        part.write_text('whole')
    assert file.read_text() == 'whole'
    with pytest.raises(KeyError), replacing(file) as part:
        part.write_text({'half': ''}['other half'])
    assert [each.read_text() for each in tmp_path.iterdir()] == ['whole']


def test_a_file_for_which_there_is_no_room_is_named(tmp_path: Path) -> None:
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, before[1]))  # as on a full disk
    try:
        with pytest.raises(OSError) as caught, replacing(tmp_path / 'file') as part:
            part.write_text('more than nothing')
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert caught.value.filename == str(tmp_path / 'file')


def test_a_file_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    for file in (tmp_path / 'missing' / 'file', tmp_path):
        with pytest.raises(OSError) as caught, replacing(file) as part:
            part.write_text('whole')
        assert caught.value.filename == str(file)
        assert str(caught.value).endswith(f": '{file}'")
