# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`rosbag2_py`: its names, the values that its classes take, and what it refuses."""

from __future__ import annotations

from collections.abc import Callable
import importlib
from pathlib import Path
import subprocess
import sys
from typing import Any

from playpen_testing.bags import (
    opened_writer,
    write_metadata,
)
import pytest
from rclpy.duration import Duration
from rclpy.time import Time
import rosbag2_py
from rosbag2_py import (
    ConverterOptions,
    SequentialReader,
    SequentialWriter,
    StorageFilter,
    StorageOptions,
    TopicMetadata,
)
from std_msgs.msg import String

# What Jazzy's rosbag2_py exports.
UPSTREAM = (
    'bag_rewrite convert_rclcpp_qos_to_rclpy_qos CompressionMode CompressionOptions '
    'compression_mode_from_string compression_mode_to_string ConverterOptions FileInformation '
    'get_default_storage_id get_registered_readers get_registered_writers '
    'get_registered_compressors get_registered_serializers to_rclcpp_qos_vector ReadOrder '
    'ReadOrderSortBy Reindexer SequentialCompressionReader SequentialCompressionWriter '
    'SequentialReader SequentialWriter StorageFilter StorageOptions TopicMetadata '
    'TopicInformation BagMetadata MessageDefinition MetadataIo Info Player PlayOptions '
    'ServiceRequestsSource Recorder RecordOptions LocalMessageDefinitionSource'
)


def test_each_name_is_there_or_says_what_to_use() -> None:
    for name in UPSTREAM.split():
        if name in rosbag2_py.__all__:
            assert getattr(rosbag2_py, name)
            continue
        with pytest.raises(ImportError, match=rf'rosbag2_py\.{name} needs a full ROS 2; here .+'):
            exec(f'from rosbag2_py import {name}')
    assert set(rosbag2_py.__all__) <= set(UPSTREAM.split())
    assert rosbag2_py._storage.StorageOptions is StorageOptions
    assert importlib.import_module('rosbag2_py._writer').SequentialWriter is SequentialWriter
    storages = {'mcap', 'sqlite3'}
    assert rosbag2_py.get_registered_readers() == rosbag2_py.get_registered_writers() == storages
    assert rosbag2_py.get_registered_compressors() == {'zstd'}
    assert rosbag2_py.get_registered_serializers() == set()
    with pytest.raises(AttributeError, match='SequentialWrite'):
        _ = rosbag2_py.SequentialWrite


def test_the_import_loads_neither_rclpy_nor_numpy() -> None:
    code = (
        "import rosbag2_py, sys; print({'rclpy', 'numpy', 'mcap', 'sqlite3'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    assert done.stdout == 'set()\n'


def test_attributes_take_their_types_alone() -> None:
    options = StorageOptions('a', max_cache_size=3)
    assert (options.storage_id, options.end_time_ns, options.custom_data) == ('', -1, {})
    options.uri = 'b'
    with pytest.raises(TypeError, match=r'StorageOptions.uri=.*takes a str; write str'):
        options.uri = Path('b')  # type: ignore[assignment]
    with pytest.raises(TypeError, match='whole number from 0 to 65535'):
        TopicMetadata(-1, 'n', 't', 'cdr')
    with pytest.raises(TypeError, match=r'offered_qos_profiles=.*a list, each item a QoS'):
        TopicMetadata(0, 'n', 't', 'cdr', [''])  # type: ignore[list-item]
    with pytest.raises(TypeError, match='a list'):
        StorageFilter(topics='/chatter')  # type: ignore[arg-type]
    storage_filter = StorageFilter()
    storage_filter.topics.append('lost')
    assert storage_filter.topics == StorageFilter().topics == []
    bag = rosbag2_py.BagMetadata(message_count=2, duration=Duration(seconds=1))
    assert (bag.version, bag.duration, bag.starting_time) == (9, Duration(seconds=1), Time())


def _open(**options: Any) -> Callable[[Path], object]:
    def run(folder: Path) -> object:
        uri = options.pop('uri', str(folder / 'new'))
        writer = SequentialWriter()
        writer.open(StorageOptions(uri, **options), ConverterOptions())
        return writer

    return run


def _write(*arguments: Any) -> Callable[[Path], object]:
    return lambda folder: opened_writer(folder / 'new', 'n').write(*arguments)


def _read(name: str, storage_id: str = 'mcap') -> Callable[[Path], object]:
    options = StorageOptions(name, storage_id)
    return lambda _: SequentialReader().open(options, ConverterOptions())


@pytest.mark.parametrize(
    ('run', 'error', 'message'),
    [
        (
            _open(storage_id='csv'),
            RuntimeError,
            "stored as 'mcap' or 'sqlite3' here",
        ),
        (_open(uri='.'), RuntimeError, "'.' already exists"),
        (_open(storage_preset_profile='best'), RuntimeError, 'it is one of none, fastwrite'),
        (_open(snapshot_mode=True), RuntimeError, 'needs a max_cache_size'),
        (_open(storage_config_uri='x'), RuntimeError, 'use storage_preset_profile'),
        (_open(max_bagfile_size=10), RuntimeError, '1024 bytes at least'),
        (_write('m', b'', 0), RuntimeError, "no topic 'm', but 'n': call create_topic"),
        (_write('n', String(), 0), TypeError, r'serialize_message\(msg\) makes them'),
        (_write('n', b'', 0.5), TypeError, '0.5: a time is a whole number'),
        (_write('n', b'', Time()), TypeError, r'write .nanoseconds behind it'),
        (_write('n', b'', -1), TypeError, 'from 0 to'),
        (lambda _: SequentialWriter().write('n', b'', 0), RuntimeError, r'call open\(\) first'),
        (lambda _: SequentialReader().has_next(), RuntimeError, r'call open\(\) first'),
        (lambda _: SequentialReader().open('bag', 'mcap'), TypeError, 'rosbag2_py.StorageOptions'),  # type: ignore[arg-type]
        (_read('nowhere'), RuntimeError, "Bag path 'nowhere' does not exist"),
        (_read('old'), RuntimeError, "are stored as sqlite3, write storage_id='sqlite3'"),
        (_read('old', 'sqlite3'), RuntimeError, 'does not begin as such files do'),
        (_read('zipped', 'sqlite3'), RuntimeError, "is stored as mcap: write storage_id='mcap'"),
        (_open(storage_id='sqlite3', max_bagfile_size=1024), RuntimeError, '86016 bytes at least'),
        (
            _open(storage_id='sqlite3', storage_preset_profile='zstd_fast'),
            RuntimeError,
            'for sqlite3 it is one of none, resilient',
        ),
        (_read('old', 'csv'), RuntimeError, "stored as 'mcap' or 'sqlite3' here"),
        (_read('old/x.db3'), RuntimeError, 'cannot be read as MCAP'),
        (_read('zipped'), RuntimeError, r"real_0.mcap.zstd' cannot be decompressed: "),
        (_read('torn'), RuntimeError, 'metadata.yaml.*lacks'),
    ],
)
def test_what_cannot_be_is_refused_in_words(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    run: Callable[[Path], object],
    error: type[Exception],
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'old').mkdir()
    (tmp_path / 'old' / 'x.db3').write_text('SQLite format 3')
    (tmp_path / 'zipped').mkdir()
    write_metadata(tmp_path / 'zipped', 9, [], 'real_0.mcap.zstd')
    (tmp_path / 'zipped' / 'real_0.mcap.zstd').write_bytes(bytes(99))
    (tmp_path / 'torn').mkdir()
    (tmp_path / 'torn' / 'metadata.yaml').write_text('rosbag2_bagfile_information: {version: 9}')
    with pytest.raises(error, match=message) as raised:
        run(tmp_path)
    assert '\n' not in str(raised.value)


def test_definitions_come_with_all_that_is_inside() -> None:
    source = rosbag2_py.LocalMessageDefinitionSource()
    text = source.get_full_text('geometry_msgs/msg/PointStamped').encoded_message_definition
    inside = [line[5:] for line in text.splitlines() if line.startswith('MSG: ')]
    assert inside == ['std_msgs/Header', 'geometry_msgs/Point', 'builtin_interfaces/Time']
    assert source.get_full_text('nothing').encoding == 'unknown'
    with pytest.raises(RuntimeError, match="'std_msgs/msg/Strin' has no definition here"):
        source.get_full_text('std_msgs/msg/Strin')
