# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a jailed program does to what is outside, in every sandbox that works here."""

from collections.abc import Iterator
import ctypes
import json
import os
from pathlib import Path
import socket
import subprocess
import sys
from tempfile import TemporaryDirectory

from husky_grader.jail import find_sandbox, Jail, Sandbox
from playpen_testing.jails import in_each_sandbox
import pytest

PROGRAM = Path(__file__).with_name('jail_attacks.py')
# They succeed where there is no jail, of any user.
SUCCEEDING = (
    *('reads_secrets', 'lists_folders_of_others', 'writes'),
    *('reads_environments', 'sees_processes', 'enters_the_root_of_others', 'signals_the_grader'),
    'opens_files_of_who_watches',
    *('connects_by_tcp', 'connects_to_an_abstract_socket', 'has_rights'),
    'knows_the_name_of_the_machine',
)
# Some do only as root, or on some computers.
OTHERS = (
    *('traces_who_watches', 'listens_to_all_packets', 'has_open_files', 'mounts'),
    *('writes_settings_of_the_kernel', 'types_at_the_terminal', 'uses_services_of_the_system'),
    *('reads_keys_in_the_kernel', 'leaves_keys_in_the_kernel'),
    'opens_a_socket_that_no_namespace_separates',
    'mounts_in_a_namespace_of_its_own',  # last: it is another user then
)
# What another user cannot be kept from, on a machine without namespaces; of the services it sees
# the names alone.
NOT_APART = {
    'user': {
        *('sees_processes', 'connects_by_tcp', 'uses_services_of_the_system'),
        'knows_the_name_of_the_machine',
    }
}

# What outlives processes; see sysvipc(7).
KEEPS = """
import ctypes, sys
libc = ctypes.CDLL(None)
key, flags = int(sys.argv[1]), int(sys.argv[2])
found = {
    'shm': libc.shmget(key, 4096, flags),
    'sem': libc.semget(key, 1, flags),
    'msg': libc.msgget(key, flags),
}
print(*(name for name, number in found.items() if number >= 0))
"""
CREATE = 0o1666  # IPC_CREAT, for everybody
# The numbers of two calls, see keyrings(7), and what they are told.
ADD_KEY, KEYCTL = (217, 219) if os.uname().machine == 'aarch64' else (248, 250)
JOIN_SESSION_KEYRING, SESSION_KEYRING = 1, ctypes.c_int(-3)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / 'jail').mkdir()
    return tmp_path / 'jail'


def new_key() -> int:
    """Return the number of a key in a new session keyring of ours; -1 where there are no keys."""
    call = ctypes.CDLL(None).syscall
    call(KEYCTL, JOIN_SESSION_KEYRING, None)
    return int(call(ADD_KEY, b'user', b'ticket', b'of the grader', 13, SESSION_KEYRING))


@pytest.fixture
def victim(tmp_path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """Give all there is to attack, as JSON."""
    places = {name: tmp_path / name / 'file' for name in ('.ssh', '.local', 'report', 'other')}
    for place in places.values():
        place.parent.mkdir()
        place.write_text('for nobody else')
    monkeypatch.setenv('GRADER_TOKEN', token := f'token of {os.getpid()}')
    with (
        socket.create_server(('127.0.0.1', 0)) as server,
        socket.socket(socket.AF_UNIX) as abstract,
        (tmp_path / 'open').open('w') as opened,
        # Only of one who has not changed its environment is it what /proc shows.
        subprocess.Popen([sys.executable, '-c', 'input()', token], stdin=subprocess.PIPE) as own,
    ):
        os.set_inheritable(opened.fileno(), True)
        abstract.bind(f'\0{tmp_path}')
        abstract.listen()
        yield json.dumps(
            {
                'folder': str(folder),
                'secrets': [str(places['.ssh']), str(places['.local'])],
                'kept': [str(places['report']), str(places['other'])],
                'lab': str(PROGRAM),
                'token': token,
                'grader': own.pid,
                'port': server.getsockname()[1],
                'name': str(tmp_path),
                'machine': os.uname().nodename,
                'names': str(Path('/proc/self/ns/uts').readlink()),
                'key': new_key(),
                'add_key': ADD_KEY,
                'keyctl': KEYCTL,
            }
        )
        own.kill()


def attack(sandbox: Sandbox, folder: Path, *words: str) -> str:
    """Run attacks in a jail and return what they say."""
    log = folder.with_name('log')
    with Jail(sandbox, folder, readable=[PROGRAM]) as jail:
        exit_code = jail.run([sys.executable, str(PROGRAM), *words], log=log, within_sec=30.0)
    said = log.read_text()
    assert exit_code == 0, said
    return said


@in_each_sandbox
def test_no_attack_succeeds(sandbox: Sandbox, folder: Path, victim: str) -> None:
    said = attack(sandbox, folder, victim, *SUCCEEDING, *OTHERS)
    known = NOT_APART.get(sandbox.name, set())
    assert [line for line in said.splitlines() if line.partition(':')[0] not in known] == []


def test_attacks_succeed_without_a_jail(folder: Path, victim: str) -> None:
    said = attack(find_sandbox('none'), folder, victim, *SUCCEEDING)
    assert {line.partition(':')[0] for line in said.splitlines()} == set(SUCCEEDING)


@in_each_sandbox
def test_a_folder_on_pythonpath_shows_nobody_elses_files(
    sandbox: Sandbox, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with TemporaryDirectory(dir='/var/tmp') as place:  # of /tmp each jail has its own
        (folder := Path(place, 'jail')).mkdir()
        (other := Path(place, 'other')).write_text('for nobody else')
        Path(place).chmod(0o755)
        other.chmod(0o600 if sandbox.name == 'user' else 0o644)
        monkeypatch.setenv('PYTHONPATH', place, prepend=os.pathsep)
        log = tmp_path / 'log'
        with Jail(sandbox, folder) as jail:
            jail.run(['cat', str(other)], log=log, within_sec=10.0)
    assert log.read_text() != 'for nobody else'


@in_each_sandbox
def test_a_temporary_folder_on_pythonpath_hides_no_workspace(
    sandbox: Sandbox, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (given := tmp_path / 'given').write_text('to read')
    given.chmod(0o644)
    monkeypatch.setenv('PYTHONPATH', '/tmp', prepend=os.pathsep)
    log = tmp_path / 'log'
    with Jail(sandbox, folder, readable=[given]) as jail:
        jail.run(['cat', str(given)], log=log, within_sec=10.0)
    assert log.read_text() == 'to read'


def test_a_jail_goes_without_a_sourced_solution_but_not_without_ros(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    merged, alone, ros, messages = (tmp_path / each for each in ('ws', 'in', 'ros', 'course'))
    for place in (
        merged / 'share' / 'solved',
        alone / 'solved',  # install of a workspace, a folder for each package
        *(ros / 'share' / name for name in ('rclpy', 'solved')),
        messages / 'share' / 'course_msgs',
    ):
        place.mkdir(parents=True)
    given = ':'.join(map(str, (merged, alone, ros, messages)))
    log = tmp_path / 'log'
    for without, shown in (((), given), (['solved'], f'{ros}:{messages}')):
        monkeypatch.setenv('COLCON_PREFIX_PATH', given)
        with Jail(find_sandbox('none'), folder, without=without) as jail:
            jail.run(['printenv', 'COLCON_PREFIX_PATH'], log=log, within_sec=10.0)
        assert log.read_text() == f'{shown}\n'


@in_each_sandbox
def test_nothing_is_written_beside_the_folder(sandbox: Sandbox, folder: Path) -> None:
    with Jail(sandbox, folder) as jail:
        command = ['bash', '-c', 'touch ../beside /tmp/own /dev/shm/own ~/own here']
        jail.run(command, log=folder.with_name('log'), within_sec=10.0)
    assert sorted(path.name for path in folder.parent.iterdir()) == ['jail', 'log']
    assert sorted(path.name for path in folder.rglob('*')) == ['here', 'home', 'own']
    assert not Path('/tmp/own').exists()
    assert not Path('/dev/shm/own').exists()


@in_each_sandbox
def test_a_jail_finds_nothing_that_another_has_left_in_the_kernel(
    sandbox: Sandbox, tmp_path: Path
) -> None:
    said = []
    for flags in (CREATE, 0):
        (folder := tmp_path / str(flags)).mkdir()
        with Jail(sandbox, folder) as jail:
            command = [sys.executable, '-c', KEEPS, str(os.getpid()), str(flags)]
            jail.run(command, log=tmp_path / 'log', within_sec=10.0)
        said.append((tmp_path / 'log').read_text())
    assert said == ['shm sem msg\n', '\n']
