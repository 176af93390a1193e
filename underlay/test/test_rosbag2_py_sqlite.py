# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`rosbag2_py` and files of sqlite3: those of older ROS 2, those of an enemy, and our own."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
import os
from pathlib import Path
import sqlite3
import tracemalloc
from typing import Any

from playpen_testing.bags import opened_reader, opened_writer, rest_of, times_of
from playpen_testing.waiting import wait_until
import pytest
import rosbag2_py
from rosbag2_py import bag_files, ReadOrder, ReadOrderSortBy, StorageFilter, StorageOptions
import yaml

QOS = """\
- {history: 3, depth: 0, reliability: 2, durability: 2, deadline: {sec: 0, nsec: 0},
   lifespan: {sec: 0, nsec: 0}, liveliness: 1, liveliness_lease_duration: {sec: 0, nsec: 0},
   avoid_ros_namespace_conventions: false}
"""
HASH = 'RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18'
DEFINITION = ('std_msgs/msg/String', 'ros2msg', 'string data', HASH)
TOLD = 'version: {}\nstorage_identifier: sqlite3\nduration: {{nanoseconds: 0}}\n'
NUMBER_OF_MESSAGES = 2500


def make(path: Path, version: int) -> None:
    """Write a file as ROS 2 did: 1 is Crystal's, 2 Foxy's, 3 Humble's, 4 Iron's and Jazzy's."""
    columns = {'name': '/chatter', 'type': 'std_msgs/msg/String', 'serialization_format': 'cdr'}
    if version >= 2:
        columns['offered_qos_profiles'] = QOS
    if version >= 4:
        columns['type_description_hash'] = HASH
    typed = ', '.join(f'{name} TEXT NOT NULL' for name in columns)
    with closing(sqlite3.connect(path)) as file, file:
        if version >= 3:
            file.execute(
                'CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL)'
            )
            file.execute(
                'CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, '
                'metadata TEXT NOT NULL)'
            )
            distro = 'humble' if version == 3 else 'iron'
            file.execute('INSERT INTO schema VALUES (?, ?)', (version, distro))
        file.execute(f'CREATE TABLE topics(id INTEGER PRIMARY KEY, {typed})')
        if version >= 4:
            file.execute(
                'CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT '
                'NULL, encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, '
                'type_description_hash TEXT NOT NULL)'
            )
            file.execute('INSERT INTO message_definitions VALUES (NULL, ?, ?, ?, ?)', DEFINITION)
        file.execute(
            'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, '
            'timestamp INTEGER NOT NULL, data BLOB NOT NULL)'
        )
        if version >= 2:
            file.execute('CREATE INDEX timestamp_idx ON messages (timestamp ASC)')
        for name in ('/chatter', '/rosout'):
            marks = ', '.join('?' * len(columns))
            values = [*({**columns, 'name': name}).values()]
            file.execute(f'INSERT INTO topics VALUES (NULL, {marks})', values)
        for number in range(NUMBER_OF_MESSAGES):
            row = (1 + number % 5 // 4, time_of(number), b'%d' % number)
            file.execute('INSERT INTO messages VALUES (NULL, ?, ?, ?)', row)


def time_of(number: int) -> int:
    """Return times that are neither in order nor each another one."""
    return (number ^ 3) // 2 * 10


IN_ORDER = sorted(range(NUMBER_OF_MESSAGES), key=lambda number: (time_of(number), number))


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    make(tmp_path / 'bag.db3', 4)
    return tmp_path / 'bag.db3'


def numbers(reader: rosbag2_py.SequentialReader) -> list[int]:
    return [int(data) for _, data, _ in rest_of(reader)]


def names_in(folder: Path) -> list[str]:
    return sorted(each.name for each in folder.iterdir())


@pytest.mark.parametrize('storage_id', ['', 'sqlite3'])
@pytest.mark.parametrize('version', [1, 2, 3, 4])
def test_files_of_each_ros_are_read(tmp_path: Path, version: int, storage_id: str) -> None:
    make(tmp_path / 'bag.db3', version)
    reader = opened_reader(tmp_path / 'bag.db3', storage_id)
    assert numbers(reader) == IN_ORDER
    chatter, _ = reader.get_all_topics_and_types()
    assert (chatter.name, chatter.type) == ('/chatter', 'std_msgs/msg/String')
    assert chatter.type_description_hash == (HASH if version == 4 else '')
    policies = [
        rosbag2_py.convert_rclcpp_qos_to_rclpy_qos(q) for q in chatter.offered_qos_profiles
    ]
    assert [each.reliability.name for each in policies] == ['BEST_EFFORT'] * (version > 1)
    definitions = [each.encoding for each in reader.get_all_message_definitions()]
    assert definitions == ['ros2msg'] * (version == 4)
    metadata = reader.get_metadata()
    assert metadata.ros_distro == ('', '', '', 'humble', 'iron')[version]
    assert (metadata.message_count, metadata.storage_identifier) == (2500, 'sqlite3')
    assert [each.message_count for each in metadata.topics_with_message_count] == [2000, 500]

    reader.seek(time_of(1500))
    assert numbers(reader) == [each for each in IN_ORDER if time_of(each) >= time_of(1500)]
    assert reader.set_read_order(ReadOrder(reverse=True))
    reader.seek(2**63 - 1)
    assert numbers(reader) == IN_ORDER[::-1]
    reader.seek(2**63 - 1)
    reader.set_filter(StorageFilter(topics=['/rosout']))
    assert numbers(reader) == [each for each in IN_ORDER[::-1] if each % 5 == 4]
    for sort_by in (ReadOrderSortBy.File, ReadOrderSortBy.PublishedTimestamp):
        assert not reader.set_read_order(ReadOrder(sort_by))


def test_to_seek_the_last_time_reads_all_of_that_time_again(bag: Path) -> None:
    reader = opened_reader(bag)
    read = [reader.read_next()[2] for _ in range(4)]
    assert read == [0, 0, 10, 10]
    reader.seek(10)
    assert [reader.read_next()[2] for _ in range(3)] == [10, 10, 20]


def test_names_in_an_old_metadata_begin_with_the_folder(bag: Path) -> None:
    folder = bag.parent / 'old'
    folder.mkdir()
    bag.rename(folder / 'old.db3')
    content = yaml.safe_load(TOLD.format(3)) | {
        'starting_time': {'nanoseconds_since_epoch': 0},
        'message_count': 2500,
        'topics_with_message_count': [],
        'relative_file_paths': ['old/old.db3'],
    }
    text = yaml.safe_dump({'rosbag2_bagfile_information': content})
    (folder / 'metadata.yaml').write_text(text)
    assert numbers(opened_reader(folder)) == IN_ORDER
    assert bag_files.describe(folder).relative_file_paths == ['old.db3']
    newer = text.replace('version: 3', 'version: 4').replace('old/old.db3', 'old.db3')
    (folder / 'metadata.yaml').write_text(newer)
    assert numbers(opened_reader(folder)) == IN_ORDER
    packed = text.replace('relative_file', 'compression_mode: MESSAGE\n  relative_file')
    (folder / 'metadata.yaml').write_text(packed)
    with pytest.raises(RuntimeError, match=r"'.*old\.db3' has a message that cannot be decompr"):
        numbers(opened_reader(folder))


def test_messages_are_not_kept_in_memory(tmp_path: Path) -> None:
    writer = opened_writer(tmp_path / 'bag', 'n', storage_id='sqlite3')
    for number in range(100):
        writer.write('n', bytes(500_000), number)
    writer.close()
    reader = opened_reader(tmp_path / 'bag')
    tracemalloc.start()
    try:
        while reader.has_next():
            reader.read_next()
        assert tracemalloc.get_traced_memory()[1] < 5_000_000
    finally:
        tracemalloc.stop()


def test_a_bag_has_the_tables_of_jazzy(tmp_path: Path) -> None:
    told = {'robot': 'husky'}
    writer = opened_writer(tmp_path / 'bag', '/a', '/b', storage_id='sqlite3', custom_data=told)
    writer.write('/a', b'1', 7, 3)
    writer.write('/b', b'2', 8)
    writer.remove_topic(rosbag2_py.TopicMetadata(0, '/b', 'std_msgs/msg/String', 'cdr'))
    writer.close()
    assert names_in(tmp_path / 'bag') == ['bag_0.db3', 'metadata.yaml']
    with closing(sqlite3.connect(tmp_path / 'bag' / 'bag_0.db3')) as file:
        columns = {
            table: [row[1] for row in file.execute(f'PRAGMA table_info({table})')]
            for (table,) in file.execute("SELECT name FROM sqlite_master WHERE type = 'table'")
        }
        assert file.execute('SELECT * FROM schema').fetchall() == [(4, 'jazzy')]
        assert file.execute('SELECT * FROM messages').fetchall() == [
            (1, 1, 7, b'1'),
            (2, 2, 8, b'2'),
        ]
        assert file.execute('SELECT id, name FROM topics').fetchall() == [(1, '/a')]
        assert file.execute('PRAGMA journal_mode').fetchone() == ('delete',)
        assert file.execute('PRAGMA integrity_check').fetchone() == ('ok',)
    assert columns == {
        'schema': ['schema_version', 'ros_distro'],
        'metadata': ['id', 'metadata_version', 'metadata'],
        'topics': [
            'id', 'name', 'type', 'serialization_format', 'offered_qos_profiles',
            'type_description_hash',
        ],
        'message_definitions': [
            'id', 'topic_type', 'encoding', 'encoded_message_definition', 'type_description_hash',
        ],
        'messages': ['id', 'topic_id', 'timestamp', 'data'],
    }  # fmt: skip
    (tmp_path / 'bag' / 'metadata.yaml').unlink()
    rosbag2_py.Reindexer().reindex(StorageOptions(str(tmp_path / 'bag'), 'sqlite3'))
    bag = rosbag2_py.Info().read_metadata(str(tmp_path / 'bag'), '')
    assert (bag.message_count, bag.custom_data) == (1, told)
    assert times_of(opened_reader(tmp_path / 'bag')) == [7]


def test_what_a_removed_topic_had_is_not_given_to_the_next(tmp_path: Path) -> None:
    writer = opened_writer(tmp_path / 'bag', '/a', '/b', storage_id='sqlite3')
    writer.write('/b', b'of b', 7)
    writer.remove_topic(rosbag2_py.TopicMetadata(0, '/b', 'std_msgs/msg/String', 'cdr'))
    writer.create_topic(rosbag2_py.TopicMetadata(0, '/c', 'std_msgs/msg/Bool', 'cdr'))
    writer.write('/c', b'of c', 8)
    writer.close()
    assert rest_of(opened_reader(tmp_path / 'bag')) == [('/c', b'of c', 8)]


def test_new_files_are_begun_by_size(tmp_path: Path) -> None:
    writer = opened_writer(
        tmp_path / 'bag',
        'n',
        storage_id='sqlite3',
        storage_preset_profile='resilient',
        max_bagfile_size=200_000,
    )
    for number in range(100):
        writer.write('n', bytes(10_000), number)
    writer.close()
    bag = bag_files.describe(tmp_path / 'bag')
    assert len(bag.files) > 3
    assert all((tmp_path / 'bag' / file.path).stat().st_size < 300_000 for file in bag.files)
    assert times_of(opened_reader(tmp_path / 'bag')) == list(range(100))


def test_a_bag_is_read_while_it_is_recorded(tmp_path: Path) -> None:
    writer = opened_writer(tmp_path / 'bag', 'n', storage_id='sqlite3')
    for number in range(3000):
        writer.write('n', bytes(1000), number)
    wait_until(
        lambda: times_of(opened_reader(tmp_path / 'bag')) == list(range(3000)),
        timeout_sec=20.0,
        what='all that was written, in a bag that is not closed',
    )
    assert rosbag2_py.Info().read_metadata(str(tmp_path / 'bag'), '').bag_size > 3000 * 1000
    writer.close()
    assert len(times_of(opened_reader(tmp_path / 'bag'))) == 3000


def test_a_full_disk_is_told(tmp_path: Path) -> None:
    writer = opened_writer(tmp_path / 'bag', 'n', storage_id='sqlite3')
    file: Any = writer._writer._file
    file._connection.execute('PRAGMA max_page_count = 100')
    told = r"^'[^']*/bag_0.db3' cannot be written: database or disk is full$"

    def write_on() -> None:
        for number in range(10_000):
            writer.write('n', bytes(9000), number)

    with pytest.raises(RuntimeError, match=told):
        write_on()
    with pytest.raises(RuntimeError, match=told):
        writer.close()


@pytest.mark.parametrize('name', ['a b?mode=rw#1%41.db3', "it's.db3", 'file:x.db3'])
def test_odd_names_are_those_of_files(bag: Path, name: str) -> None:
    odd = bag.rename(bag.with_name(name))
    assert numbers(opened_reader(odd)) == IN_ORDER
    assert names_in(odd.parent) == [name]


def test_reading_writes_nothing(bag: Path) -> None:
    with closing(sqlite3.connect(bag)) as file:
        file.execute('PRAGMA journal_mode = WAL')
    bag.chmod(0o400)
    bag.parent.chmod(0o500)
    before = bag.read_bytes()
    try:
        assert numbers(opened_reader(bag)) == IN_ORDER
    finally:
        bag.parent.chmod(0o700)
    assert (names_in(bag.parent), bag.read_bytes()) == ([bag.name], before)


def _sql(*statements: str) -> Callable[[Path], object]:
    def run(path: Path) -> None:
        with closing(sqlite3.connect(path)) as file, file:
            for each in statements:
                file.execute(each)

    return run


def _cut(path: Path) -> None:
    os.truncate(path, path.stat().st_size // 2)


def _spoil(path: Path) -> None:
    with path.open('r+b') as file:
        file.seek(4096)
        file.write(b'\xff' * (path.stat().st_size - 4096))


def _lock(path: Path) -> sqlite3.Connection:
    file = sqlite3.connect(path)
    file.execute('BEGIN EXCLUSIVE')
    return file


def _leave_journal(path: Path) -> None:
    """Leave what a writer leaves that is killed while it commits."""
    with closing(sqlite3.connect(path)) as file:
        file.execute('PRAGMA cache_size = 1')
        file.execute('BEGIN')
        file.execute('UPDATE messages SET data = zeroblob(5000)')
        saved = [each.read_bytes() for each in (path, path.with_name(f'{path.name}-journal'))]
    for each, content in zip((path, path.with_name(f'{path.name}-journal')), saved, strict=True):
        each.write_bytes(content)


BLOB = "SELECT 1 AS id, 1 AS topic_id, 1 AS timestamp, x'00' AS data"
FOREVER = f'WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i FROM n) {BLOB} FROM n'
ATTACKS: dict[str, tuple[Callable[[Path], object], str]] = {
    'empty': (lambda path: path.write_bytes(b''), 'is empty'),
    'text': (lambda path: path.write_text('no database'), 'does not begin as such files do'),
    'head': (lambda path: os.truncate(path, 16), 'it is damaged'),
    'cut': (_cut, 'it is damaged'),
    'spoiled': (_spoil, 'it is damaged'),
    'locked': (_lock, 'another program writes it'),
    'journal': (_leave_journal, "bag.db3-journal' beside it"),
    'no topics': (_sql('DROP TABLE topics'), "it has no table 'topics'"),
    'no messages': (_sql('DROP TABLE messages'), "it has no table 'messages'"),
    'no data': (
        _sql('DROP TABLE messages', 'CREATE TABLE messages(id, topic_id, timestamp)'),
        "its table 'messages' has no 'data'",
    ),
    'view': (
        _sql('DROP TABLE messages', f'CREATE VIEW messages AS {FOREVER}'),
        "it has no table 'messages'",
    ),
    'virtual table': (
        _sql(
            'DROP TABLE messages',
            'PRAGMA writable_schema = ON',
            "INSERT INTO sqlite_master VALUES ('table', 'messages', 'messages', 0, "
            "'CREATE VIRTUAL TABLE messages USING module_of_an_enemy(id)')",
        ),
        "it has no table 'messages'",
    ),
    'view of topics': (
        _sql('DROP TABLE topics', 'CREATE VIEW topics AS SELECT 1 AS id'),
        "it has no table 'topics'",
    ),
    'worked out': (
        _sql(
            'DROP TABLE messages',
            'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, '
            'data AS (zeroblob(1000000000)))',
            'INSERT INTO messages VALUES (1, 1, 1)',
        ),
        "its table 'messages' has no 'data'",
    ),
    'text for bytes': (
        _sql("UPDATE messages SET data = 'text' WHERE id = 2000"),
        'message 2000 has str for data, not bytes',
    ),
    'text for time': (
        _sql("UPDATE messages SET timestamp = 'soon'"),
        "'soon' stands where a time",
    ),
    'time before all': (_sql('UPDATE messages SET timestamp = -1'), '-1 stands where a time'),
    'half a time': (_sql('UPDATE messages SET timestamp = 0.5'), '0.5 stands where a time'),
    'bytes for name': (_sql("UPDATE topics SET name = x'ff'"), 'stands where a text belongs'),
    'no utf-8': (_sql("UPDATE topics SET name = CAST(x'ff' AS TEXT)"), 'Could not decode'),
    'text for id': (
        _sql(
            'DROP TABLE topics',
            'CREATE TABLE topics(id, name, type, serialization_format)',
            "INSERT INTO topics VALUES ('1) --', '/a', 'b', 'cdr')",
        ),
        'is no whole number',
    ),
    'no row numbers': (
        _sql(
            'DROP TABLE messages',
            'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data) '
            'WITHOUT ROWID',
            "INSERT INTO messages VALUES (1, 1, 1, x'00')",
        ),
        'no such column: rowid',
    ),
}


@pytest.mark.parametrize('attack', ATTACKS)
def test_broken_and_hostile_files_are_refused_in_a_line(
    bag: Path, monkeypatch: pytest.MonkeyPatch, attack: str
) -> None:
    from rosbag2_py.storages import sqlite_database

    monkeypatch.setattr(sqlite_database, '_BUSY_SEC', 0.01)
    prepare, message = ATTACKS[attack]
    kept = prepare(bag)
    with pytest.raises(RuntimeError) as raised:
        rest_of(opened_reader(bag))
    if isinstance(kept, sqlite3.Connection):
        kept.close()
    told = str(raised.value)
    assert message in told
    assert str(bag) in told
    assert '\n' not in told


def test_a_trigger_or_a_table_of_another_name_does_no_harm(bag: Path) -> None:
    _sql(
        'CREATE TABLE sums(n INTEGER)',
        'CREATE TRIGGER on_sums AFTER INSERT ON sums BEGIN INSERT INTO sums VALUES (1); END',
        f'CREATE VIEW schema_view AS {FOREVER}',
        "UPDATE schema SET ros_distro = 'humble'",
        "UPDATE topics SET offered_qos_profiles = '" + '[' * 1000 + "'",
        "INSERT INTO metadata VALUES (1, 9, 'custom_data: [1]')",
        "INSERT INTO messages VALUES (NULL, 99, 5, 'of no topic')",
    )(bag)
    reader = opened_reader(bag)
    assert numbers(reader) == IN_ORDER
    assert reader.get_metadata().ros_distro == 'humble'


def test_damage_anywhere_is_read_or_refused(bag: Path) -> None:
    whole = bag.read_bytes()
    refused = 0
    for place in range(0, len(whole), len(whole) // 40):
        bag.write_bytes(whole[:place] + b'\xff' * 16 + whole[place + 16 :])
        try:
            opened = opened_reader(bag)
            opened.get_all_message_definitions()
            rest_of(opened)
        except RuntimeError as error:
            refused += 1
            assert '\n' not in str(error)
    assert refused > 5


def test_a_folder_in_place_of_a_file_is_refused(bag: Path) -> None:
    folder = bag.parent / 'bag'
    (folder / 'x.db3').mkdir(parents=True)
    with pytest.raises(RuntimeError, match=r'x\.db3.* is no file'):
        opened_reader(folder)
    (folder / 'x.db3').rmdir()
    bag.rename(folder / 'x.db3')
    (folder / 'x.mcap').touch()
    with pytest.raises(RuntimeError, match='stored as mcap and as sqlite3'):
        opened_reader(folder)
    assert numbers(opened_reader(folder, 'sqlite3')) == IN_ORDER
