# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What colcon is told of the commands of a setup.py, without starting it."""

from __future__ import annotations

import asyncio
import os
from pathlib import Path

from colcon_core.task.python import build
from colcon_core.task.python.build import PythonBuildTask
import colcon_known_commands
import pytest

PLAIN = "from setuptools import setup\n\nsetup(name='one', version='0.0.0')\n"


class StartedError(Exception):
    """A setup.py is started."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / 'setup.py').write_text(PLAIN)
    return tmp_path


async def _refuse_to_start(*_: object, **__: object) -> bytes:
    raise StartedError


def commands(folder: Path) -> set[str]:
    task = PythonBuildTask()
    return asyncio.run(task._get_available_commands(str(folder), dict(os.environ)))


def options(folder: Path) -> set[str]:
    task = PythonBuildTask()
    return asyncio.run(task._get_available_options(str(folder), dict(os.environ), 'develop'))


def test_a_plain_setup_py_is_not_started(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build, 'check_output', _refuse_to_start)
    (folder / 'setup.cfg').write_text('[develop]\nscript_dir=$base/lib/one\n')
    assert {'develop', 'egg_info'} <= commands(folder)
    assert '--editable' in options(folder)


def test_what_is_known_is_what_a_setup_py_would_say(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = commands(folder), options(folder)
    monkeypatch.setattr(colcon_known_commands, '_KNOWN', False)
    asked = commands(folder), options(folder)
    assert len(asked[0]) > len(known[0]), 'it was asked'
    assert known[0] <= asked[0]
    assert known[1] <= asked[1]


@pytest.mark.parametrize(
    ('file', 'text'),
    [
        ('setup.py', 'from distutils.core import setup\nsetup(name="one")\n'),
        ('setup.py', PLAIN.replace("'0.0.0'", "'0.0.0', cmdclass={}")),
        ('setup.py', f'import sys\nif "--help-commands" in sys.argv: sys.exit()\n{PLAIN}'),
        ('setup.py', '# \udcff\n' + PLAIN),
        ('setup.cfg', '[options]\ncmdclass =\n    develop = own.Develop\n'),
        ('pyproject.toml', '[tool.setuptools.cmdclass]\ndevelop = "own.Develop"\n'),
    ],
)
def test_one_with_commands_of_its_own_is_asked(
    folder: Path, monkeypatch: pytest.MonkeyPatch, file: str, text: str
) -> None:
    monkeypatch.setattr(build, 'check_output', _refuse_to_start)
    (folder / file).write_text(text, errors='surrogateescape')
    for ask in (commands, options):
        with pytest.raises(StartedError):
            ask(folder)


def test_options_of_other_commands_are_asked_for(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(build, 'check_output', _refuse_to_start)
    with pytest.raises(StartedError):
        asyncio.run(PythonBuildTask()._get_available_options(str(folder), {}, 'build'))
