# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A class in shares, on a cluster, and killed: the table is that of one call."""

from collections.abc import Iterator
from contextlib import ExitStack, redirect_stdout
from dataclasses import dataclass
import io
import json
import os
from pathlib import Path
import random
import shutil
import signal
import subprocess
import sys
from tempfile import TemporaryDirectory
import time

from husky_grader.batch.batch import Batch, How
from husky_grader.batch.sealed import Seals
from husky_grader.batch.shards import parse_shard, Shard
from husky_grader.grade import main as grade
from husky_grader.playpen import config_folder
from playpen_testing.batch_jobs import Generated
from playpen_testing.processes import Child
from playpen_testing.waiting import wait_until
import pytest

BUILD = 'title: T\nsteps:\n  - {kind: build, points: 10}\n'
SHORT = 'speed: 0.8\nwaypoints: [[0, 0], [-%g, 0]]\n'
ONE = ['--jobs', '1']  # a worker takes longer to start than these files


@pytest.fixture(scope='module', autouse=True)
def state(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Keep the grader's secret away from the user's own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('XDG_STATE_HOME', str(tmp_path_factory.mktemp('state')))
        yield


@dataclass(frozen=True)
class Serial:
    """What one call has made of students' files."""

    files: list[str]
    printed: list[str]  # a line each
    csv: str


@pytest.fixture(scope='module')
def serial(tmp_path_factory: pytest.TempPathFactory) -> Serial:
    """Return the grades of seven files; one of them is refused."""
    folder = tmp_path_factory.mktemp('serial')
    places = [folder / f's{number}.yaml' for number in range(7)]
    for number, place in enumerate(places):
        place.write_text(SHORT % (0.3 + number / 10) if number != 4 else 'speed: fast\n')
    files = list(map(str, places))
    out = io.StringIO()
    with redirect_stdout(out):
        assert grade([*files, *ONE, '--report', str(folder / 'report')]) == 1
    return Serial(files, out.getvalue().splitlines()[:7], tables(folder / 'report'))


@pytest.fixture(scope='module')
def first_two(serial: Serial, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the report on the first two files, as of a shard; a test changes a copy of it."""
    report = tmp_path_factory.mktemp('first_two') / 'report'
    assert grade([*serial.files[:2], *ONE, '--report', str(report)]) == 0
    return report


def test_10000_results_in_shards_that_died_are_the_serial_ones(tmp_path: Path) -> None:
    jobs = [Generated(f's{number:05}') for number in range(10_000)]
    chance, shards, seals = random.Random(13), range(1, 101), Seals()
    dead = set(chance.sample(shards, 5))
    for number in shards:
        share = Shard(number, 100).of(jobs)
        left = chance.randrange(len(share)) if number in dead else len(share)
        for job in share[:left]:
            job.run(tmp_path / f'shard_{number}' / job.name, lambda: None)
            seals.seal(tmp_path / f'shard_{number}' / job.name, job, job.key())
        if number in dead:  # in the middle of a job: a result without its seal
            share[left].run(tmp_path / f'shard_{number}' / share[left].name, lambda: None)
    folders = tuple(tmp_path / f'shard_{number}' for number in shards)
    outcomes = Batch(jobs, tmp_path / 'all', how=How(collect=folders)).run()
    assert [outcome.content for outcome in outcomes] == [job.content() for job in jobs]
    assert not list((tmp_path / 'all').glob('.*.part'))


def test_the_files_of_collected_shards_are_those_of_one_call(
    serial: Serial, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = [*serial.files, *ONE, '--report']
    folders = [str(tmp_path / f'shard_{number}') for number in (1, 2, 3)]
    Path(folders[1]).mkdir()  # the second one never began
    for number in (1, 3):
        grade([*command, folders[number - 1], '--shard', f'{number}/3'])
    capsys.readouterr()
    assert grade([*command, str(tmp_path / 'all'), '--collect', *folders]) == 1
    told = capsys.readouterr()
    assert told.out.splitlines()[:7] == serial.printed
    assert f'--collect: no result is in (1): {folders[1]}; give what' in told.err
    assert tables(tmp_path / 'all') == serial.csv
    took = tmp_path / 'all' / 's0' / 'report.json'
    assert took.stat().st_mtime_ns == (tmp_path / 'shard_1/s0/report.json').stat().st_mtime_ns


def test_a_collected_report_takes_nothing_of_a_person(
    serial: Serial, first_two: Path, tmp_path: Path
) -> None:
    (own := tmp_path / 'all' / 's0').mkdir(parents=True)
    (own / 'notes.txt').write_text('called me on Monday')
    (own / 'path.png').write_text('of an earlier drive')
    report = ['--report', str(tmp_path / 'all')]
    grade([*serial.files[:2], *ONE, *report, '--collect', str(first_two)])
    assert (own / 'notes.txt').read_text() == 'called me on Monday'
    collected = {path.name for path in (first_two / 's0').iterdir()}
    assert {path.name for path in own.iterdir()} == {*collected, 'notes.txt'}


def test_a_report_that_cannot_be_copied_is_told_in_a_line(
    serial: Serial, first_two: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shard, report = tmp_path / 'shard', tmp_path / 'all'
    shutil.copytree(first_two, shard)
    os.mkfifo(shard / 's0' / 'pipe')
    command = [*serial.files[:2], *ONE, '--report', str(report), '--collect', str(shard)]
    capsys.readouterr()
    assert grade(command) == 2
    told = f'--collect: {shard / "s0"} cannot be copied to {report / "s0"}: `{shard}/s0/pipe` is a'
    assert capsys.readouterr().err.splitlines()[-1].startswith(told)
    (shard / 's0' / 'pipe').unlink()
    assert grade(command) == 0


@pytest.mark.timeout(60)
def test_to_collect_what_was_graded_takes_no_sandbox(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (rubric := tmp_path / 'rubric.yaml').write_text(BUILD)
    handed_in, shard, report = (tmp_path / name for name in ('handed_in', 'shard', 'all'))
    for name in ('ann', 'bob'):
        (handed_in / name / 'src').mkdir(parents=True)
    (handed_in / 'ann' / 'src' / 'package.xml').write_text('<package/>')
    command = ['--lab', str(handed_in), '--rubric', str(rubric), *ONE, '--report']
    grade([*command, str(shard)])
    shutil.copytree(handed_in / 'ann', handed_in / 'cem')  # handed in late
    (programs := tmp_path / 'bin').mkdir()
    for name in ('chmod', 'rm'):
        (programs / name).symlink_to(shutil.which(name) or '')
    monkeypatch.setenv('PATH', str(programs))
    assert grade([*command, str(report), '--collect', str(shard)]) == 1
    ann, bob, cem = json.loads((report / 'grades.json').read_text())['submissions']
    before = json.loads((shard / 'grades.json').read_text())['submissions']
    assert [ann, bob] == before
    assert (ann['refused'], bob['refused']) == (None, before[1]['refused'])
    assert 'cem: cannot be graded: no sandbox works here (bwrap: ' in cem['refused']


def tables(report: Path) -> str:
    return (report / 'grades.csv').read_text()


def test_a_forged_shard_is_graded_again(
    serial: Serial, first_two: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shard, files = tmp_path / 'shard', serial.files
    shutil.copytree(first_two, shard)
    report = shard / 's0' / 'report.json'
    report.write_text(report.read_text().replace('"score": 100.0', '"score": 101.0'))
    assert '101.0' in report.read_text()
    everything = ['--report', str(tmp_path / 'all'), '--collect', str(shard)]
    grade([*files[:2], *ONE, *everything])
    assert ',101.0,' not in tables(tmp_path / 'all')
    assert 'MuJoCo or numpy, or have been changed since' in capsys.readouterr().err


@pytest.mark.parametrize('text', ['0/3', '4/3', '1', '1/0', '1/-3', '1/3/3', 'a/b', '1.0/3', ''])
def test_what_is_no_shard_is_refused(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ValueError, match='give I/N'):
        parse_shard(text)
    if text:
        with pytest.raises(SystemExit, match='2'):
            grade(['a.yaml', '--shard', text])
        assert 'give I/N' in capsys.readouterr().err


def test_a_shard_may_be_empty(serial: Serial, tmp_path: Path) -> None:
    command = [*serial.files, '--report', str(tmp_path / 'report'), '--shard']
    assert grade([*command, '8/9']) == 0
    rubric = ['--rubric', str(config_folder() / 'rubrics' / 'path.yaml')]
    assert grade(['--lab', serial.files[0], *rubric, *command[-3:], '2/2']) == 0
    assert 'Nobody is in this share' in (tmp_path / 'report' / 'class.html').read_text()
    # The only file of a class is in its first share alone, and has a folder as in any class.
    for number, folders in ((2, []), (1, ['s0'])):
        report = tmp_path / f'share {number}'
        assert grade([serial.files[0], '--report', str(report), '--shard', f'{number}/2']) == 0
        assert [path.name for path in report.iterdir() if path.is_dir()] == folders
        assert len(tables(report).splitlines()) == 1 + len(folders)


@pytest.mark.parametrize('count', [1, 2, 7, 12, 30])
def test_shards_together_are_all_jobs_once(count: int) -> None:
    shares = [Shard(number, count).of(range(12)) for number in range(1, count + 1)]
    assert sorted(job for share in shares for job in share) == list(range(12))


def test_a_secret_that_is_too_short_is_refused(
    serial: Serial,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv('HUSKY_GRADING_SECRET', 'short')
    assert grade([*serial.files, '--report', str(tmp_path / 'report')]) == 2
    assert 'HUSKY_GRADING_SECRET has 5 characters; give 32 or more' in capsys.readouterr().err


def test_machines_that_share_a_secret_take_results_of_each_other(
    serial: Serial,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    times, told, files, there = {}, {}, serial.files, tmp_path / 'there'
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path / 'state of one'))
    monkeypatch.setenv('HUSKY_GRADING_SECRET', 'a' * 32)
    grade([*files[:2], *ONE, '--report', str(there)])
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path / 'state of another'))
    for secret in ('a' * 32, 'b' * 32):
        monkeypatch.setenv('HUSKY_GRADING_SECRET', secret)
        here = tmp_path / f'here {secret[0]}'
        capsys.readouterr()
        grade([*files[:2], *ONE, '--report', str(here), '--collect', str(there)])
        written = [folder / 's0' / 'report.json' for folder in (there, here)]
        told[secret[0]] = capsys.readouterr().err
        times[secret[0]] = [path.stat().st_mtime_ns for path in written]
    assert times['a'][0] == times['a'][1]
    assert times['b'][0] != times['b'][1]
    assert 'not taken' not in told['a']
    line = '--collect: not taken, and graded here again (2): s0, s1: their results were sealed '
    assert line in told['b']


def test_a_grader_killed_at_ten_moments_comes_to_the_same_table(
    serial: Serial, tmp_path: Path
) -> None:
    command = [sys.executable, '-m', 'husky_grader.grade', *serial.files, '--jobs', '2']
    command += ['--report', str(tmp_path / 'killed')]
    # What it leaves when it is killed goes with the test.
    environment = {**os.environ, 'PYTHONPATH': ':'.join(sys.path), 'TMPDIR': str(tmp_path)}
    chance = random.Random(2026)
    for _ in range(10):
        with subprocess.Popen(
            command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        ) as running:
            time.sleep(chance.uniform(0.1, 1.2))  # a moment, not a fact that is waited for
            running.kill()
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 1, done.stderr
    assert tables(tmp_path / 'killed') == serial.csv


@pytest.fixture
def dask() -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """Yield the address of a Dask scheduler, and two workers of its."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(TemporaryDirectory()))
        environment = {**os.environ, 'PYTHONPATH': ':'.join(sys.path), 'TMPDIR': str(folder)}
        file = folder / 'scheduler.json'

        def start(*words: str) -> subprocess.Popen[bytes]:
            process = subprocess.Popen(
                [sys.executable, '-m', 'distributed.cli.' + words[0], *words[1:]],
                env=environment,
                cwd=folder,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            stack.enter_context(process)
            stack.callback(process.kill)
            return process

        where = ['--scheduler-file', str(file)]
        plain = ['--host', '127.0.0.1', '--no-dashboard']
        start('dask_scheduler', *plain, '--port', '0', *where)
        workers = [
            start('dask_worker', *plain, '--no-nanny', '--nthreads', '1', *where) for _ in range(2)
        ]
        wait_until(
            lambda: file.is_file() and file.read_text().rstrip().endswith('}'),
            timeout_sec=30.0,
            what='the scheduler',
        )
        yield json.loads(file.read_text())['address'], workers


@pytest.mark.timeout(180)
def test_a_cluster_that_loses_a_worker_has_the_same_table(
    serial: Serial, tmp_path: Path, dask: tuple[str, list[subprocess.Popen[bytes]]]
) -> None:
    address, workers = dask
    command = [sys.executable, '-m', 'husky_grader.grade', *serial.files[:5]]
    command += ['--executor', f'dask:{address}', '--report', str(tmp_path / 'cluster')]
    environment = {**os.environ, 'PYTHONPATH': ':'.join(sys.path)}
    pipe = subprocess.PIPE
    with Child(command, env=environment, stdout=pipe, stderr=pipe) as running:
        assert running.stderr is not None
        first = running.stderr.readline()
        assert ' of 5 ' in first, first + running.stderr.read()
        workers[0].send_signal(signal.SIGKILL)
        printed, said = running.communicate(timeout=120.0)
    assert running.returncode == 1, said
    assert printed.splitlines()[:5] == serial.printed[:5]
    assert tables(tmp_path / 'cluster').splitlines() == serial.csv.splitlines()[:6]


def test_where_no_cluster_answers_one_line_says_so(
    serial: Serial,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr('husky_grader.batch.dask_cluster.CONNECT_WITHIN_SEC', 0.5)
    command = [*serial.files, '--report', str(tmp_path / 'report')]
    assert grade([*command, '--executor', 'dask:tcp://127.0.0.1:9']) == 2
    (line,) = (line for line in capsys.readouterr().err.splitlines() if 'dask:' in line)
    assert 'start one: ./lab exec dask scheduler' in line

    def connects(**_: object) -> None:
        pytest.fail('a client with such an address ends after 40 s, with a traceback')

    monkeypatch.setattr('distributed.Client', connects)
    assert grade([*command, '--executor', 'dask:127.0.0.1']) == 2
    assert 'dask:127.0.0.1: missing port number in address' in capsys.readouterr().err
