# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The steps that are judged on a running program: publisher, subscriber and service."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
import json
import os
from pathlib import Path
import pickle
import shlex
from tempfile import TemporaryDirectory

from husky_runtime.children import ChildProcess, tail_of

from husky_grader.graded import RUN_WITH
from husky_grader.jail import JailedProcess
from husky_grader.lab.build_step import NO_PROGRAM
from husky_grader.lab.finding import Finding, nothing
from husky_grader.lab.hiding import hiding
from husky_grader.lab.misplaced import misplaced
from husky_grader.lab.observed import FINDING_FILE, OVER_FILE, STEP_FILE
from husky_grader.lab.patience import Patience
from husky_grader.lab.programs import given_words, Programs, wrong_first_line
from husky_grader.rubric.own_types import with_types
from husky_grader.rubric.steps import ProgramStep
from husky_grader.run.diagnosis import crash, how_it_ended
from husky_grader.run.live import CHECK_FIELDS
from husky_grader.run.printed import read_printed
from husky_grader.run.trusted import trusted

POLL_SEC = 0.05
OBSERVED_SEC = 600.0  # a node that needs longer hangs by what it was sent


class ObserverFailed(ValueError):
    """The grader's own node failed; the message says why."""


def live_step(
    step: ProgramStep, programs: Programs, log: Path, *, alive: Callable[[], object] = lambda: None
) -> Finding:
    """
    Run a program, and find out what it does.

    :param alive: called now and then.
    :raises PackageMissing: when the package is not there.
    :raises ProgramMissing: when the program is not there.
    :raises ObserverFailed: when the grader's own node fails.
    """
    command = programs.command_of(step)
    theirs = {**programs.environment, 'PYTHONUNBUFFERED': '1'}
    with programs.jail() as jail, jail.started(command, theirs, log=log) as program:
        # The check of fields would refuse the largest float32, which may be sent.
        ours = {**os.environ, **jail.graph, CHECK_FIELDS: '0'}
        ours = with_types(ours, programs.interfaces)
        found = _observe(step, jail.beside, ours, program, log, programs.world, alive)
        exit_code = program.exit_code
    printed = read_printed(log, without=programs.place)
    if exit_code is not None and step.executable:
        why = wrong_first_line(Path(command[0]))
        if exit_code == NO_PROGRAM and printed:
            why = why or 'there is no such program as its first line says'
        if why:
            return nothing(f'{step.executable} cannot be started: {why}')
    error = crash(printed)
    if exit_code is not None:  # what was heard may be of a daemon that it has left behind
        found = nothing(how_it_ended(exit_code, printed))
    elif found.score == 0.0 and error:  # of one of several, which ran on
        found = nothing(f'{error}; {found.why}')
    hint = hiding(error, programs.built, programs.environment)
    hint = hint or misplaced(error, programs.workspace)
    if found.score == 0.0 and hint:
        found = nothing(f'{found.why}; {hint}')
    return _with_words(found, given_words(step))


def _with_words(found: Finding, words: Sequence[str]) -> Finding:
    """Tell with what a program was run that lost points, so that its student can do the same."""
    if not words or (found.score >= 100.0 and not found.defects):
        return found
    told = f'{RUN_WITH} {shlex.join(words)}'
    if not found.defects:
        return replace(found, why=f'{found.why}; {told}')
    last = list(found.defects)[-1]
    return replace(found, defects={**found.defects, last: f'{found.defects[last]}; {told}'})


def _observe(
    step: ProgramStep,
    beside: Callable[[Sequence[str]], list[str]],
    environment: Mapping[str, str],
    program: JailedProcess,
    log: Path,
    world: str,
    alive: Callable[[], object],
) -> Finding:
    """
    Let the grader's own node find it out, a process in the network of the program.

    :param beside: makes a command one that runs there.
    :param world: of a Husky beside the program, an MJCF file; empty: the playpen.
    """
    with TemporaryDirectory() as name:
        place = Path(name)
        (place / STEP_FILE).write_bytes(pickle.dumps(step))
        command = trusted('husky_grader.lab.observer', name, str(log.absolute()), world)
        observer_log = place / 'log'
        with (
            observer_log.open('w') as stream,
            ChildProcess(beside(command), environment, stream) as observer,
        ):
            patience = Patience(OBSERVED_SEC)
            while not (observer.wait(POLL_SEC) or patience.is_over()):
                alive()
                if program.exit_code is not None:
                    (place / OVER_FILE).touch()
        if not (place / FINDING_FILE).is_file():
            why = tail_of(observer_log, 1) or 'it hangs'
            raise ObserverFailed(f'the node of the grader failed: {why}')
        return Finding(**json.loads((place / FINDING_FILE).read_text(encoding='utf-8')))
