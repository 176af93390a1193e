# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The record of a run: written meanwhile, read by one reader, refused when it cannot be true."""

from collections.abc import Callable
import math
import os
from pathlib import Path
import random
import re
import resource
import signal
import subprocess
import sys
import time
import tracemalloc
from typing import Any

from husky_course.frames import Array
from husky_course.record import (
    COLUMNS,
    FILE_NAME,
    read_record,
    RecordRefused,
)
from husky_course.record.blocks import block_of, read_blocks
from husky_course.robot import RobotStart
from husky_sim.errors import SettingError
from husky_sim.recording.recorded_scans import RecordedScans
from husky_sim.recording.recorder import open_recorder, RunRecorder
from husky_sim.simulation import Simulation
from husky_sim.world.world import default_worlds
import numpy as np
import pytest

from husky_sim.config import DriveConfig, SensorConfig, SimulationConfig

X = COLUMNS.index('x')


def new_simulation(world: str = 'empty') -> Simulation:
    return Simulation(SimulationConfig(world=str(default_worlds() / f'{world}.xml')))


def drive(simulation: Simulation, recorder: RunRecorder, periods: int) -> None:
    for _ in range(periods):
        simulation.robots[0].controller.command(0.6, 0.0, time_sec=simulation.time_sec)
        simulation.advance()
        recorder.append()


def content_of(path: Path) -> list[Any]:
    with path.open('rb') as stream:
        return list(read_blocks(stream))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Return the record of five seconds in the empty world."""
    simulation = new_simulation()
    with RunRecorder(simulation, tmp_path / FILE_NAME) as recorder:
        drive(simulation, recorder, 250)
    return tmp_path / FILE_NAME


def test_the_record_has_one_entry_a_period_and_the_start(tmp_path: Path) -> None:
    simulation = new_simulation('playpen')
    recorder = RunRecorder(simulation, tmp_path / 'new' / FILE_NAME)
    drive(simulation, recorder, 200)
    recorder.close()
    recorder.close()
    record = read_record(tmp_path / 'new')
    assert record.complete
    assert len(record.rows) == 201
    assert record.column(0, 'time_sec')[:3].tolist() == [0.0, 0.02, 0.04]
    assert record.column(0, 'x')[0] == 0.0
    assert record.column(0, 'x')[-1] == simulation.robots[0].state.position[0]
    assert [touch.obstacle for touch in record.collisions] == ['jersey_barrier_15']
    assert record.min_clearance_m(0) == 0.0
    assert [path.name for path in (tmp_path / 'new').iterdir()] == [FILE_NAME]


def test_scans_worked_out_of_a_record_are_those_that_were_measured(tmp_path: Path) -> None:
    world = str(default_worlds() / 'playpen.xml')
    start = RobotStart(x=-2.35, y=-2.6, yaw=-math.pi / 2)  # in front of a dumpster, to push it
    config = SimulationConfig(
        world=world, robots=(start,), sensors=SensorConfig(lidar_rate_hz=10.0)
    )
    simulation = Simulation(config)
    measured = {}
    with RunRecorder(simulation, tmp_path / FILE_NAME) as recorder:
        for period in range(1, 151):
            drive(simulation, recorder, 1)
            if simulation.robots[0].sensors.scan is not None:
                measured[period] = simulation.robots[0].sensors.scan
    record = read_record(tmp_path)
    assert list(record.pushed) == ['Dumpster_0']
    scans = dict(RecordedScans(record, 0))
    assert list(scans) == [0, *measured]
    for period, ranges in measured.items():
        # A record has neither roll nor pitch; beams past an edge may see what is behind it.
        is_near = np.isclose(scans[period], ranges, rtol=0.0, atol=0.02)
        assert is_near.mean() > 0.97, f'period {period}: {1.0 - is_near.mean():.3f} differ'


def test_what_disturbed_the_run_is_in_its_record(tmp_path: Path) -> None:
    simulation = new_simulation()
    with RunRecorder(simulation, tmp_path / FILE_NAME) as recorder:
        drive(simulation, recorder, 10)
        recorder.disturb(simulation.time_sec, 'odometry/filtered', ['/other', '/third'])
    (disturbance,) = read_record(tmp_path).disturbances
    assert disturbance.time_sec == 0.2
    assert disturbance.topic == 'odometry/filtered'
    assert disturbance.nodes == ('/other', '/third')


def test_a_reset_begins_the_record_anew(tmp_path: Path) -> None:
    simulation = new_simulation('playpen')
    with RunRecorder(simulation, tmp_path / FILE_NAME) as recorder:
        drive(simulation, recorder, 300)
        recorder.disturb(simulation.time_sec, 'odometry/filtered', ['/other'])
        simulation.reset()
        recorder.restart()
        drive(simulation, recorder, 20)
    record = read_record(tmp_path)
    assert len(record.rows) == 21
    assert (record.collisions, record.disturbances, record.complete) == ((), (), True)


def test_a_record_cut_off_anywhere_is_read_up_to_there(path: Path, tmp_path: Path) -> None:
    whole, rows = path.read_bytes(), read_record(path).rows
    first = len(block_of(content_of(path)[0])) + len(block_of(content_of(path)[1]))
    cut = tmp_path / 'cut'
    for length in {*random.Random(1).sample(range(first, len(whole)), 150), first}:
        cut.write_bytes(whole[:length])
        record = read_record(cut)
        assert not record.complete
        assert (record.rows == rows[: len(record.rows)]).all()
        assert len(rows) - len(record.rows) <= 1 + (len(whole) - length) / 8 / 11 + 100
    cut.write_bytes(whole[: first - 1])
    with pytest.raises(RecordRefused, match='no entries'):
        read_record(cut)


PROGRAM = """
import sys
from husky_sim.recording.recorder import RunRecorder
from husky_sim.simulation import Simulation
from husky_sim.world.world import default_worlds
from husky_sim.config import SimulationConfig
simulation = Simulation(SimulationConfig(world=str(default_worlds() / 'empty.xml')))
recorder = RunRecorder(simulation, sys.argv[1])
while True:
    simulation.advance()
    recorder.append()
    if simulation.periods % 50 == 0:
        print(simulation.periods, flush=True)
"""


def test_a_killed_simulator_loses_only_its_last_seconds(tmp_path: Path) -> None:
    command = [sys.executable, '-c', PROGRAM, str(tmp_path / FILE_NAME)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if int(line) >= 1000:
                process.send_signal(signal.SIGKILL)
                break
    record = read_record(tmp_path)
    assert not record.complete
    assert len(record.rows) >= 900


def test_memory_stays_the_same_and_the_end_is_soon_however_long(tmp_path: Path) -> None:
    simulation = new_simulation()
    recorder = RunRecorder(simulation, tmp_path / FILE_NAME)

    def pass_time(periods: int) -> None:
        for _ in range(periods):
            simulation.periods += 1
            recorder.append()

    pass_time(1000)
    tracemalloc.start()
    pass_time(60_000)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 200_000, 'a table of all periods would take five million bytes'
    begin = time.monotonic()
    recorder.close()
    assert time.monotonic() - begin < 0.5
    assert len(read_record(tmp_path).rows) == 61_001


def damaged(blocks: list[Any], change: Callable[[Array], object]) -> list[Any]:
    """Change the table of the second 100 rows."""
    tables = [block for block in blocks if isinstance(block, np.ndarray)]
    change(tables[1])
    return blocks


@pytest.mark.parametrize(
    ('change', 'said'),
    [
        (lambda table: table.__setitem__((3, 0, X), np.nan), 'NaN or infinity'),
        (lambda table: table.__setitem__((3, 0, X), np.inf), 'NaN or infinity'),
        (lambda table: table.__setitem__((3, 0, 3), 1e7), 'yaw of 1e'),
        (lambda table: table.__setitem__((3, 0, 6), -1e300), 'odom_yaw of 1e'),
        (lambda table: table.__setitem__((slice(None), 0, X), 1e9), 'x of 1e'),
        (lambda table: table.__setitem__((3, 0, 7), 2e3), 'speed_m_s of 2e'),
        (lambda table: table.__setitem__((3, 0, 10), 1e300), 'command_yaw_rate_rad_s of 1e'),
        (lambda table: table.__setitem__((3, 0, 0), 0.5), 'its time goes from'),
        (lambda table: table.__setitem__(slice(0, 99), table[1:].copy()), 'its time goes from'),
        (lambda table: table.__setitem__((slice(50, None), 0, X), 7.0), r'husky jumps \d\.\d+ m'),
    ],
)
def test_what_no_husky_can_have_done_is_refused(
    path: Path, change: Callable[[Array], object], said: str
) -> None:
    path.write_bytes(b''.join(map(block_of, damaged(content_of(path), change))))
    with pytest.raises(RecordRefused, match=said) as refused:
        read_record(path)
    assert '\n' not in str(refused.value)


def test_a_robot_may_be_as_fast_as_the_run_allows_it(tmp_path: Path) -> None:
    world = str(default_worlds() / 'empty.xml')
    drive_config = DriveConfig(speed_limit_m_s=5.0, acceleration_limit_m_s2=10.0)
    simulation = Simulation(SimulationConfig(world=world, drive=drive_config))
    with RunRecorder(simulation, tmp_path / FILE_NAME) as recorder:
        for _ in range(150):
            simulation.robots[0].controller.command(5.0, 0.0, time_sec=simulation.time_sec)
            simulation.advance()
            recorder.append()
    run = read_record(tmp_path)
    assert run.column(0, 'speed_m_s').max() > 4.9
    header, *blocks = content_of(tmp_path / FILE_NAME)
    for limit, said in (('2.0', 'jumps'), ('inf', 'limit of inf'), ('nan', 'limit of nan')):
        header['conditions'] = [f'speed_limit_m_s:={limit}']
        (tmp_path / FILE_NAME).write_bytes(b''.join(map(block_of, [header, *blocks])))
        with pytest.raises(RecordRefused, match=said):
            read_record(tmp_path)


HEADER = {'format': 'husky_playpen_record', 'version': 3, 'columns': COLUMNS, 'world': 'w'}
HEADER |= {'control_period_sec': 0.02, 'obstacles': [], 'robots': [], 'conditions': []}
ROBOT = {'name': 'husky', 'start': [0.0, 0.0, 0.0]}


@pytest.mark.parametrize(
    ('content', 'said'),
    [
        (b'', 'not the record of a run'),
        (b'waypoints: [[0, 0], [1, 0]]\n' * 9, 'no block of a record at byte 0'),
        (block_of([]), 'not the record of a run'),
        (block_of({'format': 'another'}), 'not the record of a run'),
        (block_of({**HEADER, 'version': 1}), 'version 1, but only 3'),
        (block_of(HEADER), 'no robots'),
        (block_of({**HEADER, 'columns': ['x']}), 'other columns'),
        (block_of({**HEADER, 'robots': [ROBOT]}), 'no entries'),
        (block_of({**HEADER, 'robots': [ROBOT]}) + block_of(np.zeros((2, 3))), 'another shape'),
        (block_of({**HEADER, 'robots': [{'name': 'husky'}]}), "'start'"),
        (
            block_of({**HEADER, 'robots': [ROBOT]}) + block_of([{'event': 'x'}]),
            "unknown event 'x'",
        ),
        (block_of({**HEADER, 'robots': [ROBOT]}) + block_of([7]), 'damaged'),
        (block_of(np.zeros(3)).replace(b'(3,)', b'(-3,)'), 'no block of a record'),
        (block_of(np.zeros(300)).replace(b"'<f8'", b"'|O'"), 'no block of a record'),
    ],
)
def test_what_is_no_record_is_refused_in_one_line(
    tmp_path: Path, content: bytes, said: str
) -> None:
    (tmp_path / FILE_NAME).write_bytes(content)
    with pytest.raises(RecordRefused, match=said) as refused:
        read_record(tmp_path / FILE_NAME)
    assert '\n' not in str(refused.value)
    assert str(refused.value).startswith(f'{tmp_path / FILE_NAME}: ')


def test_the_record_beside_what_was_given_is_named(tmp_path: Path) -> None:
    page = tmp_path / 'report.html'
    page.write_text('<!doctype html>')
    with pytest.raises(RecordRefused, match=r'; drive it again$'):
        read_record(page)
    (tmp_path / FILE_NAME).touch()
    with pytest.raises(RecordRefused, match=f'; {re.escape(str(tmp_path / FILE_NAME))} beside'):
        read_record(page)


OBSTACLE = {'name': 'cone', 'x': 0.0, 'y': 0.0, 'yaw': 0.0, 'size': [0.2]}


@pytest.mark.parametrize(
    ('change', 'said'),
    [
        ({'robots': [{'name': 'husky', 'start': [1e7, 0.0, 0.0]}]}, r'a place at \(1e\+07, 0\)'),
        ({'robots': [{'name': 'husky', 'start': [0.0, 0.0, 1e300]}]}, r'yaw 1e\+300'),
        ({'robots': [{'name': '\ud800', 'start': [0.0, 0.0, 0.0]}]}, 'surrogates not allowed'),
        ({'world': '\udcff'}, 'surrogates not allowed'),
        ({'conditions': [7]}, '7 instead of a text'),
        ({'conditions': ['x:=' + 9999 * 'y']}, 'conditions longer than 1000'),
        ({'obstacles': [{**OBSTACLE, 'y': -1e7}]}, 'a place at'),
        ({'obstacles': [{**OBSTACLE, 'size': [0.0]}]}, 'an obstacle of the size'),
        ({'obstacles': [{**OBSTACLE, 'size': [1.0, -1.0]}]}, 'an obstacle of the size'),
        ({'obstacles': [OBSTACLE] * 10_001}, '10001 obstacles, but 10000 are the most'),
    ],
)
def test_a_header_beyond_all_bounds_is_refused(
    path: Path, change: dict[str, Any], said: str
) -> None:
    header, *blocks = content_of(path)
    path.write_bytes(b''.join(map(block_of, [{**header, **change}, *blocks])))
    with pytest.raises(RecordRefused, match=said) as refused:
        read_record(path)
    assert '\n' not in str(refused.value)
    assert str(refused.value).isascii()


def test_a_changed_byte_is_read_or_refused_in_words(path: Path) -> None:
    whole, chance = path.read_bytes(), random.Random(2)
    for _ in range(300):
        broken = bytearray(whole)
        broken[chance.randrange(700)] = chance.randrange(256)
        path.write_bytes(bytes(broken))
        try:
            read_record(path)
        except RecordRefused as refused:
            assert '\n' not in str(refused)


def test_a_full_disk_ends_the_record_but_not_the_run(tmp_path: Path) -> None:
    simulation = new_simulation()
    said: list[str] = []
    recorder = RunRecorder(simulation, tmp_path / FILE_NAME, complain=said.append)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (30_000, limits[1]))
    try:
        drive(simulation, recorder, 1000)
        recorder.close()
        strict = RunRecorder(simulation, tmp_path / 'strict')
        with pytest.raises(OSError, match='File too large'):
            drive(simulation, strict, 1000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    (line,) = said
    assert 'File too large; the record of the run ends here' in line
    record = read_record(tmp_path)
    assert not record.complete
    assert len(record.rows) == 301


def test_a_record_that_cannot_be_written_is_refused_at_once(tmp_path: Path) -> None:
    (tmp_path / 'file').touch()
    for path in (tmp_path, tmp_path / 'file' / FILE_NAME):
        with pytest.raises(SettingError, match=r'record=.*cannot be written: '):
            open_recorder(new_simulation(), str(path), lambda _: None)


def test_a_record_takes_the_place_of_a_link_or_a_pipe(tmp_path: Path) -> None:
    victim, record = tmp_path / 'victim', tmp_path / FILE_NAME
    victim.write_text('mine')
    record.symlink_to(victim)
    RunRecorder(new_simulation(), record).close()
    assert victim.read_text() == 'mine'
    record.unlink()
    os.mkfifo(record)
    RunRecorder(new_simulation(), record).close()
    record.unlink()
    record.symlink_to(tmp_path / 'nowhere')
    RunRecorder(new_simulation(), record).close()
    assert not (tmp_path / 'nowhere').exists()
    assert not record.is_symlink()
    assert len(read_record(record).rows) == 1
