# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How a process is run, from what the user wrote to values."""

from __future__ import annotations

from collections.abc import Mapping
import os
from typing import Any

from ..conditions import evaluate_condition_expression
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..substitutions import LaunchConfiguration
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ..utilities.type_utils import normalize_typed_substitution, perform_typed_substitution

SIGTERM_TIMEOUT = LaunchConfiguration('sigterm_timeout', default=5)
SIGKILL_TIMEOUT = LaunchConfiguration('sigkill_timeout', default=5)


def normalize_seconds(value: float | SomeSubstitutionsType) -> list[Substitution]:
    """Return a number, or what becomes one, as substitutions."""
    if isinstance(value, (int, float)):
        value = str(value)
    return normalize_to_list_of_substitutions(value)


def perform_seconds(context: LaunchContext, subs: list[Substitution], name: str) -> float:
    """Return a time in seconds.

    :raises ValueError: the text is no such time.
    """
    text = perform_substitutions(context, subs)
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not 0.0 <= seconds < float('inf'):
        raise ValueError(f"{name} is '{text}': it is a time in seconds, as 5 or 0.5")
    return seconds


class ProcessSettings:
    """The arguments of ExecuteLocal that hold substitutions."""

    def __init__(
        self,
        *,
        shell: Any,
        sigterm_timeout: float | SomeSubstitutionsType,
        sigkill_timeout: float | SomeSubstitutionsType,
        emulate_tty: Any,
        output: SomeSubstitutionsType | Mapping[str, Any],
        respawn: Any,
        respawn_delay: float | SomeSubstitutionsType | None,
        respawn_max_retries: Any,
    ) -> None:
        self.sigterm_timeout = normalize_seconds(sigterm_timeout)
        self.sigkill_timeout = normalize_seconds(sigkill_timeout)
        self.sigterm_sec = self.sigkill_sec = 0.0
        output = os.environ.get('OVERRIDE_LAUNCH_PROCESS_OUTPUT') or output
        self.output: Any = output
        if not isinstance(output, Mapping):
            self.output = normalize_to_list_of_substitutions(output)
        self.shell = normalize_typed_substitution(shell, bool)
        self.emulate_tty = normalize_typed_substitution(emulate_tty, bool)
        self.respawn = normalize_typed_substitution(respawn, bool)
        self.respawn_max_retries = normalize_typed_substitution(respawn_max_retries, int)
        self.respawn_delay: Any = respawn_delay
        if respawn_delay is not None:
            self.respawn_delay = normalize_seconds(respawn_delay)

    def perform(self, context: LaunchContext) -> None:
        """Replace what holds substitutions by values."""
        self.sigterm_sec = perform_seconds(context, self.sigterm_timeout, 'sigterm_timeout')
        self.sigkill_sec = perform_seconds(context, self.sigkill_timeout, 'sigkill_timeout')
        if not isinstance(self.output, Mapping):
            self.output = perform_substitutions(context, self.output)
        if 'emulate_tty' in context.launch_configurations:
            configured = str(context.launch_configurations['emulate_tty'])
            expression = normalize_to_list_of_substitutions(configured)
            self.emulate_tty = evaluate_condition_expression(context, expression)
        self.emulate_tty = perform_typed_substitution(context, self.emulate_tty, bool)
        self.shell = perform_typed_substitution(context, self.shell, bool)
        self.respawn = perform_typed_substitution(context, self.respawn, bool)
        self.respawn_max_retries = perform_typed_substitution(
            context, self.respawn_max_retries, int
        )
        if self.respawn_delay is not None:
            self.respawn_delay = perform_seconds(context, self.respawn_delay, 'respawn_delay')

    def respawns(self, retries: int) -> bool:
        """Return whether the process is to run again after so many times."""
        limit = self.respawn_max_retries
        return self.respawn and (limit < 0 or retries < limit)
