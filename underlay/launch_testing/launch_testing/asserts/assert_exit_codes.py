# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How processes have ended."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from launch.actions import ExecuteLocal

from ..util import resolveProcesses

EXIT_OK = 0
# Of a shell whose command a signal has ended: 128 and its number.
EXIT_SIGINT = 130
EXIT_SIGQUIT = 131
EXIT_SIGKILL = 137
EXIT_SIGSEGV = 139


def assertExitCodes(
    proc_info: Any,
    allowable_exit_codes: Collection[int] = (EXIT_OK,),
    process: ExecuteLocal | str | None = None,
    cmd_args: object = None,
    *,
    strict_proc_matching: bool = True,
) -> None:
    """Assert that processes, by default all, have ended with one of the exit codes.

    The other arguments are those of resolveProcesses.

    :param proc_info: the ProcInfoHandler of a test that runs after the launch has ended.
    """
    for code in allowable_exit_codes:
        if not isinstance(code, int):
            raise AssertionError(f'Provided exit code {code!r} is not an int')
    actions = resolveProcesses(
        proc_info,
        process=process,
        cmd_args=cmd_args,
        strict_proc_matching=strict_proc_matching,
    )
    for event in [proc_info[action] for action in actions]:
        if event.returncode not in allowable_exit_codes:
            raise AssertionError(f'Proc {event.process_name} exited with code {event.returncode}')
