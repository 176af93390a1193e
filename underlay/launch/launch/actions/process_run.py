# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A process from its first start to its last end."""

from __future__ import annotations

import asyncio
import codecs
from collections.abc import Callable
import logging
import signal
from typing import Any

from ..child_process import ChildProcess, printable_command, start_child_process
from ..events import Shutdown
from ..events.process import ProcessExited, ProcessStarted, ProcessStderr, ProcessStdout
from ..launch_context import LaunchContext
from ..logging import get_logger, get_output_loggers, launch_config
from .process_settings import ProcessSettings
from .timer_action import TimerAction


class _Output:
    """Logs one stream of a process line by line.

    :param format_line: makes the logged text of a line.
    :param cached: keep everything for :attr:`text`.
    """

    def __init__(
        self, logger: logging.Logger, format_line: Callable[[str], str], *, cached: bool
    ) -> None:
        self.logger = logger
        self.format_line = format_line
        self._decoder = codecs.getincrementaldecoder('utf-8')('replace')
        self._rest = ''
        self._cache: list[str] | None = [] if cached else None

    @property
    def text(self) -> str:
        """Everything written so far; only where it is cached."""
        return ''.join(self._cache or ())

    def feed(self, data: bytes) -> None:
        text = self._decoder.decode(data)
        if self._cache is not None:
            self._cache.append(text)
        *lines, self._rest = (self._rest + text).split('\n')
        for line in lines:
            self.logger.info(self.format_line(line))

    def flush(self) -> None:
        """Log a last line without an end."""
        self._rest += self._decoder.decode(b'', True)
        if self._rest:
            self.logger.info(self.format_line(self._rest))
        self._rest = ''


class ProcessRun:
    """Starts a process, logs its output, emits its events, and starts it again where it is to.

    ``completed`` is done when it will not run any more, ``shutdown`` when it is to end.

    :param details: what the events tell of the process; gets its ``pid``.
    :param format_line: makes the logged text of a line.
    :param cached: keep the output.
    """

    def __init__(
        self,
        context: LaunchContext,
        details: dict[str, Any],
        settings: ProcessSettings,
        *,
        format_line: Callable[[str], str],
        cached: bool,
        log_cmd: bool,
    ) -> None:
        assert context.asyncio_loop is not None
        self._context = context
        self._details = details
        self._settings = settings
        self._log_cmd = log_cmd
        self._retries = 0
        # What OnShutdown has started runs, as upstream, unless the end was there before its event.
        self._is_of_the_end = isinstance(context.get_locals_as_dict().get('event'), Shutdown)
        self._logger = get_logger(details['name'])
        self._cmd = printable_command(details['cmd'])
        loggers = get_output_loggers(details['name'], settings.output)
        self.outputs = [_Output(logger, format_line, cached=cached) for logger in loggers]
        self._hides_stdout = launch_config.get_screen_handler() not in loggers[0].handlers
        self.child: ChildProcess | None = None
        self.return_code: int | None = None
        self.timers: list[TimerAction] = []
        self.completed: asyncio.Future[None] = context.asyncio_loop.create_future()
        self.shutdown: asyncio.Future[None] = context.asyncio_loop.create_future()
        self._task = context.asyncio_loop.create_task(self._run())

    async def _run(self) -> None:
        try:
            while await self._run_once():
                self._retries += 1
                self.child = None
        except Exception as error:
            self.completed.set_exception(error)
        finally:
            for timer in self.timers:
                timer.cancel()
            if not self.completed.done():
                self.completed.set_result(None)

    async def _run_once(self) -> bool:
        """Run the process to its end and return whether it is to run again."""
        if self._context.is_shutdown and not self._is_of_the_end:
            return False  # an error came before this task had its turn
        if self._log_cmd:
            cwd = self._details['cwd']
            # Upstream's words; there, too, each process has an environment that is made for it.
            self._logger.info(f"process details: cmd='{self._cmd}', cwd='{cwd}', custom_env?=True")
        try:
            child = await self._start()
        except (OSError, ValueError) as error:
            self._logger.error(f"cannot start the process: {error}, cmd '{self._cmd}'")
            return False
        self.return_code = await child.complete
        for output in self.outputs:
            output.flush()
        self._report_end(child.pid, self.return_code)
        event = ProcessExited(returncode=self.return_code, **self._details)
        self._context.emit_event_sync(event)
        return await self._is_to_respawn()

    def _report_end(self, pid: int, code: int) -> None:
        if code == 0:
            self._logger.info(f'process has finished cleanly [pid {pid}]')
        else:
            self._logger.error(
                f"process has died [pid {pid}, exit code {code}, cmd '{self._cmd}']."
            )

    async def _start(self) -> ChildProcess:
        return await start_child_process(
            self._details['cmd'],
            on_output=self._on_output,
            on_started=self._on_started,
            cwd=self._details['cwd'],
            env=self._details['env'],
            shell=self._settings.shell,
            emulate_tty=self._settings.emulate_tty,
        )

    async def _is_to_respawn(self) -> bool:
        if not self._settings.respawns(self._retries):
            return False
        if self._settings.respawn_delay:
            await asyncio.wait((self.shutdown,), timeout=self._settings.respawn_delay)
        return not (self._context.is_shutdown or self.shutdown.done())

    def _on_started(self, child: ChildProcess) -> None:
        self.child = child
        self._details['pid'] = child.pid
        self._logger.info(f'process started with pid [{child.pid}]')
        self._context.emit_event_sync(ProcessStarted(**self._details))

    def _on_output(self, fd: int, data: bytes) -> None:
        kind = ProcessStdout if fd == 1 else ProcessStderr
        event = kind(text=data, **self._details)
        if self._context.would_handle_event(event):
            self._context.emit_event_sync(event)
        self.outputs[fd - 1].feed(data)
        if fd == 1 and self._hides_stdout:  # as by default, while its log messages are shown
            self._hides_stdout = False
            self._logger.info(
                "what it prints goes to the log alone; output='screen' in the launch file shows it"
            )

    def send_signal(self, number: signal.Signals) -> None:
        """Send a signal to the process where it runs.

        :raises RuntimeError: it has never run.
        """
        name = self._details['name']
        if 'pid' not in self._details:
            raise RuntimeError(
                f"signal '{number.name}' for process[{name}] came before it was started: send it "
                'on its OnProcessStart'
            )
        if self.child is None or self.child.complete.done():
            return
        self._logger.info(f"sending signal '{number.name}' to process[{name}]")
        try:
            self.child.send_signal(number)
        except ProcessLookupError:
            self._logger.debug(f"signal '{number.name}' not sent: it has ended")
