# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a program."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
import shlex
from typing import Any

from ..action import Action
from ..descriptions import Executable
from ..frontend import Entity, expose_action, Parser
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..substitutions import TextSubstitution
from .execute_local import ExecuteLocal
from .shutdown_action import Shutdown

_MARK = 0xF0000
_TEXTS = {
    'cwd': 'cwd',
    'name': 'name',
    'launch-prefix': 'prefix',
    'output': 'output',
}
_TYPED = {
    'respawn': bool,
    'respawn_delay': float,
    'respawn_max_retries': int,
    'sigkill_timeout': float,
    'sigterm_timeout': float,
    'shell': bool,
    'emulate_tty': bool,
}


def _unmark(word: str, parts: Sequence[Substitution]) -> list[Substitution]:
    """Return a word with its marks replaced by the substitutions they stand for."""
    found: list[Substitution] = []
    plain = ''
    for character in word:
        index = ord(character) - _MARK
        if 0 <= index < len(parts):
            if plain:
                found.append(TextSubstitution(text=plain))
                plain = ''
            found.append(parts[index])
        else:
            plain += character
    if plain or not found:
        found.append(TextSubstitution(text=plain))
    return found


@expose_action('executable')
class ExecuteProcess(ExecuteLocal):
    """Runs a program; see ExecuteLocal and Executable for the arguments."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        additional_env: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        executable = Executable(
            cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env
        )
        super().__init__(process_description=executable, **kwargs)

    @classmethod
    def _parse_cmdline(cls, cmd: str, parser: Parser) -> list[list[Substitution]]:
        """Split a command line at its spaces, but not inside of substitutions and quotes."""
        parts = parser.parse_substitution(cmd)
        marked = ''
        for index, sub in enumerate(parts):
            # A character of the private area stands for a substitution while words are split.
            marked += sub.text if isinstance(sub, TextSubstitution) else chr(_MARK + index)
        return [_unmark(word, parts) for word in shlex.split(marked)]

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: list[str] | None = None
    ) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments.

        :param ignore: attributes that a derived class reads itself.
        """
        kwargs = Action.parse(entity, parser)[1]
        ignored = set(ignore or ())
        if 'cmd' not in ignored:
            kwargs['cmd'] = cls._parse_cmdline(entity.get_attr('cmd'), parser)
        for attribute, keyword in _TEXTS.items():
            text = None if attribute in ignored else entity.get_attr(attribute, optional=True)
            if text is not None:
                kwargs[keyword] = parser.parse_substitution(text)
        for attribute, kind in _TYPED.items():
            if attribute not in ignored:
                value = entity.get_attr(attribute, data_type=kind, optional=True)
                if isinstance(value, str):  # as 'true' in YAML: what it means is found when run
                    value = parser.parse_substitution(value)
                if value is not None:
                    kwargs[attribute] = value
        if 'on_exit' not in ignored:
            on_exit = entity.get_attr('on_exit', optional=True)
            if on_exit == 'shutdown':
                kwargs['on_exit'] = [Shutdown()]
            elif on_exit is not None:
                raise ValueError(
                    f"Attribute on_exit of Entity {entity.type_name} expected to be 'shutdown' "
                    f'but got `{on_exit}`'
                )
        if 'env' not in ignored:
            pairs = parser.parse_pairs(entity, 'env', 'name', 'value')
            if pairs:
                kwargs['additional_env'] = {tuple(name): value for name, value in pairs}
        return cls, kwargs

    @property
    def name(self) -> Any:
        """The name of the process once it is prepared, before that what it is made of."""
        description = self.process_description
        return description.name if description.final_name is None else description.final_name

    @property
    def cmd(self) -> list[Any]:
        """The words of the command once it is prepared, before that what they are made of."""
        description = self.process_description
        return description.cmd if description.final_cmd is None else list(description.final_cmd)

    @property
    def cwd(self) -> Any:
        description = self.process_description
        return description.cwd if description.final_cwd is None else description.final_cwd

    @property
    def env(self) -> Any:
        return self.process_description.env

    @property
    def additional_env(self) -> Any:
        return self.process_description.additional_env
