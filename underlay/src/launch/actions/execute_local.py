# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a process and look after it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
import signal
from typing import Any

from ..action import Action
from ..child_process import ChildProcess, printable_command, start_child_process
from ..descriptions import Executable
from ..event import Event
from ..event_handler import EventHandler
from ..event_handlers import OnProcessExit, OnProcessStart, OnShutdown
from ..events import Shutdown
from ..events.process import (
    ProcessExited,
    ProcessStarted,
    ProcessStderr,
    ProcessStdin,
    ProcessStdout,
    ShutdownProcess,
    SignalProcess,
)
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..logging import get_logger, get_output_loggers
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from .escalation import emit_signal, escalation_timers, late_sigint, terminal_reaches_children
from .opaque_function import OpaqueFunction
from .process_output import ProcessOutput
from .process_settings import ProcessSettings, SIGKILL_TIMEOUT, SIGTERM_TIMEOUT
from .timer_action import TimerAction

_Entities = list[LaunchDescriptionEntity] | None


class ExecuteLocal(Action):
    """Starts a process on this machine, logs its output and ends it with the launch.

    :param sigterm_timeout: seconds after SIGINT until SIGTERM.
    :param sigkill_timeout: seconds after SIGTERM until SIGKILL.
    :param emulate_tty: let the process believe that it writes to a terminal.
    :param output: see :func:`launch.logging.get_output_loggers`; the environment variable
        OVERRIDE_LAUNCH_PROCESS_OUTPUT wins.
    :param output_format: of a line, with ``{line}`` and ``{this}``.
    :param cached_output: keep the output for get_stdout() and get_stderr().
    :param on_exit: actions, or a function of the event and the context that returns some.
    :param respawn: start it again when it has ended by itself.
    :param respawn_max_retries: how often at most; any negative number: without end.
    """

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: Any = False,
        sigterm_timeout: float | SomeSubstitutionsType = SIGTERM_TIMEOUT,
        sigkill_timeout: float | SomeSubstitutionsType = SIGKILL_TIMEOUT,
        emulate_tty: Any = False,
        output: SomeSubstitutionsType | Mapping[str, Any] = 'log',
        output_format: str = '[{this.process_description.final_name}] {line}',
        cached_output: bool = False,
        log_cmd: bool = False,
        on_exit: Any = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | SomeSubstitutionsType | None = None,
        respawn_max_retries: int | SomeSubstitutionsType = -1,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__process_description = process_description
        self.__settings = ProcessSettings(
            shell=shell,
            sigterm_timeout=sigterm_timeout,
            sigkill_timeout=sigkill_timeout,
            emulate_tty=emulate_tty,
            output=output,
            respawn=respawn,
            respawn_delay=respawn_delay,
            respawn_max_retries=respawn_max_retries,
        )
        self.__output_format = output_format
        self.__cached_output = cached_output
        self.__log_cmd = log_cmd
        self.__on_exit = on_exit
        self.__respawn_retries = 0
        self.__process_event_args: dict[str, Any] | None = None
        self.__child: ChildProcess | None = None
        self.__outputs: dict[int, ProcessOutput] = {}
        self.__handlers: list[Any] = []
        self.__timers: list[TimerAction] = []
        self.__completed: asyncio.Future[None] | None = None
        self.__shutdown: asyncio.Future[None] | None = None
        self.__return_code: int | None = None

    @property
    def process_description(self) -> Executable:
        return self.__process_description

    @property
    def shell(self) -> Any:
        return self.__settings.shell

    @property
    def emulate_tty(self) -> Any:
        return self.__settings.emulate_tty

    @property
    def sigkill_timeout(self) -> list[Substitution]:
        return self.__settings.sigkill_timeout

    @property
    def sigterm_timeout(self) -> list[Substitution]:
        return self.__settings.sigterm_timeout

    @property
    def output(self) -> Any:
        return self.__settings.output

    @property
    def process_details(self) -> dict[str, Any] | None:
        """Name, cmd, cwd, env and (once started) pid of the process, None before execution."""
        return self.__process_event_args

    @property
    def return_code(self) -> int | None:
        return self.__return_code

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        return self.__completed

    def get_stdout(self) -> str:
        return self.__get_cached(1, 'stdout')

    def get_stderr(self) -> str:
        return self.__get_cached(2, 'stderr')

    def __get_cached(self, fd: int, name: str) -> str:
        if not self.__cached_output:
            raise RuntimeError(f'cached_output must be true to be able to get {name}')
        return self.__outputs[fd].text if fd in self.__outputs else ''

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return self.__on_exit if isinstance(self.__on_exit, list) else []

    # ---- execution ----

    def prepare(self, context: LaunchContext) -> None:
        """Perform the substitutions; subclasses add to it."""
        description = self.__process_description
        description.prepare(context, self)
        self.__process_event_args = {
            'action': self,
            'name': description.final_name,
            'cmd': description.final_cmd,
            'cwd': description.final_cwd,
            'env': description.final_env,
        }
        self.__settings.perform(context)

    def execute(self, context: LaunchContext) -> _Entities:
        if self.__process_event_args is not None:
            raise RuntimeError(
                f"{type(self).__name__} action '{self.__process_description.final_name}': "
                'executed more than once'
            )
        self.prepare(context)
        if context.is_shutdown:
            return None
        name = str(self.__process_description.final_name)
        for fd, logger in enumerate(get_output_loggers(name, self.__settings.output), start=1):
            self.__outputs[fd] = ProcessOutput(
                logger, self.__format_line, cached=self.__cached_output
            )
        assert context.asyncio_loop is not None
        self.__completed = context.asyncio_loop.create_future()
        self.__shutdown = context.asyncio_loop.create_future()
        self.__register_handlers(context)
        context.asyncio_loop.create_task(self.__run(context))
        return None

    def __format_line(self, line: str) -> str:
        return self.__output_format.format(line=line, this=self)

    def __register_handlers(self, context: LaunchContext) -> None:
        functions: dict[type[Event], Callable[[LaunchContext], Any]] = {
            ShutdownProcess: self.__on_shutdown_process,
            SignalProcess: self.__on_signal_process,
            ProcessStdin: self.__on_stdin,
        }
        for kind, function in functions.items():
            self.__handlers.append(
                EventHandler(matcher=_matches(kind), entities=OpaqueFunction(function=function))
            )
        self.__handlers.append(OnShutdown(on_shutdown=self.__on_launch_shutdown))
        if self.__on_exit is not None:
            self.__handlers.append(OnProcessExit(target_action=self, on_exit=self.__on_exit))
        for handler in self.__handlers:
            context.register_event_handler(handler)

    @property
    def __details(self) -> dict[str, Any]:
        assert self.__process_event_args is not None
        return self.__process_event_args

    async def __run(self, context: LaunchContext) -> None:
        """Start the process, as often as it is to be, and see it end."""
        try:
            while await self.__run_once(context):
                self.__respawn_retries += 1
                self.__child = None
        finally:
            for timer in self.__timers:
                timer.cancel()
            assert self.__completed is not None
            if not self.__completed.done():
                self.__completed.set_result(None)

    async def __run_once(self, context: LaunchContext) -> bool:
        """Run the process to its end and return whether it is to run again."""
        details = self.__details
        logger = get_logger(details['name'])
        cmd = printable_command(details['cmd'])
        if self.__log_cmd:
            logger.info(f"process details: cmd='{cmd}', cwd='{details['cwd']}'")
        try:
            child = await self.__start(context)
        except (OSError, ValueError) as error:
            logger.error(f"cannot start the process: {error}, cmd '{cmd}'")
            return False
        pid = child.pid
        returncode = await child.complete
        self.__return_code = returncode
        for output in self.__outputs.values():
            output.flush()
        if returncode == 0:
            logger.info(f'process has finished cleanly [pid {pid}]')
        else:
            logger.error(f"process has died [pid {pid}, exit code {returncode}, cmd '{cmd}'].")
        context.emit_event_sync(ProcessExited(returncode=returncode, **details))
        return await self.__is_to_respawn(context)

    async def __start(self, context: LaunchContext) -> ChildProcess:
        details = self.__details
        return await start_child_process(
            details['cmd'],
            on_output=lambda fd, data: self.__on_output(context, fd, data),
            on_started=lambda child: self.__on_started(context, child),
            cwd=details['cwd'],
            env=details['env'],
            shell=self.__settings.shell,
            emulate_tty=self.__settings.emulate_tty,
        )

    async def __is_to_respawn(self, context: LaunchContext) -> bool:
        assert self.__shutdown is not None
        if not self.__settings.respawns(self.__respawn_retries):
            return False
        if self.__settings.respawn_delay:
            await asyncio.wait((self.__shutdown,), timeout=self.__settings.respawn_delay)
        return not (context.is_shutdown or self.__shutdown.done())

    def __on_started(self, context: LaunchContext, child: ChildProcess) -> None:
        self.__child = child
        self.__details['pid'] = child.pid
        get_logger(self.__details['name']).info(f'process started with pid [{child.pid}]')
        context.emit_event_sync(ProcessStarted(**self.__details))

    def __on_output(self, context: LaunchContext, fd: int, data: bytes) -> None:
        kind = ProcessStdout if fd == 1 else ProcessStderr
        event = kind(text=data, **self.__details)
        if context.would_handle_event(event):
            context.emit_event_sync(event)
        self.__outputs[fd].feed(data)

    # ---- events ----

    def __on_stdin(self, context: LaunchContext) -> None:
        event = context.locals.event
        if event.action is self and self.__child is not None:
            self.__child.write(event.text)

    def __on_shutdown_process(self, context: LaunchContext) -> _Entities:
        if not context.locals.event.process_matcher(self):
            return None
        return self._shutdown_process(context, send_sigint=True)

    def __on_launch_shutdown(self, event: Shutdown, context: LaunchContext) -> _Entities:
        by_terminal = event.due_to_sigint and not context.noninteractive
        actions = self._shutdown_process(context, send_sigint=not by_terminal)
        if actions and by_terminal and not terminal_reaches_children():
            late = late_sigint(self)
            self.__timers.append(late)
            actions.append(late)
        return actions

    def __on_signal_process(self, context: LaunchContext) -> None:
        event = context.locals.event
        if not event.process_matcher(self):
            return
        if self.__child is None or self.__child.complete.done():
            return
        name = self.__details['name']
        get_logger(name).info(f"sending signal '{event.signal_name}' to process[{name}]")
        try:
            self.__child.send_signal(event.signal)
        except ProcessLookupError:
            get_logger(name).debug(f"signal '{event.signal_name}' not sent: it has ended")

    def _shutdown_process(self, context: LaunchContext, *, send_sigint: bool) -> _Entities:
        """Begin to end the process; return the actions that do it."""
        if self.__shutdown is None or self.__shutdown.done():
            return None
        assert self.__completed is not None
        if self.__completed.done():
            self.__shutdown.set_result(None)
            return None
        if self.__child is None:
            # It is just being started: end it as soon as it runs.
            context.register_event_handler(
                OnProcessStart(
                    target_action=self,
                    on_start=lambda _event, context: self._shutdown_process(
                        context, send_sigint=True
                    ),
                    handle_once=True,
                )
            )
            return None
        self.__shutdown.set_result(None)
        if self.__child.complete.done():
            return None
        self.__timers = escalation_timers(
            self,
            self.__details['name'],
            sigterm_sec=self.__settings.sigterm_sec,
            sigkill_sec=self.__settings.sigkill_sec,
        )
        actions: list[LaunchDescriptionEntity] = list(self.__timers)
        if send_sigint:
            actions.append(emit_signal(self, signal.SIGINT))
        return actions


def _matches(kind: type[Event]) -> Callable[[Event], bool]:
    return lambda event: isinstance(event, kind)
