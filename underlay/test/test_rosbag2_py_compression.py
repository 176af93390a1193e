# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Bags that are compressed as `ros2 bag record --compression-mode` does."""

from __future__ import annotations

from pathlib import Path
import shutil
import tempfile
from typing import Any

from playpen_testing.bags import opened_reader, opened_writer, rest_of, string, times_of
import pytest
from rosbag2_py import (
    bag_files,
    compression_mode_from_string,
    compression_mode_to_string,
    CompressionMode,
    CompressionOptions,
    ConverterOptions,
    MetadataIo,
    Reindexer,
    SequentialCompressionReader,
    SequentialCompressionWriter,
    StorageOptions,
    TopicMetadata,
)
from rosbag2_py.bag_writer import BagWriter
from rosbag2_py.storages import storage_of
import yaml
import zstandard

STORAGES = pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])


@pytest.fixture(autouse=True)
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder for temporary files of the test."""
    (folder := tmp_path / 'temporary').mkdir()
    monkeypatch.setattr(tempfile, 'tempdir', str(folder))
    return folder


def pack(file: Path) -> Path:
    packed = file.with_name(f'{file.name}.zstd')
    packed.write_bytes(zstandard.compress(file.read_bytes()))
    file.unlink()
    return packed


def tell(folder: Path, **fields: Any) -> None:
    """Change what metadata.yaml says."""
    metadata = yaml.safe_load((folder / 'metadata.yaml').read_text())
    metadata['rosbag2_bagfile_information'] |= fields
    (folder / 'metadata.yaml').write_text(yaml.safe_dump(metadata))


def two_files(folder: Path, storage: str) -> list[Path]:
    """Write a bag of two files with 'number 0' to 'number 5'; return them."""
    writer = opened_writer(folder, 'n', storage_id=storage)
    for number in range(6):
        if number == 3:
            writer.split_bagfile()
        writer.write('n', string(number), number)
    writer.close()
    return sorted(folder.glob('bag_*'))


@STORAGES
def test_files_that_are_compressed_are_read(tmp_path: Path, temporary: Path, storage: str) -> None:
    folder = tmp_path / 'bag'
    packed = [pack(file) for file in two_files(folder, storage)]
    names = [file.name for file in packed]
    tell(folder, compression_format='zstd', compression_mode='FILE', relative_file_paths=names)
    reader = opened_reader(folder)
    assert rest_of(reader) == [('n', string(number), number) for number in range(6)]
    reader.seek(2)  # back into the first file
    assert times_of(reader) == [2, 3, 4, 5]
    told = bag_files.describe(folder)
    assert (told.message_count, told.relative_file_paths) == (6, names)
    assert times_of(opened_reader(packed[1])) == [3, 4, 5]
    assert list(temporary.iterdir()) == []
    assert sorted(folder.glob('bag_*')) == packed


@STORAGES
def test_of_a_killed_recording_the_last_file_is_not_compressed(
    tmp_path: Path, storage: str
) -> None:
    folder = tmp_path / 'bag'
    pack(two_files(folder, storage)[0])
    (folder / 'metadata.yaml').unlink()
    assert times_of(opened_reader(folder)) == list(range(6))
    Reindexer().reindex(StorageOptions(str(folder), storage))
    metadata = yaml.safe_load((folder / 'metadata.yaml').read_text())
    told = metadata['rosbag2_bagfile_information']
    assert (told['compression_format'], told['compression_mode']) == ('zstd', 'FILE')


@STORAGES
@pytest.mark.parametrize('is_flushed', [False, True])
def test_of_a_killed_recording_the_files_before_tell_the_rest(
    tmp_path: Path, storage: str, is_flushed: bool
) -> None:
    kept, told = tmp_path / 'killed', {'robot': 'husky'}
    with BagWriter(
        tmp_path / 'bag',
        storage_of(storage),
        compress=CompressionMode.MESSAGE,
        custom_data=told,
    ) as writer:
        writer.add_topic(TopicMetadata(0, 'n', 'std_msgs/msg/String', 'cdr'))
        writer.write('n', string(0), 0, 0)
        writer.split()
        writer.write('n', string(1), 1, 1)
        if is_flushed:
            writer.flush()
        shutil.copytree(tmp_path / 'bag', kept)  # what a kill leaves
    Reindexer().reindex(StorageOptions(str(kept)))
    bag = MetadataIo().read_metadata(str(kept))
    assert len(bag.relative_file_paths) == 2
    assert bag.message_count >= 1
    assert (bag.custom_data, bag.ros_distro) == (told, 'jazzy')
    # Without these upstream hands out the messages as they are stored.
    assert (bag.compression_format, bag.compression_mode) == ('zstd', 'MESSAGE')


@STORAGES
def test_a_file_not_yet_compressed_is_not_said_to_be(tmp_path: Path, storage: str) -> None:
    folder = tmp_path / 'bag'
    options = CompressionOptions('zstd', CompressionMode.FILE)
    writer = SequentialCompressionWriter(options)
    writer.open(StorageOptions(str(folder), storage), ConverterOptions('', ''))
    writer.close()
    (packed,) = folder.glob('*.zstd')
    packed.with_suffix('').write_bytes(
        zstandard.ZstdDecompressor().decompress(packed.read_bytes())
    )
    packed.unlink()
    Reindexer().reindex(StorageOptions(str(folder)))
    bag = MetadataIo().read_metadata(str(folder))
    assert bag.relative_file_paths == [packed.stem]
    assert (bag.compression_format, bag.compression_mode) == ('', '')


@STORAGES
@pytest.mark.parametrize('is_killed', [False, True])
def test_messages_that_are_compressed_are_read(
    tmp_path: Path, storage: str, is_killed: bool
) -> None:
    writer = opened_writer(tmp_path / 'bag', 'n', storage_id=storage)
    for number in range(3):
        writer.write('n', zstandard.compress(string(number)), number)
    writer.write('n', b'\x28\xb5\x2f\xfd\xe0' + bytes(7) + b'\x7f', 3)  # of 2**63 bytes
    writer.close()
    if is_killed:
        (tmp_path / 'bag' / 'metadata.yaml').unlink()
    else:
        tell(tmp_path / 'bag', compression_format='zstd', compression_mode='MESSAGE')
    reader = opened_reader(tmp_path / 'bag')
    assert [reader.read_next()[1] for _ in range(3)] == [string(number) for number in range(3)]
    with pytest.raises(RuntimeError, match=r"'.*' has a message that cannot be decompressed: "):
        reader.read_next()


def test_what_cannot_be_decompressed_is_refused_in_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = (pack(file) for file in two_files(tmp_path / 'bag', 'mcap'))
    first.write_bytes(first.read_bytes()[:200])
    with pytest.raises(
        RuntimeError, match=rf"^'{first}' cannot be read as MCAP: it ends too soon"
    ):
        opened_reader(first)
    monkeypatch.setattr(tempfile, 'tempdir', str(tmp_path / 'none'))
    with pytest.raises(RuntimeError, match=r'into .*none: No such file .*; TMPDIR names another'):
        opened_reader(second)


@STORAGES
@pytest.mark.parametrize('mode', [CompressionMode.FILE, CompressionMode.MESSAGE])
def test_what_is_written_compressed_is_read(
    tmp_path: Path, storage: str, mode: CompressionMode
) -> None:
    folder = tmp_path / 'bag'
    writer = SequentialCompressionWriter(CompressionOptions('zstd', mode))
    writer.open(StorageOptions(str(folder), storage), ConverterOptions())
    writer.create_topic(TopicMetadata(0, 'n', 'std_msgs/msg/String', 'cdr'))
    for number in range(6):
        if number == 3:
            writer.split_bagfile()
        writer.write('n', string(number), number)
    writer.close()
    reader = SequentialCompressionReader()
    reader.open_uri(str(folder))
    assert rest_of(reader) == [('n', string(number), number) for number in range(6)]
    told = reader.get_metadata()
    assert (told.compression_format, told.compression_mode) == ('zstd', mode.name)
    suffix = '.zstd' if mode is CompressionMode.FILE else ''
    names = [f'bag_{n}{".mcap" if storage == "mcap" else ".db3"}{suffix}' for n in range(2)]
    assert told.relative_file_paths == names
    assert [file.path for file in told.files] == names
    assert sorted(file.name for file in folder.iterdir()) == [*names, 'metadata.yaml']


def test_a_file_that_cannot_be_compressed_stays_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / 'bag'
    writer = SequentialCompressionWriter(CompressionOptions('zstd', CompressionMode.FILE))
    writer.open(StorageOptions(str(folder)), ConverterOptions())
    writer.create_topic(TopicMetadata(0, 'n', 'std_msgs/msg/String', 'cdr'))
    writer.write('n', string(0), 0)
    (folder / 'bag_0.mcap.zstd').symlink_to('/dev/full')
    with pytest.raises(RuntimeError, match="bag' cannot be written: No space left on device"):
        writer.close()
    assert rest_of(opened_reader(folder)) == [('n', string(0), 0)]


def test_what_cannot_compress_is_refused() -> None:
    for options, message in {
        CompressionOptions(): 'needs CompressionMode.FILE or CompressionMode.MESSAGE',
        CompressionOptions('lz4', CompressionMode.FILE): "'lz4': here it is zstd",
    }.items():
        with pytest.raises(RuntimeError, match=message):
            SequentialCompressionWriter(options)


def test_modes_have_names(capfd: pytest.CaptureFixture[str]) -> None:
    for mode in CompressionMode:
        assert compression_mode_from_string(compression_mode_to_string(mode).lower()) is mode
    assert compression_mode_from_string('') is CompressionMode.NONE
    assert compression_mode_from_string('all') is CompressionMode.NONE
    assert "'all' is no mode of compression" in capfd.readouterr().err
