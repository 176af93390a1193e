# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from concurrent.futures import Future
from contextlib import suppress
import csv
import hmac
import json
import multiprocessing
import os
from pathlib import Path
import signal
import subprocess
import sys
import tempfile
from typing import Any

from husky_grader.batch import key
from husky_grader.batch.batch import Batch, How
from husky_grader.batch.job import Outcome
from husky_grader.batch.key import key_of, MOST_BYTES
from husky_grader.batch.sealed import _make_secret
from husky_grader.batch.tables import names_of
from husky_grader.batch.temporary_folder import TemporaryFolder
from husky_grader.batch.workers import workers
from husky_grader.file_grading import Grade
from husky_grader.file_job import FileJob
from husky_grader.grade import main as grade
from playpen_testing.batch_jobs import Generated, Long, OwnEnd
from playpen_testing.waiting import wait_until
import pytest

HOURS = ''.join(f'  - {{x: -{k}.0, y: 0, dwell: 600}}\n' for k in (1, 2, 1, 2, 1, 2))
ONE = How(jobs=1)
SHORT = 'speed: 0.8\nwaypoints: [[0, 0], [-1, 0]]\n'


@pytest.fixture(autouse=True)
def state(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Keep the grader's secret away from the user's own."""
    folder = tmp_path_factory.mktemp('state')
    monkeypatch.setenv('XDG_STATE_HOME', str(folder))
    return folder


@pytest.fixture
def files(tmp_path: Path) -> list[str]:
    """Return three students' files of one name: good, broken, and through the barrier."""
    texts = {
        'ann': SHORT,
        'bob': 'speed: fast\nloop: yes\n',
        'cem': 'waypoints: [[0, 0], [3, 0]]\n',
    }
    for name, text in texts.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / 'path.yaml').write_text(text)
    return [str(tmp_path / name / 'path.yaml') for name in texts]


def graded(files: list[str], folder: Path, how: How = ONE) -> list[Grade]:
    """Grade files as `grade` does."""
    jobs = [FileJob(file, name) for file, name in zip(files, names_of(files), strict=True)]
    outcomes = Batch(jobs, folder, how=how).run()
    return [job.grade(outcome) for job, outcome in zip(jobs, outcomes, strict=True)]


def test_to_hand_out_files_loads_nothing_to_jail_them() -> None:
    script = 'import sys, husky_grader.grade, husky_grader.file_job; print(*sys.modules)'
    environment = {**os.environ, 'PYTHONPATH': ':'.join(sys.path)}
    command = [sys.executable, '-c', script]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    slow = {'husky_grader.jail', 'husky_grader.submission', 'jinja2', 'numpy.ma', 'psutil'}
    assert slow.isdisjoint(done.stdout.split())


def test_a_file_larger_than_memory_does_not_stop_the_others(
    files: list[str], tmp_path: Path
) -> None:
    with Path(files[1]).open('wb') as large:
        large.truncate(10**12)
    first, second, _ = graded(files, tmp_path / 'report')
    assert first.passed
    assert second.refused.endswith('larger than 100000 bytes; 1000 waypoints need less')


def test_a_large_file_that_has_changed_at_its_end_has_another_key(tmp_path: Path) -> None:
    large = tmp_path / 'large.yaml'
    large.write_bytes(bytes(MOST_BYTES + 1))
    before = key_of([large], {})
    assert key_of([large], {}) == before
    about = large.stat()
    with large.open('r+b') as stream:
        stream.seek(MOST_BYTES)
        stream.write(b'1')
    os.utime(large, ns=(about.st_atime_ns, about.st_mtime_ns + 1))
    assert key_of([large], {}) != before


def test_another_underlay_gives_another_key(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(key, 'UNDERLAY', tmp_path)
    monkeypatch.setattr(key, '_programs', key._programs.__wrapped__)  # as each call finds them
    keys = []
    for text in ('delay_sec = 1', 'delay_sec = 2', 'delay_sec = 1'):
        (tmp_path / 'launch.py').write_text(text)
        keys.append(key_of([], {}))
    assert keys[0] == keys[2] != keys[1]


def test_a_broken_file_does_not_stop_the_others(
    files: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert grade([*files, '--jobs', '1', '--report', str(tmp_path / 'report')]) == 1
    with (tmp_path / 'report' / 'grades.csv').open(newline='') as stream:
        rows = list(csv.DictReader(stream))
    assert [row['file'] for row in rows] == files
    assert [row['passed'] for row in rows] == ['True', 'False', 'False']
    assert float(rows[0]['score']) == 100.0
    assert 'waypoints: missing' in rows[1]['reasons']
    assert 'touched jersey_barrier_15' in rows[2]['reasons']
    assert (tmp_path / 'report' / 'ann_path' / 'report.html').is_file()
    table = capsys.readouterr().out.splitlines()
    assert table[0] == 'ann_path  100.0  passed'
    assert table[1].startswith('bob_path    0.0  refused     line 1, column 1: waypoints: missing')
    assert table[1].endswith('(and 2 more)')
    assert table[2].startswith('cem_path')


def test_what_was_graded_is_not_graded_again_until_it_changes(
    files: list[str], tmp_path: Path
) -> None:
    (first,) = graded(files[:1], tmp_path / 'report')
    report = tmp_path / 'report' / 'path' / 'report.json'
    written = report.stat().st_mtime_ns
    (second,) = graded(files[:1], tmp_path / 'report')
    assert second.report == first.report
    assert report.stat().st_mtime_ns == written
    Path(files[0]).write_text(SHORT.replace('-1', '-1.5'))
    (third,) = graded(files[:1], tmp_path / 'report')
    assert third.report is not None
    assert third.report['path_length_m'] == pytest.approx(1.5)
    Path(files[0]).write_text('speed: fast\n')
    (fourth,) = graded(files[:1], tmp_path / 'report')
    assert fourth.refused
    assert not report.with_name('report.html').exists()  # it would be of another file


def test_what_is_no_file_at_all_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / 'pipe.yaml')  # whoever opens it waits for ever
    (tmp_path / 'zero.yaml').symlink_to('/dev/zero')  # whoever reads it never ends
    (tmp_path / 'log.yaml').symlink_to('/proc/kmsg')  # a file, in which root waits for more
    names = ('pipe.yaml', 'zero.yaml', 'none.yaml', 'log.yaml')
    results = graded([str(tmp_path / name) for name in names], tmp_path / 'report')
    assert all('.yaml: not a file' in result.refused for result in results[:2])
    assert 'no such file' in results[2].refused
    assert results[3].refused


def test_a_class_that_is_interrupted_goes_on_where_it_was(tmp_path: Path) -> None:
    files = [tmp_path / f'student_{number}.yaml' for number in range(4)]
    for number, file in enumerate(files):
        file.write_text(SHORT.replace('-1', f'-{1 + number / 4}'))
    command = [sys.executable, '-m', 'husky_grader.grade', *map(str, files), '--jobs', '1']
    command += ['--report', str(tmp_path / 'report')]
    environment = {**os.environ, 'PYTHONPATH': ':'.join(sys.path)}
    with subprocess.Popen(
        command, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as running:
        assert running.stderr is not None
        assert running.stderr.readline() == '1 of 4  student_0 100.0\n'
        os.killpg(running.pid, signal.SIGINT)
        said = running.stderr.read()
        assert running.wait(timeout=10.0) == 130
    assert 'interrupted; the same command goes on where it was' in said
    assert 'Traceback' not in said
    assert not (tmp_path / 'report' / 'grades.csv').exists()
    first = tmp_path / 'report' / 'student_0' / 'report.json'
    written = first.stat().st_mtime_ns
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert [line.split()[:2] for line in done.stdout.splitlines()[:4]] == [
        [f'student_{number}', '100.0'] for number in range(4)
    ]
    assert first.stat().st_mtime_ns == written, 'it was graded twice'


def test_a_file_on_which_the_grader_hangs_costs_only_itself(
    files: list[str], tmp_path: Path
) -> None:
    # Of its own processor time, and no second of the run has passed.
    results = graded([files[2], files[0]], tmp_path, How(jobs=1, stalled_cpu_sec=0.001))
    why = 'the grader hung: 0.001 s of processor time without progress'
    assert [result.refused for result in results] == [why] * 2


def test_a_class_that_is_killed_hard_leaves_no_worker_and_no_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / 'temporary').mkdir()
    files = [tmp_path / f'student_{number}.yaml' for number in range(3)]
    for file in files:
        file.write_text('waypoints:\n  - [0, 0]\n' + HOURS)
    command = [sys.executable, '-m', 'husky_grader.grade', *map(str, files), '--jobs', '2']
    command += ['--report', str(tmp_path / 'report')]
    own = {'PYTHONPATH': ':'.join(sys.path), 'TMPDIR': str(tmp_path / 'temporary')}
    with subprocess.Popen(command, env={**os.environ, **own}, start_new_session=True) as running:
        records = (tmp_path / 'report' / f'student_{number}' / 'run.record' for number in (0, 1))
        for record in records:
            wait_until(record.exists, what=f'{record}', timeout_sec=20.0)
        running.kill()
        running.wait()
        wait_until(lambda: not living(running.pid), what='their end', timeout_sec=3.0)
    assert len(list((tmp_path / 'temporary').iterdir())) == 1
    monkeypatch.setattr(tempfile, 'tempdir', str(tmp_path / 'temporary'))
    of_another = TemporaryFolder()
    try:
        assert list((tmp_path / 'temporary').iterdir()) == [of_another.path]
        TemporaryFolder().remove()
        assert list((tmp_path / 'temporary').iterdir()) == [of_another.path], 'it is in use'
    finally:
        of_another.remove()


def test_a_worker_of_a_dead_grader_does_nothing(tmp_path: Path) -> None:
    (tmp_path / 'ann.yaml').write_text(SHORT)
    # The kernel tells it only of an end that is yet to come.
    (tmp_path / 'late.py').write_text(
        'import multiprocessing, os, pathlib, time\n'
        'from husky_grader.batch.workers import _serve\n'
        'from husky_grader.file_job import FileJob\n'
        'def late(pipe, place, grader):\n'
        '    while os.getppid() == grader:\n'
        '        time.sleep(0.001)\n'
        '    _serve(pipe, place)\n'
        'if __name__ == "__main__":\n'
        '    spawn = multiprocessing.get_context("spawn")\n'
        '    ours, its = spawn.Pipe()\n'
        '    process = spawn.Process(target=late, args=(its, ".", os.getpid()))\n'
        '    process.start()\n'
        '    ours.send((FileJob("ann.yaml", "ann"), pathlib.Path("report"), 60.0))\n'
        '    os._exit(0)\n'
    )
    environment = {**os.environ, 'PYTHONPATH': ':'.join(sys.path)}
    done = subprocess.run(  # which waits for the worker, too: it has the same output
        [sys.executable, 'late.py'],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=30.0,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, '', '')
    assert not (tmp_path / 'report').exists()


def living(session: int) -> list[str]:
    """Return the processes of a session that have not ended, as the kernel tells (proc(5))."""
    found = []
    for folder in Path('/proc').glob('[0-9]*'):
        with suppress(OSError):
            state, _, _, its_session, *_ = (folder / 'stat').read_text().rpartition(')')[2].split()
            if int(its_session) == session and state != 'Z':
                found.append(folder.name)
    return found


def test_names_that_lead_elsewhere_or_are_ours_break_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = [
        'grades.csv.yaml',
        '...yaml',
        '.yaml',
        'report.json.yaml',
        'a\nb\x1b[2J.yaml',
        'ok.yaml',
    ]
    (tmp_path / 'class').mkdir()
    for name in names:
        (tmp_path / 'class' / name).write_text('speed: fast\n' if name != 'ok.yaml' else SHORT)
    files = [str(tmp_path / 'class' / name) for name in names]
    assert grade([*files, '--jobs', '1', '--report', str(tmp_path / 'report')]) == 1
    with (tmp_path / 'report' / 'grades.csv').open(newline='') as stream:
        rows = list(csv.DictReader(stream))
    assert [row['passed'] for row in rows] == ['False'] * 5 + ['True']
    assert rows[4]['file'].endswith(r'a b\x1b[2J.yaml')
    assert {path.name for path in tmp_path.iterdir()} == {'class', 'report'}
    assert capsys.readouterr().out.count('refused     line 1, column 1: waypoints: missing') == 5


def test_every_file_has_a_folder_of_its_own() -> None:
    names = names_of(['x/a.yaml', 'y/a.yaml', 'x/a.yaml', 'x_a.yaml', 'X_A.yml', '/..yaml'])
    assert len({name.casefold() for name in names}) == 6
    assert all(name == Path(name).name and name.strip('.') for name in names)
    (long,) = names_of(['ü' * 120 + '.yaml'])
    assert len(long.encode()) <= 100


def test_a_forged_report_is_graded_again(files: list[str], tmp_path: Path) -> None:
    places = [tmp_path / f'path_{number}.yaml' for number in range(4)]
    for place in places:
        place.write_bytes(Path(files[2]).read_bytes())
    copies = list(map(str, places))
    (true, *others) = graded(copies, tmp_path / 'report')
    assert true.report is not None
    assert not any(result.passed for result in (true, *others))
    content = {**true.report, 'passed': True, 'score': 100.0, 'collisions': []}
    better = json.dumps(content, indent=2) + '\n'
    # As one who knows all but the secret would make it.
    its_key = FileJob(copies[3], 'path_3').key().encode()
    seal = hmac.new(b'', its_key + b'\n' + better.encode(), 'sha256').hexdigest()
    forged = (('{}', ''), ('[]', ''), (better, ''), (better, seal))
    for place, (text, its_seal) in zip(places, forged, strict=True):
        folder = tmp_path / 'report' / place.stem
        (folder / 'report.json').write_text(text)
        if its_seal:
            (folder / '.graded').write_text(its_seal)
    results = graded(copies, tmp_path / 'report')
    assert [(result.score, result.passed) for result in results] == [(true.score, False)] * 4


def test_the_secret_is_only_the_users(tmp_path: Path, state: Path) -> None:
    job = Generated('job')
    (first,) = Batch([job], tmp_path, how=ONE).run()
    (secret,) = (path for path in state.rglob('*') if path.is_file())
    assert secret.stat().st_mode & 0o777 == 0o600
    before = secret.read_bytes()
    secret.chmod(0o644)  # others may have read it
    (second,) = Batch([job], tmp_path, how=ONE).run()
    assert second == first == Outcome(job.content())  # done again
    assert secret.read_bytes() != before
    assert secret.stat().st_mode & 0o777 == 0o600


def test_graders_that_find_no_secret_at_once_have_one(tmp_path: Path) -> None:
    file = tmp_path / 'state' / 'secret'
    secrets = [_make_secret(file) for _ in range(2)]  # each has looked before
    assert secrets == [file.read_bytes()] * 2
    file.chmod(0o644)  # others can read it
    assert _make_secret(file) != secrets[0]
    assert list(file.parent.iterdir()) == [file]


def test_where_no_secret_can_be_kept_everything_is_graded_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / 'file').touch()
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path / 'file'))
    job, report, times = Generated('job'), tmp_path / 'report', []
    for _ in range(2):
        (outcome,) = Batch([job], report, how=ONE).run()
        assert outcome == Outcome(job.content())
        times.append((report / 'job' / 'result.json').stat().st_mtime_ns)
    assert times[0] != times[1]
    assert not (report / 'job' / '.graded').exists()


@pytest.mark.parametrize('limit_bytes', [20_000, 30_000])
def test_a_full_disk_gives_one_line_and_the_table(
    files: list[str], tmp_path: Path, limit_bytes: int
) -> None:
    limited = (
        'import resource, sys\n'
        f'resource.setrlimit(resource.RLIMIT_FSIZE, ({limit_bytes}, {limit_bytes}))\n'
        'from husky_grader.grade import main\n'
        'if __name__ == "__main__":\n'
        '    sys.exit(main(sys.argv[1:]))\n'
    )
    (tmp_path / 'limited.py').write_text(limited)
    command = [sys.executable, str(tmp_path / 'limited.py'), *files, '--jobs', '1']
    command += ['--report', str(tmp_path / 'report')]
    environment = {**os.environ, 'PYTHONPATH': ':'.join(sys.path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 2
    assert 'Traceback' not in done.stderr
    table = done.stdout.splitlines()
    assert table[0].startswith('ann_path    0.0  not graded  its report cannot be written: File')
    assert table[1].startswith('bob_path    0.0  refused')
    (line,) = (line for line in done.stderr.splitlines() if 'make room, on the disk' in line)
    assert 'its report cannot be written: File too large' in line


def test_workers_that_die_as_soon_as_they_begin_cost_their_jobs_only(tmp_path: Path) -> None:
    ends = (signal.SIGSEGV, 0, signal.SIGKILL, 0)
    jobs = [OwnEnd(f'{number}', by=ends[number % 4]) for number in range(16)]
    with workers(2) as start:
        outcomes = [future.result(30.0) for future in [start(job, tmp_path) for job in jobs]]
    assert [outcome.content is None for outcome in outcomes] == [bool(job.by) for job in jobs]
    # The kernel ends it where memory runs out: no fault of who handed in, and the line says so.
    assert {(outcome.refused, outcome.undone) for outcome in outcomes} == {
        ('', False),
        ('the grader itself crashed on this one', False),
        ('its grading was ended by SIGKILL, as by the kernel where memory runs out', True),
    }


def test_a_worker_that_dies_between_two_jobs_costs_none(tmp_path: Path) -> None:
    with workers(1) as start:
        processes = [process_of(start(OwnEnd('job'), tmp_path))]
        os.kill(processes[0], signal.SIGKILL)
        stat = Path(f'/proc/{processes[0]}/stat')
        wait_until(lambda: ') Z ' in stat.read_text(), what='its end', timeout_sec=20.0)
        processes += [process_of(start(OwnEnd('job'), tmp_path))]
    assert processes[0] != processes[1]


def test_a_second_ctrl_c_leaves_no_worker_and_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kill = multiprocessing.context.SpawnProcess.kill

    def kill_amid(process: Any) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        kill(process)

    def interrupted(files: list[Path]) -> None:
        with workers(2) as start:
            for file in files:
                start(Long(file.stem), tmp_path)
            wait_until(
                lambda: all(file.is_file() and file.stat().st_size for file in files),
                timeout_sec=20.0,
                what='two',
            )
            monkeypatch.setattr('multiprocessing.context.SpawnProcess.kill', kill_amid)
            os.kill(os.getpid(), signal.SIGINT)

    files = [tmp_path / f'{number}.pid' for number in range(2)]
    with pytest.raises(KeyboardInterrupt):
        interrupted(files)
    told = [file.read_text().split() for file in files]
    assert [process for process, _ in told if Path('/proc', process).exists()] == []
    assert [folder for _, folder in told if Path(folder).exists()] == []


def process_of(future: 'Future[Outcome]') -> int:
    """Return the process that did a job."""
    outcome = future.result(30.0)
    assert outcome.content is not None, outcome.refused
    return int(outcome.content['process'])


@pytest.mark.skipif(sys.version_info < (3, 11), reason='Python cannot be told before 3.11')
def test_no_module_of_the_folder_it_is_called_from_is_run(
    files: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ran = tmp_path / 'ran'
    (tmp_path / 'multiprocessing.py').write_text(
        f"import pathlib\npathlib.Path({str(ran)!r}).touch()\nraise SystemExit('mine')\n"
    )
    monkeypatch.chdir(tmp_path)
    (only,) = graded(files[:1], tmp_path / 'report')
    assert not ran.exists()
    assert only.passed


def test_files_of_one_name_are_told_apart_by_their_folders() -> None:
    assert names_of(['a.yaml', 'b.yaml']) == ['a', 'b']
    assert names_of(['ann/p.yaml', 'bob/p.yaml']) == ['ann_p', 'bob_p']
    assert names_of(['x/ann/w/p.yaml', 'x/bob/w/p.yaml']) == ['ann_w_p', 'bob_w_p']
    # Those above tell nothing here.
    assert names_of(['w/a.yaml', 'w/b.yaml', 'w/a.yml']) == ['a', 'b', 'a_2']
