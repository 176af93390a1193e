# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A child process in an asyncio loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator, Mapping, Sequence
import contextlib
import ctypes
import os
import pty
import shutil
import signal
import sys
from typing import Any, cast

from interrupt_while_loading import takes_blocked_interrupt, words_of

_PR_SET_PDEATHSIG = 1  # linux/prctl.h
_ORPHANED_STATUS = 128 + signal.SIGTERM

# How long after its end the output of a child is awaited; a grandchild may hold the pipe open.
_DRAIN_SEC = 0.5

_OnOutput = Callable[[int, bytes], None]


class _Pty(asyncio.Protocol):
    """Reads the pseudo-terminal that a child writes to."""

    def __init__(self, child: ChildProcess, fd: int) -> None:
        self._child = child
        self._fd = fd

    def data_received(self, data: bytes) -> None:
        self._child.on_output(self._fd, data.replace(b'\r\n', b'\n'))

    def connection_lost(self, exc: Exception | None) -> None:
        del exc
        self._child.on_pipe_closed(self._fd)


class ChildProcess(asyncio.SubprocessProtocol):
    """Hands on the output of a child and tells when it has ended.

    ``complete`` becomes the exit status (minus the signal that ended it) when the child has
    ended and its output is read.

    :param on_output: gets 1 or 2 for stdout and stderr, and bytes.
    :param on_started: gets this child when it runs, before any output.
    """

    def __init__(
        self, on_output: _OnOutput, on_started: Callable[[ChildProcess], None] | None = None
    ) -> None:
        self.on_output = on_output
        self._on_started = on_started
        self.complete: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._open_pipes = {1, 2}
        self.returncode: int | None = None
        self._transport: asyncio.SubprocessTransport | None = None
        self._terminals: list[asyncio.BaseTransport] = []

    @property
    def pid(self) -> int:
        assert self._transport is not None
        return self._transport.get_pid()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast(asyncio.SubprocessTransport, transport)
        if self._on_started is not None:
            self._on_started(self)

    def pipe_data_received(self, fd: int, data: bytes) -> None:
        self.on_output(fd, data)

    def pipe_connection_lost(self, fd: int, exc: Exception | None) -> None:
        del exc
        self.on_pipe_closed(fd)

    def on_pipe_closed(self, fd: int) -> None:
        self._open_pipes.discard(fd)
        if not self._open_pipes and self.returncode is not None:
            self._finish()

    def process_exited(self) -> None:
        assert self._transport is not None
        returncode = self._transport.get_returncode()
        self.returncode = 255 if returncode is None else returncode
        if not self._open_pipes:
            self._finish()
        else:
            asyncio.get_running_loop().call_later(_DRAIN_SEC, self._finish)

    def _finish(self) -> None:
        if not self.complete.done():
            assert self.returncode is not None
            self.complete.set_result(self.returncode)
        self.close()

    def write(self, data: bytes) -> None:
        """Write to the standard input of the child."""
        assert self._transport is not None
        stdin = cast(Any, self._transport.get_pipe_transport(0))
        if stdin is not None:
            stdin.write(data)

    def send_signal(self, number: signal.Signals) -> None:
        """Send a signal.

        :raises ProcessLookupError: the child has ended.
        """
        assert self._transport is not None
        if self.returncode is not None:
            raise ProcessLookupError
        self._transport.send_signal(number)

    def close(self) -> None:
        for terminal in self._terminals:
            terminal.close()
        if self._transport is not None:
            self._transport.close()

    async def _listen(self, master: int, fd: int) -> None:
        loop = asyncio.get_running_loop()
        pipe = os.fdopen(master, 'rb', buffering=0)
        transport, _ = await loop.connect_read_pipe(lambda: _Pty(self, fd), pipe)
        self._terminals.append(transport)


@contextlib.contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Let no interrupt meet a child before its program does; it would be lost there.

    Several of these may overlap in one asyncio loop, for none forks after the first wait.
    """
    signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))


def _preparation(cmd: Sequence[str], *, shell: bool) -> Callable[[], None]:
    """Return what the child calls before it becomes the command.

    It ends when the launch ends, also when that is killed. Upstream leaves it running. Where
    Python takes the signal later, an interrupt stays held back.
    """
    program = None if shell else shutil.which(cmd[0])
    holds_back = program is not None and takes_blocked_interrupt(program)
    prctl = ctypes.CDLL(None).prctl if sys.platform == 'linux' else None
    parent = os.getpid()

    def prepare() -> None:
        if prctl is not None:
            prctl(_PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
            if os.getppid() != parent:
                os._exit(_ORPHANED_STATUS)
        if not holds_back:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))

    return prepare


async def start_child_process(
    cmd: Sequence[str],
    *,
    on_output: _OnOutput,
    on_started: Callable[[ChildProcess], None] | None = None,
    cwd: str | None = None,
    env: Mapping[str, str] | None = None,
    shell: bool = False,
    emulate_tty: bool = False,
) -> ChildProcess:
    """Start a child.

    It stays in the process group of the launch, so that Ctrl-C at the terminal reaches it, and
    ends with the launch.

    :param shell: give the words of the command, joined by spaces, to a shell.
    :param emulate_tty: its output goes to a pseudo terminal, so that it writes colours and
        whole lines.
    :raises OSError: it cannot be started.
    """
    loop = asyncio.get_running_loop()
    child = ChildProcess(on_output, on_started)
    pairs = [pty.openpty(), pty.openpty()] if emulate_tty else []
    options: dict[str, Any] = {'cwd': cwd, 'env': env}
    options['preexec_fn'] = _preparation(cmd, shell=shell)
    if pairs:
        options.update(stdout=pairs[0][1], stderr=pairs[1][1])
    try:
        with _interrupts_held_back():
            if shell:
                await loop.subprocess_shell(lambda: child, ' '.join(cmd), **options)
            else:
                await loop.subprocess_exec(lambda: child, *words_of(cmd), **options)
    except BaseException:
        for master, _ in pairs:
            os.close(master)
        raise
    finally:
        for _, slave in pairs:
            os.close(slave)
    for fd, (master, _) in enumerate(pairs, start=1):
        with contextlib.suppress(OSError):
            await child._listen(master, fd)
    return child


def printable_command(cmd: Sequence[str]) -> str:
    """Return a command as upstream prints it: words with spaces between."""
    text = ' '.join(part for part in cmd if part.strip())
    return text.encode('utf-8', 'backslashreplace').decode()  # a name may be no UTF-8
