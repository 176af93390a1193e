# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A jail ends what runs in it, and holds it to its limits, in every sandbox that works here."""

from collections.abc import Iterator
from contextlib import contextmanager, ExitStack
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import time

from husky_grader.jail import find_sandbox, Jail, Limits, NoSandbox, Sandbox
from husky_grader.lab.build_step import MAX_VARIABLES
from playpen_testing.jails import (
    as_ordinary_user,
    in_each_of_namespaces,
    in_each_sandbox,
    in_each_way,
    in_each_way_with_processes,
    in_each_with_network,
    in_that_of_the_kernel,
    running,
)
from playpen_testing.waiting import wait_until
import pytest

# Each program is followed by its mark, by which it is found from outside.
SLEEPING = 'import time; print("here", flush=True); time.sleep(600)'
TERMINAL = """
import os
asked, given = os.openpty()
os.write(given, os.isatty(given) * b'is a terminal')
print(os.read(asked, 100).decode(), flush=True)
"""
DEAF = f'import signal; [signal.signal(n, signal.SIG_IGN) for n in (1, 2, 15)]; {SLEEPING}'
CLOSING = f"""
try:
    {SLEEPING}
except KeyboardInterrupt:
    print('closed', flush=True)
"""
# Neither its session, its parent, its environment nor its open files tell where it comes from.
DAEMON = f"""
import os, sys
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        os.closerange(0, 99)
        os.execve(sys.executable, [sys.executable, '-c', {SLEEPING!r}, sys.argv[1]], {{}})
    os._exit(0)
os.wait()
"""
FORKS = 'import os\nwhile True:\n    try: os.fork()\n    except OSError: pass'
EATS = """
import os, time
for _ in range(4):
    if os.fork() == 0:
        eaten = b'x' * 60_000_000
        time.sleep(600)
time.sleep(600)
"""
HIDES = """
import os, time
hoard = [os.memfd_create('hoard') for _ in range(4)]
for file in hoard:
    os.write(file, bytes(60_000_000))
time.sleep(600)
"""
REMOVES = """
import tempfile, time
hoard = [tempfile.TemporaryFile(dir='.') for _ in range(4)]
for file in hoard:
    file.write(bytes(2_000_000))
    file.flush()
time.sleep(600)
"""
FILLS = """
import ctypes, os, select, time
libc = ctypes.CDLL(None)
file = os.open('file', os.O_CREAT | os.O_RDWR)
looks = libc.inotify_init1(0)
libc.inotify_add_watch(looks, b'.', 0x20)  # IN_OPEN, of the folder
for _ in range(6):
    os.read(looks, 1000)
    time.sleep(0.1)
    while select.select([looks], [], [], 0)[0]:
        os.read(looks, 1000)
    os.posix_fallocate(file, 0, 50_000_000)
    time.sleep(0.5)
    os.ftruncate(file, 0)
"""
GRADER = """
import os, sys, time
import os
from pathlib import Path
from husky_grader.jail import find_sandbox, Jail
from husky_runtime.children import ChildProcess
name, folder, mark = sys.argv[1:]
sleeping = [sys.executable, '-c', 'import time; print("here", flush=True); time.sleep(600)', mark]
with Jail(find_sandbox(name), Path(folder)) as jail:
    with Path(folder + '_beside.log').open('w') as log:
        ChildProcess(jail.beside(sleeping), os.environ, log)
    print('ready', flush=True)
    jail.run(sleeping, log=Path(folder + '.log'), within_sec=600.0)
"""

ORDINARY = """
import sys
import os
from pathlib import Path
from husky_grader.jail import find_sandbox, Jail
name, folder, log = sys.argv[1:]
show = 'id -u; grep CapEff /proc/self/status; touch here; touch /usr/here'
with Jail(find_sandbox(name), Path(folder)) as jail:
    assert jail.run(['bash', '-c', show], log=Path(log), within_sec=20.0) == 1
"""


@pytest.fixture
def mark(tmp_path: Path) -> Iterator[str]:
    """Return a word to start programs with; at last none of those may be there."""
    yield str(tmp_path)
    assert running(str(tmp_path)) == []


@contextmanager
def jail_in(sandbox: Sandbox, place: Path, limits: Limits | None = None) -> Iterator[Jail]:
    folder = place / 'folder'
    folder.mkdir()
    with Jail(sandbox, folder, limits=limits or Limits()) as jail:
        yield jail


def python(text: str, *words: str) -> list[str]:
    return [sys.executable, '-c', text, *words]


def has_said(log: Path, text: str) -> None:
    wait_until(
        lambda: log.is_file() and text in log.read_text(),
        timeout_sec=10.0,
        what=f'{text} in {log.name}',
    )


@in_each_way
def test_an_exit_code_a_signal_and_a_missing_program_are_told(
    sandbox: Sandbox, tmp_path: Path
) -> None:
    log = tmp_path / 'log'
    with jail_in(sandbox, tmp_path) as jail:
        assert jail.run(['bash', '-c', 'exit 3'], log=log, within_sec=10.0) == 3
        assert jail.run(['bash', '-c', 'kill -SEGV $$'], log=log, within_sec=10.0) == -11
        assert jail.run(['sleep', '600'], log=log, within_sec=0.3) is None
        assert jail.run(['no_such_program'], log=log, within_sec=10.0) == 127
    assert re.search('no_such_program.?: No such file or directory', log.read_text())


@in_each_way
def test_input_and_variables_reach_the_command(
    sandbox: Sandbox, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('GRADER_TOKEN', 'secret')
    log, show = tmp_path / 'log', ['bash', '-c', 'read -r line; echo $line $GIVEN $GRADER_TOKEN ~']
    with jail_in(sandbox, tmp_path) as jail:
        process = jail.start(show, {'GIVEN': 'a word'}, log=log, answers='an answer\n')
        assert process.wait(10.0)
    assert log.read_text() == f'an answer a word {tmp_path}/folder/home\n'


@in_each_way
def test_all_variables_that_a_build_may_set_reach_the_command(
    sandbox: Sandbox, tmp_path: Path
) -> None:
    text = '\udcff' * (MAX_VARIABLES - 100)  # a byte that is no UTF-8: three as Python writes it
    log, count = tmp_path / 'log', ['bash', '-c', 'LC_ALL=C; echo ${#MUCH}']
    with jail_in(sandbox, tmp_path) as jail, jail.started(count, {'MUCH': text}, log=log) as run:
        assert run.wait(10.0)
    assert int(log.read_text()) == len(text)


@in_each_way
def test_a_grader_may_keep_its_files_to_itself(sandbox: Sandbox, tmp_path: Path) -> None:
    log, before = tmp_path / 'log', os.umask(0o077)
    try:
        with jail_in(sandbox, tmp_path) as jail:
            write = ['bash', '-c', 'touch here && umask']
            exit_code = jail.run(write, log=log, within_sec=10.0)
    finally:
        os.umask(before)
    assert (exit_code, log.read_text()) == (0, '0077\n')


@in_each_way
def test_a_program_may_open_a_terminal_of_its_own(sandbox: Sandbox, tmp_path: Path) -> None:
    log = tmp_path / 'log'
    with jail_in(sandbox, tmp_path) as jail:
        exit_code = jail.run(python(TERMINAL), log=log, within_sec=10.0)
    assert (exit_code, log.read_text()) == (0, 'is a terminal\n')


@in_each_way
def test_a_daemon_ends_with_the_run(sandbox: Sandbox, tmp_path: Path, mark: str) -> None:
    with jail_in(sandbox, tmp_path) as jail:
        exit_code = jail.run(python(DAEMON, mark), log=tmp_path / 'log', within_sec=10.0)
        assert (exit_code, running(mark)) == (0, [])


@in_each_way_with_processes
def test_what_may_close_closes_and_what_is_deaf_is_killed(
    sandbox: Sandbox, tmp_path: Path, mark: str
) -> None:
    logs = {'closing': tmp_path / 'closing', 'deaf': tmp_path / 'deaf'}
    with jail_in(sandbox, tmp_path) as jail:
        closing = jail.start(python(CLOSING, mark), log=logs['closing'])
        deaf = jail.start(python(DEAF, mark), log=logs['deaf'])
        has_said(logs['closing'], 'here')
        has_said(logs['deaf'], 'here')
        closing.end(within_sec=20.0)
        assert (closing.exit_code, deaf.exit_code) == (0, None)
        assert logs['closing'].read_text() == 'here\nclosed\n'
        begun = time.monotonic()
        deaf.end(within_sec=0.5)
        assert time.monotonic() - begun < 2.0
        assert deaf.exit_code == -signal.SIGKILL


@in_each_sandbox
def test_a_fork_bomb_stays_in_its_jail(sandbox: Sandbox, tmp_path: Path, mark: str) -> None:
    limits = Limits(tasks=50)
    with jail_in(sandbox, tmp_path, limits) as jail:
        bomb = jail.start(python(FORKS, mark), log=tmp_path / 'log')
        wait_until(lambda: len(running(mark)) > 20, timeout_sec=10.0, what='a fork')
        most = max(len(running(mark)) for _ in range(3))
        bomb.kill()
    assert most <= 60
    assert running(mark) == []


@pytest.mark.parametrize('program', [EATS, HIDES], ids=['in processes', 'in nameless files'])
@in_each_way_with_processes
def test_memory_over_its_limit_ends_only_who_took_it(
    sandbox: Sandbox, tmp_path: Path, mark: str, program: str
) -> None:
    with jail_in(sandbox, tmp_path, Limits(memory_mb=150)) as jail:
        other = jail.start(python(SLEEPING, mark), log=tmp_path / 'other')
        eater = jail.start(python(program, mark), log=tmp_path / 'log')
        assert eater.wait(10.0)
        assert other.exit_code is None
    assert eater.exit_code == -signal.SIGKILL
    assert 'MB of memory; 150 MB are allowed' in eater.stopped
    assert f'[ended by the grader: it {eater.stopped}]' in (tmp_path / 'log').read_text()


@in_each_way_with_processes
def test_a_crowd_that_computes_is_ended(sandbox: Sandbox, tmp_path: Path, mark: str) -> None:
    crowd = 'for i in {1..25}; do setsid sh -c "while :; do :; done" "$0" & done; sleep 600'
    with jail_in(sandbox, tmp_path, Limits(computing=1)) as jail:
        other = jail.start(python(SLEEPING, mark), log=tmp_path / 'other')
        process = jail.start(['bash', '-c', crowd, mark], log=tmp_path / 'log')
        assert process.wait(10.0)
        assert other.exit_code is None
    assert process.stopped.endswith(' processes and threads computing; 1 at a time are allowed')


@in_each_way
def test_a_log_is_cut_in_its_middle(sandbox: Sandbox, tmp_path: Path) -> None:
    log, much = tmp_path / 'log', 'echo begin; yes | head -c 200000000; echo end'
    with jail_in(sandbox, tmp_path, Limits(log_mb=0.1)) as jail:
        assert jail.run(['bash', '-c', much], log=log, within_sec=60.0) == 0
    text = log.read_text()
    assert len(text) < 110_000
    assert text.startswith('begin\ny\n')
    assert text.endswith('y\nend\n')
    assert '\n[199900010 bytes of the log are left out here]\n' in text


def test_what_was_printed_last_is_in_the_log_while_it_runs(tmp_path: Path) -> None:
    log, much = tmp_path / 'log', 'yes | head -c 300000; echo last; sleep 600'
    with jail_in(find_sandbox('none'), tmp_path, Limits(log_mb=0.1)) as jail:
        jail.start(['bash', '-c', much], log=log)
        has_said(log, 'y\nlast\n')


@in_each_with_network
def test_files_stay_within_their_limits(sandbox: Sandbox, tmp_path: Path) -> None:
    limits = Limits(file_mb=2, folder_mb=5, temporary_mb=1, shared_mb=1)
    log, fill = tmp_path / 'log', 'head -c 3000000 /dev/zero >'
    with jail_in(sandbox, tmp_path, limits) as jail:
        for place in ('one', '/tmp/one', '/dev/shm/one'):
            assert jail.run(['bash', '-c', f'{fill} {place}'], log=log, within_sec=10.0) != 0, (
                place
            )
        assert (tmp_path / 'folder' / 'one').stat().st_size == 2_000_000
        many = 'for i in {1..9}; do head -c 1000000 /dev/zero > $i; done; sleep 600'
        process = jail.start(['bash', '-c', many], log=log)
        assert process.wait(10.0)
        assert process.stopped == 'filled its folder with over 5 MB'


@in_that_of_the_kernel  # bwrap has no word for it; a container's own memory is counted, too
def test_files_in_memory_stay_within_their_limit(sandbox: Sandbox, tmp_path: Path) -> None:
    many = 'import os\nfor i in range(60_000): os.close(os.open(f"/tmp/{i}", os.O_CREAT))'
    log = tmp_path / 'log'
    with jail_in(sandbox, tmp_path) as jail:
        assert jail.run([sys.executable, '-c', many], log=log, within_sec=30.0) == 1
    assert 'No space left on device' in log.read_text()


@in_each_way_with_processes  # a container's root may not look at the files of another user
def test_files_that_were_removed_count_while_they_are_open(
    sandbox: Sandbox, tmp_path: Path, mark: str
) -> None:
    with jail_in(sandbox, tmp_path, Limits(folder_mb=5)) as jail:
        process = jail.start(python(REMOVES, mark), log=tmp_path / 'log')
        assert process.wait(10.0)
    assert process.stopped == 'filled its folder with over 5 MB'


@in_each_way_with_processes
def test_files_count_that_are_there_between_two_looks(
    sandbox: Sandbox, tmp_path: Path, mark: str
) -> None:
    with jail_in(sandbox, tmp_path, Limits(folder_mb=5)) as jail:
        process = jail.start(python(FILLS, mark), log=tmp_path / 'log')
        assert process.wait(20.0)
    assert process.stopped == 'filled its folder with over 5 MB'


@in_each_with_network
def test_jails_do_not_meet_on_the_network(sandbox: Sandbox, tmp_path: Path) -> None:
    serve = 'import socket; server = socket.create_server(("127.0.0.1", 4000)); ' + SLEEPING
    ask = 'import socket; socket.create_connection(("127.0.0.1", 4000), 1.0)'
    for name in ('one', 'two'):
        (tmp_path / name).mkdir()
    with jail_in(sandbox, tmp_path / 'one') as one, jail_in(sandbox, tmp_path / 'two') as two:
        one.start(python(serve), log=tmp_path / 'log')
        has_said(tmp_path / 'log', 'here')
        assert one.run(python(ask), log=tmp_path / 'asked', within_sec=10.0) == 0
        assert two.run(python(ask), log=tmp_path / 'asked', within_sec=10.0) == 1
        beside = subprocess.run(one.beside(python(ask)), capture_output=True, text=True)
        assert beside.returncode == 0, beside.stderr


@in_each_sandbox
@pytest.mark.parametrize('how', ['SIGKILL', 'SIGINT'])
def test_nothing_outlives_a_grader_that_ends(
    sandbox: Sandbox, tmp_path: Path, mark: str, how: str
) -> None:
    folder = tmp_path / 'folder'
    folder.mkdir()
    command = python(GRADER, sandbox.name, str(folder), mark)
    with (
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as grader,
        ExitStack() as stack,
    ):
        stack.callback(grader.kill)  # or the test would wait for it
        assert grader.stdout is not None
        assert grader.stdout.readline() == b'ready\n'
        wait_until(lambda: len(running(mark)) >= 2, timeout_sec=10.0, what='both programs')
        has_said(tmp_path / 'folder.log', 'here')
        grader.send_signal(signal.Signals[how])
        wait_until(
            lambda: running(mark) == [] and grader.poll() is not None,
            timeout_sec=4.0,
            what=lambda: f'the end of {running(mark)}',
        )


@in_each_of_namespaces
def test_an_ordinary_user_has_a_jail_too(sandbox: Sandbox, tmp_path: Path) -> None:
    folder, log = tmp_path / 'folder', tmp_path / 'log'
    folder.mkdir()
    command = as_ordinary_user(python(ORDINARY, sandbox.name, str(folder), str(log)))
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, '')
    user, rights, *rest = log.read_text().splitlines()
    assert user != '0'
    assert rights == 'CapEff:\t0000000000000000'
    assert rest == ["touch: cannot touch '/usr/here': Read-only file system"]
    assert (folder / 'here').is_file()


def test_an_unknown_sandbox_is_refused(tmp_path: Path) -> None:
    with pytest.raises(NoSandbox, match=r"'chroot': allowed are auto, bwrap, .*, none"):
        find_sandbox('chroot')
    with pytest.raises(ValueError, match='nothing: no such folder; make the one'):
        Jail(find_sandbox('none'), tmp_path / 'nothing')
    with pytest.raises(ValueError, match='tasks=0: a limit is a number above 0'):
        Limits(tasks=0)


def test_where_the_wanted_sandbox_fails_others_are_not_said_to(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv('PATH', '')
    with pytest.raises(NoSandbox, match=r'^sandbox podman: podman .*; without --sandbox '):
        find_sandbox('podman')


@pytest.mark.parametrize(
    ('restricted', 'advice'),
    [
        ('0', 'install bubblewrap 0.8 or newer, or podman (Ubuntu, Debian: '),
        ('1', 'install podman (sudo apt install podman), or allow namespaces to all programs: '),
    ],
)
def test_a_machine_without_a_sandbox_is_told_what_to_install(
    restricted: str, advice: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    setting = tmp_path / 'apparmor_restrict_unprivileged_userns'
    setting.write_text(f'{restricted}\n')
    monkeypatch.setattr('husky_grader.jail.find._RESTRICTED', setting)
    monkeypatch.setenv('PATH', '')
    with pytest.raises(NoSandbox) as refused:
        find_sandbox()
    assert 'unshare' in str(refused.value)
    assert f'); {advice}' in str(refused.value)
    assert '\n' not in str(refused.value)


def test_a_program_prints_what_the_grader_s_terminal_cannot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in {'PYTHONUTF8': '0', 'LC_ALL': 'C'}.items():
        monkeypatch.setenv(name, value)
    log = tmp_path / 'log'
    with jail_in(find_sandbox('none'), tmp_path) as jail:
        assert jail.run(python('print("größe ✓")'), log=log, within_sec=20.0) == 0
    assert log.read_text(encoding='utf-8') == 'größe ✓\n'


def test_numpy_starts_no_thread_for_each_processor(tmp_path: Path) -> None:
    log, show = tmp_path / 'log', 'import os, numpy; print(os.listdir("/proc/self/task"), numpy.e)'
    with jail_in(find_sandbox('none'), tmp_path) as jail:
        assert jail.run(python(show), log=log, within_sec=20.0) == 0
    assert log.read_text().count("'") == 2, log.read_text()
