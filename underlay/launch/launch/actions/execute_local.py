# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a process and look after it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
import signal
from typing import Any

from ..action import Action
from ..descriptions import Executable
from ..event import Event
from ..event_handler import EventHandler
from ..event_handlers import OnProcessExit, OnProcessStart, OnShutdown
from ..events import Shutdown
from ..events.process import ProcessStdin, ShutdownProcess, SignalProcess
from ..events.shutdown import Interrupted
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution

# Not used here: launch files import them from here, as from upstream's, which an editor offered.
from ..substitutions import LaunchConfiguration, PythonExpression  # noqa: F401
from .emit_event import EmitEvent  # noqa: F401
from .escalation import emit_signal, escalation_timers, late_sigint, terminal_reaches_children
from .opaque_function import OpaqueFunction
from .process_run import ProcessRun
from .process_settings import ProcessSettings, SIGKILL_TIMEOUT, SIGTERM_TIMEOUT
from .timer_action import TimerAction  # noqa: F401

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
        self.process_description = process_description
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
        # Name, cmd, cwd, env and (once started) pid of the process, None before execution.
        self.process_details: dict[str, Any] | None = None
        self.__run: ProcessRun | None = None

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
    def return_code(self) -> int | None:
        return None if self.__run is None else self.__run.return_code

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        return None if self.__run is None else self.__run.completed

    def get_stdout(self) -> str:
        return self.__get_cached(0, 'stdout')

    def get_stderr(self) -> str:
        return self.__get_cached(1, 'stderr')

    def __get_cached(self, index: int, name: str) -> str:
        if not self.__cached_output:
            raise RuntimeError(f'cached_output must be true to be able to get {name}')
        return '' if self.__run is None else self.__run.outputs[index].text

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return self.__on_exit if isinstance(self.__on_exit, list) else []

    # ---- execution ----

    def prepare(self, context: LaunchContext) -> None:
        """Perform the substitutions; subclasses add to it."""
        description = self.process_description
        description.prepare(context, self)
        self.process_details = {
            'action': self,
            'name': description.final_name,
            'cmd': description.final_cmd,
            'cwd': description.final_cwd,
            'env': description.final_env,
        }
        self.__settings.perform(context)

    def execute(self, context: LaunchContext) -> _Entities:
        if self.process_details is not None:
            raise RuntimeError(
                f"{type(self).__name__} action '{self.process_description.final_name}': "
                'executed more than once'
            )
        self.prepare(context)
        if context.is_shutdown:
            return None
        self.__check_output_format()
        self.__register_handlers(context)
        self.__run = ProcessRun(
            context,
            self.__details,
            self.__settings,
            format_line=self.__format_line,
            cached=self.__cached_output,
            log_cmd=self.__log_cmd,
        )
        return None

    def __check_output_format(self) -> None:
        """Refuse a wrong format here, not in the middle of the output."""
        self.__details['pid'] = 0  # there will be one by then
        self.__format_line('')
        del self.__details['pid']

    def __format_line(self, line: str) -> str:
        try:
            return self.__output_format.format(line=line, this=self)
        except (LookupError, AttributeError, ValueError) as error:
            raise ValueError(
                f"output_format '{self.__output_format}' is refused: {type(error).__name__}: "
                f'{error}; allowed are {{line}} and {{this}} with its attributes'
            ) from error

    def __register_handlers(self, context: LaunchContext) -> None:
        functions: dict[type[Event], Callable[[LaunchContext], Any]] = {
            ShutdownProcess: self.__on_shutdown_process,
            SignalProcess: self.__on_signal_process,
            ProcessStdin: self.__on_stdin,
        }
        for kind, function in functions.items():
            context.register_event_handler(
                EventHandler(matcher=_matches(kind), entities=OpaqueFunction(function=function))
            )
        context.register_event_handler(OnShutdown(on_shutdown=self.__on_launch_shutdown))
        if self.__on_exit is not None:
            context.register_event_handler(
                OnProcessExit(target_action=self, on_exit=self.__on_exit)
            )

    @property
    def __details(self) -> dict[str, Any]:
        assert self.process_details is not None
        return self.process_details

    # ---- events ----

    def __on_stdin(self, context: LaunchContext) -> None:
        event = context.locals.event
        if event.action is self and self.__run is not None and self.__run.child is not None:
            self.__run.child.write(event.text)

    def __on_shutdown_process(self, context: LaunchContext) -> _Entities:
        if not context.locals.event.process_matcher(self):
            return None
        return self._shutdown_process(context, send_sigint=True)

    def __on_launch_shutdown(self, event: Shutdown, context: LaunchContext) -> _Entities:
        by_terminal = event.due_to_sigint and not context.noninteractive
        actions = self._shutdown_process(context, send_sigint=not by_terminal)
        interrupted = isinstance(event, Interrupted) and by_terminal
        if actions and self.__run and interrupted and not terminal_reaches_children():
            late = late_sigint(self)
            self.__run.timers.append(late)
            actions.append(late)
        return actions

    def __on_signal_process(self, context: LaunchContext) -> None:
        event = context.locals.event
        if event.process_matcher(self) and self.__run is not None:
            self.__run.send_signal(event.signal)

    def _shutdown_process(self, context: LaunchContext, *, send_sigint: bool) -> _Entities:
        """Begin to end the process; return the actions that do it."""
        run = self.__run
        if run is None or run.shutdown.done():
            return None
        if run.child is None:
            # It is just being started, or never will be: end it as soon as it runs.
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
        run.shutdown.set_result(None)
        if run.child.complete.done():
            return None
        run.timers = escalation_timers(
            self,
            self.__details['name'],
            sigterm_sec=self.__settings.sigterm_sec,
            sigkill_sec=self.__settings.sigkill_sec,
        )
        actions: list[LaunchDescriptionEntity] = [run.timers[0]]
        if send_sigint:
            actions.append(emit_signal(self, signal.SIGINT))
        return actions


def _matches(kind: type[Event]) -> Callable[[Event], bool]:
    return lambda event: isinstance(event, kind)
