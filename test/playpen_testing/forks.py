# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run programs, each in a process of its own, that share the time of one start and its imports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import json
from pathlib import Path
import subprocess
import sys
from tempfile import TemporaryDirectory

from playpen_testing.fast_dds import without_port_race

_LIMIT_SEC = 20
_KINDS = ('out', 'err')
_RUNNER = """
import importlib, json, os, signal, sys
for module in sys.argv[4:]:
    importlib.import_module(module)
programs = [(importlib.import_module(module), words) for module, words in json.loads(sys.argv[1])]
for number, (module, words) in enumerate(programs):
    child = os.fork()
    if not child:
        signal.alarm(int(sys.argv[2]))
        for descriptor, name in ((1, 'out'), (2, 'err')):
            flags = os.O_CREAT | os.O_WRONLY | os.O_APPEND
            os.dup2(os.open(os.path.join(sys.argv[3], f'{number}.{name}'), flags), descriptor)
        sys.argv[:] = [module.__file__, *words]
        sys.exit(module.main())
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""


@dataclass(frozen=True)
class Ended:
    """What a program has printed, and its exit status: -14 where it did not end by itself."""

    status: int
    out: str
    err: str


def run_forked(*commands: Sequence[str], preload: Sequence[str] = ()) -> list[Ended]:
    """
    Run the main() of modules, one after another.

    :param commands: of each the name of the module, and its arguments.
    :param preload: modules that all of them share, besides those that they import at once.
    """
    programs = json.dumps([(command[0], command[1:]) for command in commands])
    with TemporaryDirectory() as folder:

        def read(name: str) -> str:
            return without_port_race(Path(folder, name).read_text())

        answer = subprocess.run(
            [sys.executable, '-c', _RUNNER, programs, str(_LIMIT_SEC), folder, *preload],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
        )
        statuses = [int(line) for line in answer.stdout.split()]
        assert len(statuses) == len(commands), answer.stderr
        return [
            Ended(status, *(read(f'{number}.{kind}') for kind in _KINDS))
            for number, status in enumerate(statuses)
        ]
