# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The output of a command."""

from __future__ import annotations

import shlex
import subprocess

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..logging import get_logger
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import MarkupArguments, Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .substitution_failure import SubstitutionFailure

_ON_STDERR = ('fail', 'ignore', 'warn', 'capture')


@expose_substitution('command')
class Command(Substitution):
    """Becomes what a command writes to standard output; runs when it is performed.

    :param on_stderr: what to do where it writes to standard error: 'fail', 'ignore', 'warn' or
        'capture' (that output follows the other).
    """

    _arguments = MarkupArguments(
        'command', 'on_stderr', required=1, of='command substitution', error=ValueError
    )

    def __init__(
        self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = 'fail'
    ) -> None:
        self.command = normalize_to_list_of_substitutions(command)
        self.on_stderr = normalize_to_list_of_substitutions(on_stderr)

    def describe(self) -> str:
        return f'Command({" + ".join(sub.describe() for sub in self.command)})'

    def perform(self, context: LaunchContext) -> str:
        command = perform_substitutions(context, self.command)
        on_stderr = perform_substitutions(context, self.on_stderr)
        if on_stderr not in _ON_STDERR:
            raise SubstitutionFailure(
                f"'on_stderr' is '{on_stderr}', expected one of: {', '.join(_ON_STDERR)}"
            )
        try:
            done = subprocess.run(
                shlex.split(command),
                capture_output=True,
                text=True,
                env=dict(context.environment),
                check=False,
            )
        except FileNotFoundError as error:
            raise SubstitutionFailure(f'file not found: {error}') from None
        except (OSError, ValueError) as error:
            raise SubstitutionFailure(f'cannot run command {command!r}: {error}') from None
        if done.returncode != 0:
            raise SubstitutionFailure(
                f'executed command failed. Command: {command}\n'
                f'Captured stderr output: {done.stderr}'
            )
        return _output(done, command, on_stderr)


def _output(done: subprocess.CompletedProcess[str], command: str, on_stderr: str) -> str:
    if done.stderr:
        said = f'executed command showed stderr output. Command: {command}\n'
        said += f'Captured stderr output:\n{done.stderr}'
        if on_stderr == 'fail':
            raise SubstitutionFailure(said)
        if on_stderr == 'warn':
            get_logger('launch.substitutions.Command').warning(said)
        elif on_stderr == 'capture':
            return done.stdout + done.stderr
    return done.stdout
