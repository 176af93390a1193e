# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The workspace as colcon and ROS see it: ament_python packages, built and found."""

import contextlib
import json
import os
from pathlib import Path
import pty
import select
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

from playpen_testing.which_ros import SOURCED
import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = sorted(path.parent.name for path in (ROOT / 'src').glob('*/package.xml'))


def run(*command: str, cwd: Path, **environment: str) -> str:
    done = subprocess.run(
        command, cwd=cwd, env={**os.environ, **environment}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_colcon_takes_every_package_for_an_ament_python_one(tmp_path: Path) -> None:
    # A package.xml that does not parse silently turns a package into a plain `python` one.
    listed = run('colcon', '--log-base', str(tmp_path), 'list', '--base-paths', 'src', cwd=ROOT)
    kinds = {row.split('\t')[0]: row.split('\t')[2] for row in listed.splitlines()}
    assert kinds == dict.fromkeys(PACKAGES, '(ros.ament_python)')


@pytest.mark.parametrize('install', ['copied', 'symlinked'])
@pytest.mark.timeout(180)
def test_a_build_puts_every_package_on_the_ament_path(built_packages: Path, install: str) -> None:
    folder = built_packages if install == 'copied' else ROOT / 'install'
    script = 'source "$0/local_setup.bash" && echo "$AMENT_PREFIX_PATH"'
    shown = run('bash', '-c', script, str(folder), cwd=ROOT, AMENT_PREFIX_PATH='')
    prefixes = [Path(folder) for folder in shown.strip().split(os.pathsep)]
    for package in PACKAGES:
        marker = Path('share') / 'ament_index' / 'resource_index' / 'packages' / package
        assert [prefix.name for prefix in prefixes if (prefix / marker).is_file()] == [package]
    program = folder / 'husky_sim/lib/husky_sim/husky_sim'
    assert program.read_text().startswith(f'#!{Path(sys.executable).parent}/'), 'another Python'
    world = folder / 'husky_sim/share/husky_sim/worlds/playpen.xml'
    course = folder / 'husky_driver/share/husky_driver/config/waypoints/central_barrier.yaml'
    assert world.read_text() == (ROOT / 'worlds/playpen.xml').read_text()
    assert course.read_text() == (ROOT / 'config/waypoints/central_barrier.yaml').read_text()


SETUP_WITH_SCRIPT = """from setuptools import setup
setup(
    name='bare',
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/bare']),
        ('share/bare', ['package.xml']),
    ],
    scripts=['scripts/greet'],
)
"""


@pytest.mark.timeout(180)
def test_a_script_of_a_setup_py_runs(tmp_path: Path) -> None:
    """Newer setuptools leave `#!python` in it, which installers replace and colcon does not."""
    files = {
        'package.xml': '<package format="3"><name>bare</name><version>0.0.0</version>'
        '<description>A script</description><maintainer email="a@b.org">A</maintainer>'
        '<license>Apache-2.0</license><export><build_type>ament_python</build_type></export></package>',
        'setup.py': SETUP_WITH_SCRIPT,
        'setup.cfg': '[install]\ninstall_scripts=$base/lib/bare\n',
        'resource/bare': '',
        'scripts/greet': '#!/usr/bin/env python3\nprint("hello")\n',
    }
    for name, text in files.items():
        (path := tmp_path / 'src' / 'bare' / name).parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    run('colcon', 'build', cwd=tmp_path)
    assert run(str(tmp_path / 'install/bare/lib/bare/greet'), cwd=tmp_path) == 'hello\n'


def test_tab_completes_ros2_once_a_workspace_is_sourced(tmp_path: Path) -> None:
    controller, terminal = pty.openpty()
    # A terminal that knows nothing yet; the answer differs from what is typed.
    plain = {'HOME': str(tmp_path), 'PATH': '/usr/local/bin:/usr/bin:/bin', 'TERM': 'dumb'}
    with subprocess.Popen(
        ['bash', '--norc', '--noprofile', '-i'],
        cwd=ROOT, env=plain, stdin=terminal, stdout=terminal, stderr=terminal,
        start_new_session=True,
    ) as shell:  # fmt: skip
        os.close(terminal)
        os.write(controller, b'source install/setup.bash; echo READY$((1))\n')
        shown = _read_until(controller, 'READY1')
        os.write(controller, b'ros2 to\t')
        shown += _read_until(controller, 'ros2 topic ')
        os.close(controller)
        assert 'not found' not in shown
        shell.kill()


# What the set-up files of a sourced ROS define in a shell does not come along into another.
@pytest.mark.parametrize('ros', ['pip', 'sourced'])
def test_the_shell_of_the_lab_has_what_colcon_brings(tmp_path: Path, ros: str) -> None:
    shell = ('bash', '--rcfile', 'config/shell/bashrc', '-ic')
    asked = 'type -t colcon_cd; complete -p | grep -c " \\(ros2\\|colcon\\)$"; true'
    here = {'LAB_VIRTUAL_ENV': sys.prefix, 'HOME': str(tmp_path), 'HUSKY_LAB_ROS': ros}
    expected = ['function', '2']
    if SOURCED and not Path(sys.prefix, 'share', 'colcon_cd').exists():
        expected = ['2']  # colcon is the system's
    assert run(*shell, asked, cwd=ROOT, **here).splitlines() == expected


# A PATH from anew, as many have it, and another environment that is active, as by `conda init`.
SETTINGS = """
export PATH={here}/bin:/usr/bin:/bin VIRTUAL_ENV={here} LD_LIBRARY_PATH=/cuda AMENT_PREFIX_PATH=
export PYTHONPATH=/mine:$PYTHONPATH RMW_IMPLEMENTATION=of_mine
alias python=false
"""
SETTINGS_OF_FISH = """
set -gx PATH {here}/bin /usr/bin /bin; set -gx VIRTUAL_ENV {here}; set -gx LD_LIBRARY_PATH /cuda
set -gx AMENT_PREFIX_PATH; set -gx PYTHONPATH /mine $PYTHONPATH; set -gx RMW_IMPLEMENTATION of_mine
alias python=false
"""
# bash is there wherever ./lab is; of the others, those that this computer has.
SHELLS = [path for path in map(shutil.which, ('bash', 'zsh', 'fish')) if path is not None]


@pytest.mark.parametrize('shell', SHELLS)
def test_settings_of_a_user_take_nothing_from_the_shell_of_the_lab(
    tmp_path: Path, shell: str
) -> None:
    for name in ('.bashrc', '.zsh/.zshrc', '.config/fish/config.fish', 'bin/python3'):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        settings = SETTINGS_OF_FISH if 'fish' in name else SETTINGS
        (tmp_path / name).write_text(settings.format(here=tmp_path))
    (tmp_path / '.zshenv').write_text('ZDOTDIR=~/.zsh\n')
    (tmp_path / 'bin' / 'python3').chmod(0o755)
    (tmp_path / 'tell.py').write_text('import os, json; print(json.dumps(dict(os.environ)))')
    typed = 'python3 tell.py > told\rros2 to\t --help > helped\rexit\r'
    here = {'HOME': str(tmp_path), 'SHELL': shell, 'TERM': 'xterm'}
    controller, terminal = pty.openpty()
    with subprocess.Popen(
        [ROOT / 'lab', 'shell'],
        cwd=tmp_path, env={**os.environ, **here}, stdin=terminal, stdout=terminal, stderr=terminal,
        start_new_session=True,
    ) as process:  # fmt: skip
        os.close(terminal)
        shown = _read_until(controller, '(lab) ')
        os.write(controller, typed.encode())
        with contextlib.suppress(OSError):  # the terminal has ended
            shown += _read_until(controller, 'does not come')
        os.close(controller)
        process.wait(timeout=20)
    told = json.loads((tmp_path / 'told').read_text())
    lab = json.loads(run(str(ROOT / 'lab'), 'exec', 'python3', 'tell.py', cwd=tmp_path))
    assert told['PATH'].startswith(lab['PATH']), shown
    assert told['LD_LIBRARY_PATH'] == f'{lab["LD_LIBRARY_PATH"]}:/cuda', shown
    assert told['PYTHONPATH'] == f'/mine:{lab["PYTHONPATH"]}', shown
    same = ('VIRTUAL_ENV', 'AMENT_PREFIX_PATH')
    assert [told[name] for name in same] == [lab[name] for name in same], shown
    assert ('ZDOTDIR' in told, 'LAB_VIRTUAL_ENV' in told) == (False, False), shown
    if not SOURCED:  # there no program finds the middleware that these settings name
        assert (tmp_path / 'helped').read_text().startswith('usage: ros2 topic'), shown
    assert told.get('RMW_IMPLEMENTATION') == ('of_mine' if SOURCED else None), shown


def _read_until(controller: int, wanted: str) -> str:
    """Return what a terminal shows up to a text; fails after 30 s with what it has shown."""
    shown = ''
    deadline = time.monotonic() + 30.0
    while wanted not in shown:
        left = max(0.0, deadline - time.monotonic())
        assert select.select([controller], [], [], left)[0], shown
        shown += os.read(controller, 4096).decode(errors='replace')
    return shown


@pytest.mark.parametrize('package', PACKAGES)
def test_a_package_names_format_licence_and_build(package: str) -> None:
    root = ElementTree.parse(ROOT / 'src' / package / 'package.xml').getroot()
    assert root.get('format') == '3'
    assert root.findtext('license') == 'Apache-2.0'
    assert root.findtext('export/build_type') == 'ament_python'


def test_every_package_has_a_changelog_of_its_version() -> None:
    for package in PACKAGES:
        root = ElementTree.parse(ROOT / 'src' / package / 'package.xml').getroot()
        changelog = (ROOT / 'src' / package / 'CHANGELOG.rst').read_text()
        assert f'{root.findtext("version")} (' in changelog, package
