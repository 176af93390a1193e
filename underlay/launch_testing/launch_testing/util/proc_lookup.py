# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Find the processes that a test means."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

from launch.actions import ExecuteLocal
from launch.substitutions import TextSubstitution

# Stands for a process without arguments.
NO_CMD_ARGS = object()


class NoMatchingProcessException(Exception):
    """No process that is known has what was asked for."""


class HasProcesses(Protocol):
    """What processes are looked for in: recorded output, or recorded exit codes."""

    def processes(self) -> Iterable[ExecuteLocal]:
        """Return the actions of the processes that something was recorded of."""


def resolveProcesses(
    info_obj: HasProcesses,
    *,
    process: ExecuteLocal | str | None = None,
    cmd_args: object = None,
    strict_proc_matching: bool = True,
) -> list[ExecuteLocal]:
    """Return the actions of the processes that match, at least one.

    :param process: an action, a part of a process's name, or None for every process.
    :param cmd_args: arguments that a process found by name must have: one, several, NO_CMD_ARGS
        for a process without any, or None for any.
    :param strict_proc_matching: refuse a name that several processes match.
    :raises NoMatchingProcessException: nothing matches.
    :raises LookupError: several match.
    :raises TypeError: process is none of the above.
    """
    known = list(info_obj.processes())
    if process is None:
        if not known:
            raise NoMatchingProcessException('No data recorded for any process')
        return known
    if isinstance(process, ExecuteLocal):
        if process not in known:
            raise NoMatchingProcessException(f'No data recorded for proc {_describe(process)}')
        return [process]
    if not isinstance(process, str):
        raise TypeError(
            f"process must be the action that starts it or its name, a 'str', not {process!r}"
        )
    matches = [
        each
        for each in known
        if process in name_of(each) and _has_arguments(_arguments_of(each), cmd_args)
    ]
    names = ', '.join(sorted(map(_describe, known)))
    if not matches:
        raise NoMatchingProcessException(
            f"Did not find any processes matching name '{process}' and args '{cmd_args}'. "
            f'Procs: {names}'
        )
    if strict_proc_matching and len(matches) > 1:
        raise LookupError(
            f"Found multiple processes matching name '{process}' and cmd_args '{cmd_args}'. "
            f'Procs: {names}'
        )
    return matches


def _has_arguments(arguments: list[str], wanted: object) -> bool:
    if wanted is None:
        return True
    if wanted is NO_CMD_ARGS:
        return not arguments
    words = [wanted] if isinstance(wanted, str) else wanted
    return all(word in arguments for word in words)  # type: ignore[attr-defined]


def name_of(process: ExecuteLocal) -> str:
    """Return the name of a process that was started."""
    assert process.process_details is not None
    return str(process.process_details['name'])


def _arguments_of(process: ExecuteLocal) -> list[str]:
    assert process.process_details is not None
    return list(process.process_details['cmd'][1:])


def _describe(process: ExecuteLocal) -> str:
    if process.process_details is not None:
        return ' '.join([name_of(process), *_arguments_of(process)])
    words = []
    for word in process.process_description.cmd:
        texts = [part.text for part in word if isinstance(part, TextSubstitution)]
        if len(texts) < len(word):
            return 'Unknown - Process not launched yet'
        words.append(''.join(texts))
    return ' '.join(words)
