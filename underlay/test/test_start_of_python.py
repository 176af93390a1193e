# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What every Python of the virtual environment does at its start, and what it does not."""

import os
from pathlib import Path
import subprocess
import sys
import sysconfig

import pytest

SITE = Path(sysconfig.get_path('purelib'))


def run(*options: str, environment: dict[str, str] | None = None) -> str:
    command = [sys.executable, *options]
    return subprocess.run(
        command, env=environment, check=True, capture_output=True, text=True, timeout=30.0
    ).stdout


def test_to_take_interrupts_loads_nothing_else() -> None:
    program = f"""
import os, sys, time
sys.path.append({str(SITE)!r})
before = set(sys.modules)
import interrupt_while_loading
print(*set(sys.modules) - before)
"""
    assert run('-S', '-c', program).split() == ['interrupt_while_loading']


def test_the_bootstrapper_is_not_loaded_where_it_has_nothing_to_do() -> None:
    assert 'ros_wheels_bootstrapper' not in run('-c', 'import sys; print(*sys.modules)').split()


def test_a_python_that_is_started_by_hand_finds_ros() -> None:
    by_hand = {'HOME': os.environ['HOME'], 'PATH': '/usr/bin:/bin'}
    program = 'import os, rclpy; print(os.environ["_ROS_WHEELS_BOOTSTRAP_COMPLETE"])'
    assert run('-c', program, environment=by_hand) == '1\n'


def test_one_folder_has_the_libraries_of_all_wheels() -> None:
    lib = Path(sysconfig.get_path('data')) / 'lib'
    libraries = list(SITE.glob('ros_*.libs/*'))
    assert libraries
    for library in libraries:
        assert (lib / library.name).read_bytes() == library.read_bytes()


LOGGED = """
import inspect
from rclpy.impl.rcutils_logger import CallerId
from rclpy.logging import get_logger
get_logger('test').info('said')
print(inspect.modulesbyfile, *CallerId()[:3])
"""


def test_a_line_that_is_logged_has_its_file_without_a_search(tmp_path: Path) -> None:
    program = tmp_path / 'program.py'
    program.write_text(LOGGED)
    assert run(str(program)) == f'{{}} <module> {program} 6\n'


SETUP = """
from importlib import metadata
import sys
from setuptools import setup

def counted():
    readings.append(sys.path[0])
    return read()

readings, read = [], metadata.distributions
metadata.distributions = counted
about = {'version': '0.0.0', 'py_modules': []}
setup(name='one', script_args=['-q', 'egg_info', 'build'], **about)
sys.path.insert(0, 'later')
setup(name='two', script_args=['said'], **about)
print(readings)
"""
LATER = """
from setuptools import Command

class Said(Command):
    user_options = []
    initialize_options = finalize_options = lambda self: None
    run = lambda self: print('found later')
"""


def test_a_setup_py_reads_once_what_is_installed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    about = tmp_path / 'later' / 'later-1.0.dist-info'
    about.mkdir(parents=True)
    (about / 'METADATA').write_text('Metadata-Version: 2.1\nName: later\nVersion: 1.0\n')
    (about / 'entry_points.txt').write_text('[distutils.commands]\nsaid = later:Said\n')
    (about.parent / 'later.py').write_text(LATER)
    (tmp_path / 'setup.py').write_text(SETUP)
    said = run('setup.py').splitlines()
    assert said[-2:] == ['found later', f'{[str(tmp_path), "later"]}']
