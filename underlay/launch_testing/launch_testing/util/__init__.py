# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Find processes, and keep a launch alive."""

import sys

from launch.actions import ExecuteProcess

from .proc_lookup import NO_CMD_ARGS, NoMatchingProcessException, resolveProcesses

__all__ = ['NO_CMD_ARGS', 'KeepAliveProc', 'NoMatchingProcessException', 'resolveProcesses']

_SLEEPER = """
import contextlib, time
with contextlib.suppress(KeyboardInterrupt):
    while True:
        time.sleep(3600)
"""


def KeepAliveProc() -> ExecuteProcess:
    """Return an action that keeps a launch going when the processes under test have ended."""
    return ExecuteProcess(cmd=[sys.executable, '-c', _SLEEPER])
