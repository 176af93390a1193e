# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The last step into a jail: folders, limits, rights; then the command.

A program, `python -I -S inside.py PLAN...`, that imports nothing of ours: it has to start quickly,
and what it runs with must not come from anybody else. It stays as the parent of the command, in
most jails as the init of their process namespace, which ends with it. It ends when the command
does, or when the grader does: then nobody can write any more to the pipe of which it has the
reading end, its lifeline. The output would not tell. The command can open that once more, and
would be a reader of its own; who is not root may open a pipe of the same user by /proc/self/fd.
The lifeline is closed before the command starts, and /proc shows no open files of this process to
it: see _drop_rights.
"""

import _thread
import ctypes
import errno
import marshal
import os
import resource
import select
import struct
import sys

# Exit codes as those of env(1).
_NO_JAIL, _NO_COMMAND = 125, 127
_OUTPUT = 1

_LIBC = ctypes.CDLL(None, use_errno=True)

# <sys/mount.h>, <linux/mount.h>
_MS_NOSUID, _MS_NODEV, _MS_NOEXEC, _MS_BIND, _MS_REC = 2, 4, 8, 4096, 16384
_MNT_DETACH = 2
_MOUNT_ATTR_RDONLY, _MOUNT_ATTR_NOSUID, _MOUNT_ATTR_NODEV = 1, 2, 4
_AT_FDCWD, _AT_RECURSIVE = -100, 0x8000
_NR_MOUNT_SETATTR = 442  # of every architecture; glibc has it since 2.36
_DEVICES = ('null', 'zero', 'full', 'random', 'urandom')
# Who opens /dev/ptmx owns the terminal; the computer has 4096 of them for all.
_TERMINALS = 'newinstance,ptmxmode=0666,mode=620,max=64'
# An empty file takes none of the size, but a kilobyte of the kernel's own memory.
_MEMORY_FILES = 50_000
_PLACE = '/tmp'  # any folder that is there; others do not see what is mounted on it here

# <linux/landlock.h>; the numbers of the calls are those of every architecture
_NR_CREATE_RULESET, _NR_ADD_RULE, _NR_RESTRICT_SELF = 444, 445, 446
_CREATE_RULESET_VERSION, _RULE_PATH_BENEATH = 1, 1
_EXECUTE, _WRITE_FILE, _READ_FILE, _READ_DIR = 1 << 0, 1 << 1, 1 << 2, 1 << 3
_TRUNCATE, _IOCTL_DEV = 1 << 14, 1 << 15
_OF_FILES = _EXECUTE | _WRITE_FILE | _READ_FILE | _TRUNCATE | _IOCTL_DEV
# How many rights to files the versions 1, 2, ... know.
_FILE_RIGHTS = (13, 14, 15, 15, 16)
_SCOPE_ALL = 0b11  # abstract sockets and signals; from version 6 on

_PR_SET_DUMPABLE, _PR_SET_NO_NEW_PRIVS = 4, 38  # <linux/prctl.h>
_CAPABILITY_VERSION = 0x20080522  # <linux/capability.h>

# <linux/audit.h> and <asm/unistd.h>: the machine, its calls add_key to keyctl, and socket
_CALLS = {'x86_64': (0xC000003E, 248, 250, 41), 'aarch64': (0xC00000B7, 217, 219, 198)}
_NR_IO_URING_SETUP = 425  # of every architecture
_NO_CALL_FROM = 0x40000000  # numbers of x32, which are other names for the same
_FAMILIES = (1, 2, 10, 16)  # <sys/socket.h>: UNIX, INET, INET6, NETLINK; namespaces separate them
_PR_SET_SECCOMP, _SECCOMP_MODE_FILTER = 22, 2  # <linux/prctl.h>, <linux/seccomp.h>
_SECCOMP_ALLOW, _SECCOMP_ERRNO = 0x7FFF0000, 0x00050000
# <linux/bpf_common.h>: load a word, jump where it is equal or at least so much, return
_BPF_LOAD, _BPF_IF_EQUAL, _BPF_IF_LEAST, _BPF_RETURN = 0x20, 0x15, 0x35, 0x06
_AT_CALL, _AT_MACHINE, _AT_FIRST_ARGUMENT = 0, 4, 16  # of struct seccomp_data, its low word

# <signal.h>; to import signal takes longer than all the rest
_SIGINT, _SIGPIPE, _SIGTERM, _SIGXFSZ = 2, 13, 15, 25
_SIG_DFL, _SIG_IGN = ctypes.c_void_p(0), ctypes.c_void_p(1)


def _checked(result: int, what: str) -> int:
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, f'{what}: {os.strerror(number)}')
    return result


def _enter_root(mounts: list[tuple[str, str, str]]) -> None:
    """Leave the host's files for a root that holds nothing but what is named."""
    os.umask(0o022)  # what is made here another user must be able to pass
    _mount('tmpfs', _PLACE, kind='tmpfs', flags=_MS_NOSUID | _MS_NODEV)
    os.chdir(_PLACE)
    os.mkdir('host')
    os.mkdir('new')
    _checked(_LIBC.pivot_root(b'.', b'host'), 'pivot_root')
    os.chdir('/')
    _mount('tmpfs', '/new', kind='tmpfs', flags=_MS_NOSUID | _MS_NODEV, data='mode=755')
    for device in _DEVICES:
        _bind(f'/host/dev/{device}', f'/new/dev/{device}')
    for name, place in (('fd', ''), ('stdin', '/0'), ('stdout', '/1'), ('stderr', '/2')):
        os.symlink(f'/proc/self/fd{place}', f'/new/dev/{name}')
    # `emulate_tty` of a launch file asks for a terminal; this jail has its own ones.
    os.mkdir('/new/dev/pts')
    terminals_only = _MS_NOSUID | _MS_NOEXEC
    _mount('devpts', '/new/dev/pts', kind='devpts', flags=terminals_only, data=_TERMINALS)
    os.symlink('pts/ptmx', '/new/dev/ptmx')
    os.mkdir('/new/proc')
    _mount('proc', '/new/proc', kind='proc', flags=_MS_NOSUID | _MS_NODEV | _MS_NOEXEC)
    for kind, source, target in mounts:
        if kind == 'memory':
            os.makedirs(f'/new{target}', exist_ok=True)
            _mount(
                'tmpfs',
                f'/new{target}',
                kind='tmpfs',
                flags=_MS_NOSUID | _MS_NODEV,
                data=f'mode=1777,size={source},nr_inodes={_MEMORY_FILES}',
            )
        else:
            _bind(f'/host{source}', f'/new{target}')
            _restrict(f'/new{target}', recursive=True, read_only=kind == 'read')
    _restrict('/new', recursive=False, read_only=True)
    os.chdir('/new')
    _checked(_LIBC.pivot_root(b'.', b'.'), 'pivot_root')
    _checked(_LIBC.umount2(b'.', _MNT_DETACH), 'umount')
    os.chdir('/')


def _mount(source: str, target: str, *, kind: str = '', flags: int, data: str = '') -> None:
    words = [word.encode() for word in (source, target, kind)]
    done = _LIBC.mount(*words, ctypes.c_ulong(flags), data.encode())
    _checked(done, f'mount {target}')


def _bind(source: str, target: str) -> None:
    if os.path.isdir(source):
        os.makedirs(target, exist_ok=True)
    elif not os.path.exists(target):
        os.makedirs(os.path.dirname(target), exist_ok=True)
        os.close(os.open(target, os.O_CREAT | os.O_WRONLY | os.O_CLOEXEC))
    _mount(source, target, flags=_MS_BIND | _MS_REC)


def _restrict(target: str, *, recursive: bool, read_only: bool) -> None:
    kept = _MOUNT_ATTR_NOSUID | _MOUNT_ATTR_NODEV | (_MOUNT_ATTR_RDONLY if read_only else 0)
    attributes = (ctypes.c_uint64 * 4)(kept, 0, 0, 0)  # struct mount_attr: to set, to clear, ...
    how = _AT_RECURSIVE if recursive else 0
    number, size = ctypes.c_long(_NR_MOUNT_SETATTR), ctypes.c_size_t(ctypes.sizeof(attributes))
    done = _LIBC.syscall(number, _AT_FDCWD, target.encode(), how, attributes, size)
    _checked(done, f'mount_setattr {target}')


def _drop_rights(user: int | None) -> None:
    if user is not None:
        os.setgroups([])
        os.setresgid(user, user, user)
        os.setresuid(user, user, user)
    # No more of them comes back, neither by a set-user-id program nor by one with capabilities.
    _checked(_LIBC.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), 'no_new_privs')
    header, none = (ctypes.c_uint32 * 2)(_CAPABILITY_VERSION, 0), (ctypes.c_uint32 * 6)()
    _checked(_LIBC.capset(header, none), 'capset')
    _refuse_calls()
    # The command has the same user: it must neither trace, and so stop, this process, nor open its
    # files by /proc/1/fd.
    _checked(_LIBC.prctl(_PR_SET_DUMPABLE, 0, 0, 0, 0), 'dumpable')


def _refuse_calls() -> None:
    """
    Have the kernel refuse calls that reach what no namespace separates: see seccomp(2).

    Keys, keyrings(7): a command inherits the session keyring, in which may be keys of who grades,
    such as tickets of Kerberos; and what one has left there, or in the persistent keyring of its
    user, others find. Sockets of a family with one network for all, as AF_VSOCK, by which a
    virtual machine reaches its host; io_uring would open them past this.
    """
    if os.uname().machine not in _CALLS:
        return
    machine, first_of_keys, last_of_keys, socket = _CALLS[os.uname().machine]
    families = len(_FAMILIES)
    program = (  # code, how many lines to pass over if it is so, if not, number
        (_BPF_LOAD, 0, 0, _AT_MACHINE),
        (_BPF_IF_EQUAL, 0, 9 + families, machine),  # a 32-bit program's calls have other numbers
        (_BPF_LOAD, 0, 0, _AT_CALL),
        (_BPF_IF_LEAST, 7 + families, 0, _NO_CALL_FROM),
        (_BPF_IF_EQUAL, 6 + families, 0, _NR_IO_URING_SETUP),
        (_BPF_IF_EQUAL, 2, 0, socket),
        (_BPF_IF_LEAST, 3 + families, 0, last_of_keys + 1),
        (_BPF_IF_LEAST, 3 + families, 2 + families, first_of_keys),
        (_BPF_LOAD, 0, 0, _AT_FIRST_ARGUMENT),
        *((_BPF_IF_EQUAL, families - n, 0, each) for n, each in enumerate(_FAMILIES)),
        (_BPF_RETURN, 0, 0, _SECCOMP_ERRNO | errno.EAFNOSUPPORT),
        (_BPF_RETURN, 0, 0, _SECCOMP_ALLOW),
        (_BPF_RETURN, 0, 0, _SECCOMP_ERRNO | errno.ENOSYS),
    )

    # struct sock_filter, and struct sock_fprog: how many there are, and where
    lines = ctypes.create_string_buffer(b''.join(struct.pack('=HBBI', *line) for line in program))
    whole = struct.pack('@HP', len(program), ctypes.addressof(lines))
    done = _LIBC.prctl(_PR_SET_SECCOMP, _SECCOMP_MODE_FILTER, whole, 0, 0)
    if done == 0 or ctypes.get_errno() != errno.EINVAL:  # that of a kernel without seccomp
        _checked(done, 'seccomp')


def _restrict_files(readable: list[str], writable: list[str], *, needed: bool) -> None:
    """
    Have Landlock refuse writing elsewhere, mounting, and reaching what is outside by any name.

    See landlock(7). The mounts say the same: two locks, so that a hole in one is none in both.
    """
    flag, size = ctypes.c_uint32(_CREATE_RULESET_VERSION), ctypes.c_size_t(0)
    version = _LIBC.syscall(_NR_CREATE_RULESET, None, size, flag)
    if version < 1:
        if needed:
            raise OSError('this kernel has no Landlock, which it needs to be a sandbox')
        return
    every = (1 << _FILE_RIGHTS[min(version, len(_FILE_RIGHTS)) - 1]) - 1
    fields = [every, 0, _SCOPE_ALL] if version >= 6 else [every]
    attributes = (ctypes.c_uint64 * len(fields))(*fields)
    size = ctypes.c_size_t(ctypes.sizeof(attributes))
    ruleset = _checked(_LIBC.syscall(_NR_CREATE_RULESET, attributes, size, 0), 'Landlock')
    for place in readable:
        _allow(ruleset, place, _EXECUTE | _READ_FILE | _READ_DIR)
    device = every & (_READ_FILE | _READ_DIR | _WRITE_FILE | _TRUNCATE)
    _allow(ruleset, '/dev', device)
    for terminals in filter(os.path.exists, ('/dev/pts', '/dev/ptmx')):
        _allow(ruleset, terminals, device | every & _IOCTL_DEV)  # to open one is not enough
    for folder in writable:
        _allow(ruleset, folder, every)
    _checked(_LIBC.syscall(_NR_RESTRICT_SELF, ruleset, 0), 'Landlock')
    os.close(ruleset)


def _allow(ruleset: int, place: str, rights: int) -> None:
    class Beneath(ctypes.Structure):
        _pack_ = 1
        _layout_ = 'ms'  # for a packed one Python 3.14 wants it said, and warns in the log if not
        _fields_ = [('rights', ctypes.c_uint64), ('place', ctypes.c_int32)]

    if not os.path.isdir(place):
        rights &= _OF_FILES
    opened = os.open(place, os.O_PATH | os.O_CLOEXEC)
    rule = ctypes.byref(Beneath(rights, opened))
    done = _LIBC.syscall(_NR_ADD_RULE, ruleset, _RULE_PATH_BENEATH, rule, 0)
    _checked(done, f'Landlock of {place}')
    os.close(opened)


def _limit(limits: list[tuple[int, int]]) -> None:
    for number, most in limits:
        hard = resource.getrlimit(number)[1]
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(number, (most, most))


def _start(command: list[str], environment: dict[str, str]) -> int:
    """Start the command in a session of its own, from which no signal goes to who watches it."""
    child = os.fork()
    if child == 0:
        os.setsid()
        for number in (_SIGINT, _SIGPIPE, _SIGTERM, _SIGXFSZ):
            _LIBC.signal(number, _SIG_DFL)
        try:
            os.execvpe(command[0], command, environment)
        except OSError as error:
            os.write(2, f'{command[0]}: {_why(error, command[0], environment)}\n'.encode())
        os._exit(_NO_COMMAND)
    return child


def _why(error: OSError, program: str, environment: dict[str, str]) -> str:
    """Return why a program cannot be started; a folder of PATH that is barred is no reason."""
    folders = [''] if '/' in program else os.get_exec_path(environment)
    if any(os.path.lexists(os.path.join(folder, program)) for folder in folders):
        return str(error.strerror)
    return os.strerror(errno.ENOENT)


def _end_with_grader(lifeline: int) -> None:
    end = select.poll()
    end.register(lifeline, 0)  # reports POLLHUP or POLLERR, unasked, when nobody has the other end
    end.poll()
    os._exit(_NO_JAIL)


def _await(command: int, lifeline: int) -> int:
    """Wait for the command's end and return its exit code."""
    _thread.start_new_thread(_end_with_grader, (lifeline,))
    while True:
        ended, status = os.wait()  # an init gets the orphans of the others too
        if ended == command:
            return _exit_code(status)


def _exit_code(status: int) -> int:
    """Return an exit code as a shell does, which is 128 and the signal where one ended it."""
    code = os.waitstatus_to_exitcode(status)
    return code if code >= 0 else 128 - code


def main(
    *,
    mounts: list[tuple[str, str, str]],
    host_name: str,
    readable: list[str],
    writable: list[str],
    needs_landlock: bool,
    limits: list[tuple[int, int]],
    user: int | None,
    lifeline: int | None,
    umask: int,
    folder: str,
    environment: dict[str, str],
    command: list[str],
) -> int:
    """
    Make the jail, and run the command in it.

    :param mounts: as in folders.Mount; none where the root is made already.
    :param host_name: of the computer, for what runs in it; where the root is made, it has one.
    :param readable: what Landlock lets it read.
    :param writable: and what it lets it write to.
    :param limits: numbers of setrlimit(2) and values.
    :param user: whose number to take; None: it stays.
    :param lifeline: the number of the pipe that ends with the grader; None: it is the output.
    :param umask: that of the grader; a container begins with one of its own.
    :returns: the exit code.
    """
    for number in (_SIGINT, _SIGTERM):  # these are for the command
        _LIBC.signal(number, _SIG_IGN)
    if lifeline is None:
        lifeline = _OUTPUT
    else:
        os.set_inheritable(lifeline, False)
    try:
        if mounts:
            if init := os.fork():  # the first process of the new process namespace
                return _exit_code(os.waitpid(init, 0)[1])
            _enter_root(mounts)
            name = host_name.encode()
            _checked(_LIBC.sethostname(name, ctypes.c_size_t(len(name))), 'sethostname')
        os.umask(umask)
        os.chdir(folder)
        with open('/proc/self/oom_score_adj', 'w') as score:  # if memory runs out, these go first
            score.write('1000')
        _drop_rights(user)
        _restrict_files(readable, writable, needed=needs_landlock)
        _limit(limits)
    except (OSError, ValueError) as error:
        print(f'the jail cannot be made: {error}', file=sys.stderr, flush=True)
        return _NO_JAIL
    return _await(_start(command, environment), lifeline)


if __name__ == '__main__':
    exit_code = main(**marshal.loads(bytes.fromhex(''.join(sys.argv[1:]))))
    os._exit(exit_code)  # without the time that Python takes to tidy up
