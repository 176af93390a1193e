# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The steps that are judged on a running program: publisher, subscriber and service."""

from collections.abc import Mapping
from contextlib import ExitStack
import json
from pathlib import Path
import signal

from husky_runtime.domains import DomainError, OwnDomain

from husky_grader.lab.build_step import find_executable
from husky_grader.lab.file_steps import find_package
from husky_grader.lab.finding import Finding, nothing
from husky_grader.lab.observer import observe
from husky_grader.lab.runner import Runner
from husky_grader.rubric.steps import ProgramStep
from husky_grader.run.diagnosis import crash, shortened
from husky_grader.run.printed import read_printed


def live_step(
    step: ProgramStep,
    workspace: Path,
    runner: Runner,
    environment: Mapping[str, str],
    log: Path,
) -> Finding:
    """
    Run a program in a DDS domain of its own, and find out what it does.

    :raises PackageMissing: when the package is not there.
    :raises ProgramMissing: when the program is not there.
    :raises ValueError: when no DDS domain is free.
    """
    command = command_of(step, workspace, runner.folder)
    with ExitStack() as stack:
        try:
            domain = stack.enter_context(OwnDomain()).number
        except DomainError as error:
            raise ValueError(str(error)) from None
        theirs = {**environment, 'ROS_DOMAIN_ID': str(domain), 'PYTHONUNBUFFERED': '1'}
        try:
            program = stack.enter_context(runner.start(command, theirs, log))
        except OSError as error:
            return nothing(f'{step.executable} cannot be started: {error.strerror}')
        found = observe(step, domain, lambda: program.exit_code is not None, log)
        exit_code = program.exit_code
    if exit_code is not None and found.score == 0.0:
        return nothing(how_it_ended(exit_code, read_printed(log)))
    return found


def command_of(step: ProgramStep, workspace: Path, built: Path) -> list[str]:
    """Return the command that `ros2 run` would run, with the arguments of the step."""
    package = find_package(workspace, step.package, step.package_with).name
    command = [str(find_executable(built, package, step.executable)), *step.arguments]
    if step.parameters:
        command.append('--ros-args')
        for name, value in step.parameters.items():
            command += ['-p', f'{name}:={json.dumps(value)}']  # JSON is YAML, as rcl reads it
    return command


def how_it_ended(exit_code: int, printed: str) -> str:
    """Return why a program has ended, by its own error if it tells of one."""
    if error := crash(printed):
        return error
    how = f'exit code {exit_code}' if exit_code >= 0 else signal.Signals(-exit_code).name
    lines = printed.split('\n')
    last = next((line for line in reversed(lines) if line.strip()), '')
    return shortened(f'it ended by itself ({how})' + (f': {last.strip()}' if last else ''))
