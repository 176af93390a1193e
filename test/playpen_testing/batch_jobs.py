# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Jobs for tests of workers; a worker that has one loads neither MuJoCo nor pytest."""

from collections.abc import Callable
from dataclasses import dataclass
import hashlib
import json
import os
from pathlib import Path
import signal
from tempfile import mkdtemp
import time

from husky_grader.batch.job import Outcome


@dataclass(frozen=True)
class Generated:
    """A job whose result is a function of its name, as a real one's is of what was handed in."""

    name: str

    result_file = 'result.json'

    def key(self) -> str:
        return f'key of {self.name}'

    def is_result(self, content: object) -> bool:
        return isinstance(content, dict)

    def forget(self, folder: Path) -> None:
        (folder / self.result_file).unlink(missing_ok=True)

    def run(self, folder: Path, alive: Callable[[], object]) -> Outcome:
        alive()
        folder.mkdir(parents=True, exist_ok=True)
        content = self.content()
        (folder / self.result_file).write_text(json.dumps(content))
        return Outcome(content)

    def content(self) -> dict[str, int]:
        return {'score': int(hashlib.sha256(self.name.encode()).hexdigest()[:4], 16)}


@dataclass(frozen=True)
class OwnEnd(Generated):
    """A job that tells its process, or ends it by a signal."""

    by: int = 0

    def run(self, _folder: Path, _alive: Callable[[], object]) -> Outcome:
        if self.by:
            os.kill(os.getpid(), self.by)
        os.kill(os.getpid(), signal.SIGINT)  # as Ctrl-C does, which the grader itself hears
        return Outcome({'process': os.getpid()})


@dataclass(frozen=True)
class Long(Generated):
    """A job that writes its process and a temporary folder into its folder, and does not end."""

    def run(self, folder: Path, _alive: Callable[[], object]) -> Outcome:
        (folder / f'{self.name}.pid').write_text(f'{os.getpid()} {mkdtemp()}\n')
        time.sleep(600.0)
        return Outcome(None)
