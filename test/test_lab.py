# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`./lab drive` and `./lab grade` as a person uses them: real launch, real nodes, a report."""

import json
import math
import os
from pathlib import Path
import re
import shutil
import signal
import sys
from typing import Any

from husky_course.record import COURSE_NAME, read_record, read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_grader.run.in_process import Conditions, drive_route
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from playpen_testing.keyboard import Keyboard
from playpen_testing.page_client import PageClient
from playpen_testing.processes import IN_A_TERMINAL, Process, Processes
from playpen_testing.shared_memory import left, own_files
from playpen_testing.waiting import wait_until
from playpen_testing.which_ros import lacks
import pytest
import rclpy

from husky_grader import drive_command

ROOT = Path(__file__).resolve().parent.parent
LAB = str(ROOT / 'lab')
FAST_DDS = 'rmw_fastrtps_cpp'  # the only one that puts messages into shared memory
REPORT_KEYS = {
    'completed', 'waypoints_reached', 'waypoints_total', 'collisions', 'cross_track_rms_m',
    'cross_track_max_m', 'min_clearance_m', 'path_length_m', 'driven_m', 'sim_time_sec',
    'wall_time_sec', 'trajectory_sha256', 'score',
}  # fmt: skip

pytestmark = pytest.mark.timeout(120)


def drive(processes: Processes, folder: Path, *options: str) -> Process:
    return processes.start(
        LAB, 'drive', '--no-view', '--report', str(folder), *options, cwd=folder
    )


def test_drive_ends_with_a_report_and_success(
    processes: Processes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('CI', 'true')  # where nobody is at the terminal
    run = processes.start(
        *(sys.executable, '-c', IN_A_TERMINAL, LAB),
        *('drive', '--fast', '--report', str(tmp_path)),
    )
    assert run.wait(timeout_sec=60.0) == 0, run.output
    assert re.search(r'\d0 %: +[\d.]+ m left', run.output), f'no progress:\n{run.output}'
    report = json.loads((tmp_path / 'report.json').read_text())
    assert set(report) >= REPORT_KEYS
    assert report['completed']
    assert report['collisions'] == []
    assert report['score'] > 0
    assert (tmp_path / 'report.html').read_text().startswith('<!DOCTYPE html>')
    assert (tmp_path / 'path.png').read_bytes().startswith(b'\x89PNG')
    driven = ROOT / 'config' / 'waypoints' / 'central_barrier.yaml'
    assert (tmp_path / COURSE_NAME).read_bytes() == driven.read_bytes()
    check_bag(processes, tmp_path)


def read_bag(path: Path) -> dict[str, list[tuple[int, Any]]]:
    """Return times and messages of each topic, read by the definitions that stand in the file."""
    read: dict[str, list[tuple[int, Any]]] = {}
    with path.open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages():
            read.setdefault(channel.topic, []).append((message.log_time, decoded))
    return read


def ask_ros2_bag(processes: Processes, path: Path) -> dict[str, int]:
    """Return how many messages of each topic `ros2 bag info` finds."""
    info = processes.start(LAB, 'exec', 'ros2', 'bag', 'info', str(path))
    assert info.wait(timeout_sec=30.0) == 0, info.output
    found = re.findall(r'Topic: (\S+) \| Type: \S+ \| Count: (\d+)', info.output)
    return {topic: int(count) for topic, count in found}


def count_messages(path: Path) -> dict[str, int]:
    """Return how many messages of each topic stand in a file, by its own index."""
    with path.open('rb') as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    assert summary.statistics is not None
    counts = summary.statistics.channel_message_counts
    return {each.topic: counts.get(number, 0) for number, each in summary.channels.items()}


def check_bag(processes: Processes, folder: Path) -> None:
    """Ask `ros2 bag` and MCAP's own reader what a drive has left, and compare with the record."""
    bag = folder / 'run.mcap'
    told = count_messages(bag) if lacks('ros2bag') else ask_ros2_bag(processes, bag)
    record = read_record(folder)
    assert told['/odometry/filtered'] == told['/tf'] == len(record.rows), told
    assert (told['/path'], told['/tf_static'], told['/collisions']) == (1, 1, 0)
    read = read_bag(bag)
    truth, tf = read['/ground_truth/odom'], read['/tf']
    assert len(read['/front/scan']) == math.ceil(len(record.rows) / 5)
    assert [ns for ns, _ in truth] == [round(sec * 1e9) for sec in record.time_sec.tolist()]
    for name, topic, value in (
        ('x', truth, lambda each: each.pose.pose.position.x),
        ('speed_m_s', truth, lambda each: each.twist.twist.linear.x),
        ('odom_y', tf, lambda each: each.transforms[0].transform.translation.y),
    ):
        assert [value(each) for _, each in topic] == record.column(0, name).tolist(), name
    (path,) = read['/path']
    assert path[1].header.frame_id == 'odom'
    assert len(path[1].poses) > 100
    rms_m = json.loads((folder / 'report.json').read_text())['cross_track_rms_m']
    errors = [each.data for _, each in read['/cross_track_error']]
    assert math.sqrt(sum(error**2 for error in errors) / len(errors)) < 1.1 * rms_m
    layout = (ROOT / 'config' / 'foxglove_layout.json').read_text()
    shown = {path.partition('.')[0] for path in re.findall(r'"(/[^"]+)"', layout)}
    assert shown <= set(told), 'the layout shows topics that the file lacks'
    panels = set(re.findall(r'"(?:first|second)": "([^"]+)"', layout))
    assert panels == set(json.loads(layout)['configById']), 'panels without a place'


def test_drive_fails_when_the_barrier_is_in_the_way(processes: Processes, tmp_path: Path) -> None:
    course = tmp_path / COURSE_NAME  # which is where the report keeps the one driven
    through = 'speed: 0.6\nwaypoints:\n  - [0.0, 0.0]\n  - [4.5, 0.0]\n'
    course.write_text(through)
    run = drive(processes, tmp_path, '--fast', COURSE_NAME, 'floor:=grass')
    assert run.wait(timeout_sec=60.0) == 1, run.output
    assert course.read_text() == through
    report = json.loads((tmp_path / 'report.json').read_text())
    assert not report['completed']
    assert report['collisions'][0]['obstacle'] == 'jersey_barrier_15'
    assert report['conditions'] == ['floor:=grass']


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (['floor:=gras'], 'floor:=gras is not allowed; allowed: one of ideal, asphalt'),
        (
            ['flor:=grass'],
            'flor does not exist; did you mean floor? allowed: battery, ',
        ),
        (['seed:=-1'], 'allowed: a whole number from 0'),
        (['realistic:=[1'], 'realistic:=[1 is not allowed; allowed: true or false'),
        (['seed:=!!timestamp x'], 'seed:=!!timestamp x is not allowed; allowed: a whole number'),
        (['seed:=' + '[' * 3000], 'allowed: a whole number from 0'),
        (['seed:=1:30'], 'seed:=1:30 is not allowed; allowed: a whole number from 0'),
        (['floor:='], 'floor:= is not allowed; allowed: one of ideal, asphalt'),
        (['\udcff.yaml'], '\\xff.yaml: ROS takes names in UTF-8 alone; rename it'),
        (['a.yaml', '--report', '\udcff'], '\\xff: ROS takes names in UTF-8 alone; rename it'),
        (['a.yaml', 'floor:=grass', 'b.yaml'], 'a.yaml and b.yaml: give one waypoint file'),
        (['a.yaml', '--fast', 'floor:=gras'], 'floor:=gras is not allowed; allowed: one of'),
        (['floor:=wet', '--fast', 'a.yaml', 'b'], 'a.yaml and b: give one waypoint file'),
    ],
)
def test_drive_refuses_what_it_does_not_know(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        drive_command.main(words)
    assert ended.value.code == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


def test_drive_hands_on_what_a_launch_reads() -> None:
    words = ['seed:=1_0', 'realistic:=TRUE', 'battery_charge:=.5', 'floor:=wet']
    assert drive_command._conditions(words) == {
        'seed': '10', 'realistic': 'true', 'battery_charge': '0.5', 'floor': 'wet',
    }  # fmt: skip


def test_drive_refuses_a_bad_file_before_anything_starts(
    processes: Processes, tmp_path: Path
) -> None:
    (tmp_path / 'bad.yaml').write_text('waypoints:\n  - [0, 0]\n  - [1, up]\n')
    run = drive(processes, tmp_path, '--waypoints', 'bad.yaml')
    assert run.wait(timeout_sec=30.0) == 2, run.output
    assert 'bad.yaml' in run.output
    assert 'line 3' in run.output
    assert 'process started' not in run.output
    assert 'Traceback' not in run.output


def test_the_same_file_gives_the_same_run_on_a_loaded_machine_or_edited_meanwhile(
    processes: Processes, tmp_path: Path, short_course: Path
) -> None:
    course = tmp_path / 'short.yaml'
    course.write_bytes(short_course.read_bytes())
    burners = [processes.start('bash', '-c', 'while :; do :; done') for _ in range(2)]
    run = drive(processes, tmp_path, '--fast', '--waypoints', str(course))
    run.wait_for_text('process started')
    course.write_text('what will be the next course')
    assert run.wait(timeout_sec=90.0) == 0, run.output
    for burner in burners:
        burner.signal(signal.SIGKILL)
    assert 'short: passed' in run.output
    graded = processes.start(LAB, 'grade', str(short_course), '--report', str(tmp_path / 'graded'))
    assert graded.wait(timeout_sec=60.0) == 0, graded.output
    (report,) = (tmp_path / 'graded').rglob('report.json')
    over_dds, in_one_process = (
        json.loads(path.read_text())['trajectory_sha256']
        for path in (tmp_path / 'report.json', report)
    )
    assert over_dds == in_one_process


def test_a_drive_under_other_conditions_is_the_one_of_one_process(
    processes: Processes, tmp_path: Path, short_course: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Nor does it matter what the terminal is for: OFF parts nodes, OSMesa is nowhere, and there
    # is no home to write to.
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
    monkeypatch.setenv('MUJOCO_GL', 'osmesa')
    no_home(monkeypatch, tmp_path)
    shown = processes.start(LAB, 'exec', 'printenv', 'ROS_LOG_DIR')
    assert shown.wait() == 0, shown.output
    assert shown.lines == [str(tmp_path / f'ros_log-{os.getuid()}')]
    words = ('floor:=grass', 'realistic:=true', 'battery:=true', 'interface:=clearpath')
    run = drive(processes, tmp_path, '--fast', *words, str(short_course))
    assert run.wait(timeout_sec=60.0) == 0, run.output
    assert 'Traceback' not in run.output
    over_dds = json.loads((tmp_path / 'report.json').read_text())['trajectory_sha256']
    route = plan_route(load_course(short_course))
    with_battery, without = (
        read_run(
            drive_route(route, conditions=Conditions('grass', realistic=True, battery=battery))[0]
        ).trajectory_sha256
        for battery in (True, False)
    )
    assert over_dds == with_battery != without


def test_a_full_disk_loses_the_report_not_the_result(
    processes: Processes, tmp_path: Path, short_course: Path
) -> None:
    # A limit of the size of each file stands in for the disk: enough for the course, not the rest.
    run = processes.start(
        *('bash', '-c', 'ulimit -f 8; exec "$@"', 'bash', LAB),
        *('drive', '--fast', '--no-view', '--report', str(tmp_path)),
        *('--waypoints', str(short_course)),
    )
    assert run.wait(timeout_sec=60.0) == 2, run.output
    assert 'the record of the run ends here: free some space' in run.output
    assert 'short: NOT PASSED' in run.output
    assert 'the report cannot be written: File too large; free some space' in run.output
    assert 'Traceback' not in run.output


def test_a_report_that_is_removed_during_its_drive_is_told(
    processes: Processes, tmp_path: Path, short_course: Path
) -> None:
    report = tmp_path / 'report'
    run = processes.start(
        *(LAB, 'drive', '--no-view', '--report', str(report), '--waypoints', str(short_course))
    )
    run.wait_for_text(' %', timeout_sec=40.0)
    shutil.rmtree(report)
    assert run.wait(timeout_sec=60.0) == 2, run.output
    assert f'lab drive: {report} was emptied, renamed or removed meanwhile' in run.output
    assert 'no simulator has started' not in run.output


def in_small_shared_memory(processes: Processes, *words: str | Path) -> Process:
    # Enough for one of the two nodes: Fast DDS then loses what the other sends, and says nothing.
    small = 'mount -t tmpfs -o size=1300k tmpfs /dev/shm && exec "$0" "$@"'
    unshare = ('unshare', '--map-root-user', '--mount', 'bash', '-c', small)
    return processes.start(*unshare, LAB, *map(str, words))


def test_shared_memory_that_is_too_small_for_a_run_is_refused(
    processes: Processes, tmp_path: Path, short_course: Path
) -> None:
    run = in_small_shared_memory(
        processes, 'drive', '--fast', '--no-view', '--report', tmp_path, short_course
    )
    refused = rclpy.get_rmw_implementation_identifier() == FAST_DDS
    assert run.wait(timeout_sec=60.0) == (2 if refused else 0), run.output
    said = 'lab drive: /dev/shm has less than 4 MB left, too few for the messages of a run: remove'
    assert [line for line in run.lines if line.startswith(said)] != [] or not refused, run.output


def test_a_simulator_and_a_grading_refuse_it_too(
    processes: Processes, tmp_path: Path, short_course: Path
) -> None:
    refused = rclpy.get_rmw_implementation_identifier() == FAST_DDS
    launch = ('ros2', 'launch', 'husky_sim', 'husky_playpen.launch.py')
    run = in_small_shared_memory(processes, 'exec', *launch)
    said = 'husky_sim: /dev/shm has less than 2 MB left, too few' if refused else '34 obstacles'
    run.wait_for_text(said, timeout_sec=60.0)
    driver = f'ros2 run husky_driver follow_path --waypoints {short_course}'
    given = ('--controller', driver, '--waypoints', short_course, '--report', tmp_path)
    grading = in_small_shared_memory(processes, 'grade', *given)
    assert grading.wait(timeout_sec=60.0) == (2 if refused else 0), grading.output
    said = '/dev/shm has less than 4 MB left, too few for the messages of a run: remove'
    assert grading.lines[-1].startswith(said) or not refused, grading.output


FILLED_MEANWHILE = """
mount -t tmpfs -o size=2300k tmpfs /dev/shm
"$0" exec ros2 run husky_sim husky_sim > "$2" 2>&1 &
until grep -q 'real time' "$2"; do sleep 0.1; done
head -c 1M /dev/zero > /dev/shm/filling
"$0" exec ros2 run husky_driver follow_path --waypoints "$1"
kill %1
wait
"""


def test_a_driver_names_shared_memory_that_was_filled_meanwhile(
    processes: Processes, tmp_path: Path, short_course: Path
) -> None:
    words = ('unshare', '--map-root-user', '--mount', 'bash', '-c', FILLED_MEANWHILE, LAB)
    run = processes.start(*words, str(short_course), str(tmp_path / 'simulator.log'))
    loses = rclpy.get_rmw_implementation_identifier() == FAST_DDS
    said = 'is silent; messages get lost where /dev/shm is full: remove' if loses else 'done: '
    run.wait_for_text(said, timeout_sec=60.0)
    run.wait(timeout_sec=30.0)


def no_home(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Let nothing be written at home; what is for a while goes into the folder."""
    for name in ('ROS_LOG_DIR', 'ROS_HOME'):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv('HOME', '/proc')
    monkeypatch.setenv('TMPDIR', str(folder))


def test_a_folder_of_logs_that_somebody_else_has_made_is_not_used(
    processes: Processes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    no_home(monkeypatch, tmp_path)
    (tmp_path / f'ros_log-{os.getuid()}').symlink_to(tmp_path)
    refused = processes.start(LAB, 'exec', 'true')
    assert refused.wait() == 2
    assert 'set ROS_LOG_DIR to a folder of your own' in refused.output


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_drive_leaves_nothing_behind(
    processes: Processes, tmp_path: Path, number: signal.Signals
) -> None:
    run = drive(processes, tmp_path)
    run.wait_for_text('10 %', timeout_sec=40.0)
    started = [int(line.split('pid [')[1].split(']')[0]) for line in run.lines if 'pid [' in line]
    assert len(started) >= 2, 'the simulator and the driver'
    shared = own_files(started)
    assert shared or rclpy.get_rmw_implementation_identifier() != FAST_DDS, 'no shared memory'
    os.kill(run.pid, number)  # to the script alone: it must hand it on
    assert run.wait(timeout_sec=2.5) in (128 + number, -number)
    assert [pid for pid in started if Path(f'/proc/{pid}').exists()] == []
    assert left(shared) == [], 'shared memory is left'


def test_one_word_runs_anything_in_the_environment(processes: Processes, tmp_path: Path) -> None:
    listed = processes.start(LAB, 'exec', 'ros2', 'pkg', 'list', cwd=tmp_path)
    assert listed.wait(timeout_sec=30.0) == 0
    assert {'husky_driver', 'husky_sim', 'topic_demo', 'rclpy'} <= set(listed.lines)
    wait_until(lambda: listed.returncode == 0, timeout_sec=1.0, what='exit status 0')
    asked = ('python3', '-c', 'import site; print(site.ENABLE_USER_SITE)')
    python = processes.start(LAB, 'exec', *asked, cwd=tmp_path)
    assert python.wait(timeout_sec=30.0) == 0
    assert python.lines == ['False'], 'what stands in ~/.local is imported too'


def test_what_is_said_where_nobody_listens_ends_no_program(processes: Processes) -> None:
    says = '"$0" exec sh -c "echo nobody listens >&2 && echo it goes on" 2>&-'
    run = processes.start('bash', '-c', says, LAB)
    assert (run.wait(timeout_sec=30.0), run.lines) == (0, ['it goes on'])


def test_a_folder_without_locks_is_no_hindrance(
    processes: Processes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    flock = tmp_path / 'flock'
    flock.write_text('#!/bin/sh\necho "flock: 9: No locks available" >&2\nexit 71\n')
    flock.chmod(0o755)
    monkeypatch.setenv('PATH', f'{tmp_path}:{os.environ["PATH"]}')
    run = processes.start(LAB, 'exec', 'echo', 'here')
    assert (run.wait(timeout_sec=30.0), run.lines) == (0, ['here'])


BROWSER = """#!{python}
import sys
sys.path[:0] = {path}
from playpen_testing.page_client import PageClient
with PageClient(sys.argv[1]) as tab:
    print('STOP' in tab.control('STOP')['props']['label'], file=open({seen!r}, 'w'), flush=True)
    open({end!r}).read()
"""


def test_a_drive_opens_its_page_first_and_replays_at_the_end(
    processes: Processes, tmp_path: Path, short_course: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen, end, browser = (tmp_path / name for name in ('seen', 'end', 'browser'))
    os.mkfifo(end)
    browser.write_text(
        BROWSER.format(python=sys.executable, path=sys.path, seen=str(seen), end=str(end))
    )
    browser.chmod(0o700)
    monkeypatch.setenv('BROWSER', str(browser))
    monkeypatch.delenv('CI', raising=False)
    run = processes.start(
        *(sys.executable, '-c', IN_A_TERMINAL, LAB),
        *('drive', str(short_course), '--open', '--report', str(tmp_path / 'my report')),
    )
    run.wait_for_text('(Ctrl-C ends)', timeout_sec=100.0)
    lines = [line.replace('\r', '') for line in run.lines]
    (live,) = [number for number, line in enumerate(lines) if '] look at ' in line]
    (opened,) = [number for number, line in enumerate(lines) if 'the page is open' in line]
    (started,) = [
        number for number, line in enumerate(lines) if '[follow_path-3]: process started' in line
    ]
    waited_sec = run.printed_sec[started] - run.printed_sec[live]
    # The launch may tell of the start before the line that caused it.
    assert opened <= started + 1 or waited_sec > 7.0, 'it waits for a tab, for up to 8 s'
    assert f"  see it again: ./lab view '{tmp_path / 'my report'}'" in lines[-2:]
    assert seen.read_text() == 'True\n'
    address = lines[-1].split('look at ')[1].split()[0]
    assert lines[live].endswith(address)
    with PageClient(address) as tab:
        report = json.loads((tmp_path / 'my report' / 'report.json').read_text())
        shown_sec = tab.control('Seconds')['props']['max']
        # It stands for a moment when it has arrived.
        assert 0.0 <= shown_sec - report['sim_time_sec'] < 1.0
    # The browser reads it still: it must outlive the drive.
    os.close(os.open(end, os.O_WRONLY | os.O_NONBLOCK))
    run.write('\x03')
    assert run.wait(timeout_sec=15.0) == 0, run.output
    assert 'interrupted' not in run.output
    assert 'Traceback' not in run.output


def test_who_debugs_a_test_can_type_into_it(tmp_path: Path) -> None:
    (tmp_path / 'test_mine.py').write_text(
        'def test_mine():\n    value = 20\n    breakpoint()\n    assert value\n'
    )
    keyboard = Keyboard(LAB, 'test', str(tmp_path))
    try:
        keyboard.wait_for_text('(Pdb)')
        keyboard.press('print(value * 2 + 1)\n')
        keyboard.wait_for_text('41')
        keyboard.press('continue\n')
        keyboard.wait_for_text('1 passed')
    finally:
        keyboard.close()
