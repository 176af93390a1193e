# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A program with its arguments and environment."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
import itertools
from pathlib import Path
import re
import shlex
from typing import TYPE_CHECKING

from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..substitutions import LaunchConfiguration
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..action import Action

_process_numbers = itertools.count(1)

_Pairs = list[tuple[list[Substitution], list[Substitution]]]
_Env = Mapping[SomeSubstitutionsType, SomeSubstitutionsType]


def _normalize_env(env: _Env | None) -> _Pairs | None:
    if env is None:
        return None
    return [
        (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
        for name, value in env.items()
    ]


def _perform_env(context: LaunchContext, pairs: _Pairs) -> dict[str, str]:
    return {
        perform_substitutions(context, name): perform_substitutions(context, value)
        for name, value in pairs
    }


class Executable:
    """What a process is started with.

    :param cmd: program and arguments; each may be several texts and substitutions, joined.
    :param prefix: words to go before, as of a debugger; default: launch configuration
        ``launch-prefix``, where the program matches ``launch-prefix-filter``.
    :param env: the whole environment; default: that of the launch.
    :param additional_env: variables on top of it.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: _Env | None = None,
        additional_env: _Env | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        if isinstance(cmd, str):  # upstream takes each letter for a word
            raise TypeError(f'cmd={cmd!r}: it is a list of words, as {cmd.split()}')
        self.cmd = [normalize_to_list_of_substitutions(part) for part in cmd]
        self.arguments = [normalize_to_list_of_substitutions(part) for part in arguments or ()]
        self.__prefix_filter: list[Substitution] = []
        if prefix is None:
            prefix = LaunchConfiguration('launch-prefix', default='')
            self.__prefix_filter = [LaunchConfiguration('launch-prefix-filter', default='')]
        self.prefix = normalize_to_list_of_substitutions(prefix)
        self.name = None if name is None else normalize_to_list_of_substitutions(name)
        self.cwd = None if cwd is None else normalize_to_list_of_substitutions(cwd)
        self.env = _normalize_env(env)
        self.additional_env = _normalize_env(additional_env)
        # The unique name of the process and the rest, once prepared.
        self.final_name: str | None = None
        self.final_cmd: list[str] | None = None
        self.final_cwd: str | None = None
        self.final_env: dict[str, str] | None = None

    def prepare(self, context: LaunchContext, action: Action) -> None:
        """Perform the substitutions and give the process its name."""
        del action
        parts = self.cmd + self.arguments
        cmd = [perform_substitutions(context, part) for part in parts]
        if not cmd or not cmd[0].strip():
            raise ValueError(f'the command {cmd} is empty: its first item is the program')
        self.final_cmd = self.__prefix_words(context, Path(cmd[0]).name) + cmd
        name = Path(self.final_cmd[0]).name
        if self.name is not None:
            name = perform_substitutions(context, self.name)
        self.final_name = f'{name}-{next(_process_numbers)}'
        if self.cwd is not None:
            self.final_cwd = str(Path(perform_substitutions(context, self.cwd)).expanduser())
        env = dict(context.environment) if self.env is None else _perform_env(context, self.env)
        env.update(_perform_env(context, self.additional_env or []))
        self.final_env = env

    def __prefix_words(self, context: LaunchContext, program: str) -> list[str]:
        words = shlex.split(perform_substitutions(context, self.prefix))
        pattern = perform_substitutions(context, self.__prefix_filter)
        if pattern and re.match(pattern, program) is None:
            return []
        return words
