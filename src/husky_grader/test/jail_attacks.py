# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Attacks on what is outside of a jail: `jail_attacks.py VICTIM ATTACK...` prints which succeed.

They know all that an attacker could guess: places, numbers and names. test_jail_attacks.py runs
them in every sandbox, where none succeeds, and without one.
"""

from collections.abc import Iterator
import contextlib
import ctypes
import fcntl
import json
import os
from pathlib import Path
import socket
import sys
from typing import Any

Victim = dict[str, Any]

_LIBC = ctypes.CDLL(None)
_PTRACE_ATTACH, _TIOCSTI = 16, 0x5412
_CLONE_NEWNS, _CLONE_NEWUSER = 0x20000, 0x10000000
_KEYCTL_READ, _SESSION_KEYRING = 11, ctypes.c_int(-3)


def reads_secrets(victim: Victim) -> Iterator[str]:
    for path in (*victim['secrets'], '/etc/shadow'):
        with contextlib.suppress(OSError):
            yield f'{path}: {Path(path).read_bytes()[:9]!r}'


def lists_folders_of_others(victim: Victim) -> Iterator[str]:
    for path in (*victim['secrets'], *victim['kept']):
        with contextlib.suppress(OSError):
            yield f'{path}: {[each.name for each in Path(path).parent.iterdir()]}'


def writes(victim: Victim) -> Iterator[str]:
    for path in (*victim['kept'], victim['lab']):
        with contextlib.suppress(OSError):
            os.close(os.open(path, os.O_WRONLY))
            yield str(path)


def reads_environments(victim: Victim) -> Iterator[str]:
    for process in _others():
        with contextlib.suppress(OSError):
            if victim['token'].encode() in (process / 'environ').read_bytes():
                yield process.name


def sees_processes(victim: Victim) -> Iterator[str]:
    for process in _others():
        with contextlib.suppress(OSError):
            if victim['token'].encode() in (process / 'cmdline').read_bytes():
                yield process.name


def enters_the_root_of_others(victim: Victim) -> Iterator[str]:
    for process in _others():
        for path in victim['kept']:
            with contextlib.suppress(OSError):
                (process / 'root' / path.lstrip('/')).stat()
                yield f'{path} by process {process.name}'


def _others() -> list[Path]:
    return [each for each in Path('/proc').glob('[0-9]*') if each.name != str(os.getpid())]


def signals_the_grader(victim: Victim) -> Iterator[str]:
    with contextlib.suppress(OSError):
        os.kill(victim['grader'], 0)
        yield str(victim['grader'])


def traces_who_watches(victim: Victim) -> Iterator[str]:
    for process in (victim['grader'], os.getppid()):
        if _LIBC.ptrace(_PTRACE_ATTACH, process, 0, 0) == 0:
            yield str(process)


def opens_files_of_who_watches(victim: Victim) -> Iterator[str]:
    for process in (victim['grader'], os.getppid()):
        with contextlib.suppress(OSError):
            yield f'{process}: {[each.name for each in Path(f"/proc/{process}/fd").iterdir()]}'


def connects_by_tcp(victim: Victim) -> Iterator[str]:
    with (
        contextlib.suppress(OSError),
        socket.create_connection(('127.0.0.1', victim['port']), 1.0),
    ):
        yield f'port {victim["port"]}'


def connects_to_an_abstract_socket(victim: Victim) -> Iterator[str]:
    with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX) as connection:
        connection.connect(f'\0{victim["name"]}')
        yield str(victim['name'])


def opens_a_socket_that_no_namespace_separates(victim: Victim) -> Iterator[str]:
    with contextlib.suppress(OSError), socket.socket(socket.AF_VSOCK, socket.SOCK_STREAM):
        yield 'AF_VSOCK'


def listens_to_all_packets(victim: Victim) -> Iterator[str]:
    for family in (socket.AF_INET, socket.AF_PACKET):
        with contextlib.suppress(OSError), socket.socket(family, socket.SOCK_RAW, 1):
            yield family.name


def knows_the_name_of_the_machine(victim: Victim) -> Iterator[str]:
    shares = str(Path('/proc/self/ns/uts').readlink()) == victim['names']
    if shares or os.uname().nodename == victim['machine'] != 'localhost':
        yield victim['machine']


def has_open_files(victim: Victim) -> Iterator[str]:
    for number in range(3, 1000):
        with contextlib.suppress(OSError):
            path = Path(f'/proc/self/fd/{number}').readlink()
            if not path.name.startswith('libffi.so'):  # of ctypes here, from libffi 3.5 on
                yield str(path)


def mounts(victim: Victim) -> Iterator[str]:
    if _LIBC.mount(b'none', victim['folder'].encode(), b'tmpfs', 0, None) == 0:
        yield victim['folder']


def has_rights(victim: Victim) -> Iterator[str]:
    lines = Path('/proc/self/status').read_text().splitlines()
    rights = {line.partition(':')[0]: line.split()[-1] for line in lines}
    if int(rights['CapEff'], 16) or rights['NoNewPrivs'] != '1':
        yield f'CapEff {rights["CapEff"]}, NoNewPrivs {rights["NoNewPrivs"]}'


def writes_settings_of_the_kernel(victim: Victim) -> Iterator[str]:
    for path in ('/proc/sys/kernel/core_pattern', '/proc/sysrq-trigger', '/sys/power/state'):
        with contextlib.suppress(OSError):
            os.close(os.open(path, os.O_WRONLY))
            yield path


def types_at_the_terminal(victim: Victim) -> Iterator[str]:
    for path in ('/dev/tty', '/proc/self/fd/0', '/proc/self/fd/1'):
        with contextlib.suppress(OSError):
            fcntl.ioctl(os.open(path, os.O_RDWR), _TIOCSTI, b'x')
            yield path


def uses_services_of_the_system(victim: Victim) -> Iterator[str]:
    for path in ('/run/docker.sock', '/run/podman', '/run/dbus', f'/run/user/{os.getuid()}'):
        if Path(path).exists():
            yield path


def reads_keys_in_the_kernel(victim: Victim) -> Iterator[str]:
    text = ctypes.create_string_buffer(20)
    if _LIBC.syscall(victim['keyctl'], _KEYCTL_READ, victim['key'], text, len(text)) > 0:
        yield repr(text.value)


def leaves_keys_in_the_kernel(victim: Victim) -> Iterator[str]:
    number = victim['add_key']
    if _LIBC.syscall(number, b'user', b'kept', b'a course', 8, _SESSION_KEYRING) > 0:
        yield 'for whoever is next'


def mounts_in_a_namespace_of_its_own(victim: Victim) -> Iterator[str]:
    if _LIBC.unshare(_CLONE_NEWUSER | _CLONE_NEWNS) == 0:
        for path in (victim['folder'], '/usr'):
            if _LIBC.mount(b'none', path.encode(), b'tmpfs', 0, None) == 0:
                yield path


if __name__ == '__main__':
    for name in sys.argv[2:]:
        for what in globals()[name](json.loads(sys.argv[1])):
            print(f'{name}: {what}', flush=True)
