# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The workspace as colcon and ROS see it: ament_python packages, built and found."""

import os
from pathlib import Path
import pty
import select
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


def test_the_shell_of_the_lab_has_what_colcon_brings(tmp_path: Path) -> None:
    shell = ('bash', '--rcfile', 'config/lab_shell.bash', '-ic')
    asked = 'type -t colcon_cd; complete -p | grep -c " \\(ros2\\|colcon\\)$"; true'
    here = {'VIRTUAL_ENV': sys.prefix, 'HOME': str(tmp_path)}
    # Of a sourced ROS the setup files do that.
    expected = ['0'] if SOURCED else ['function', '2']
    assert run(*shell, asked, cwd=ROOT, **here).splitlines() == expected


def test_settings_of_a_user_take_nothing_from_the_shell_of_the_lab(tmp_path: Path) -> None:
    bashrc = 'RMW_IMPLEMENTATION=of_mine LD_LIBRARY_PATH=/cuda PYTHONPATH=/mine:$PYTHONPATH'
    (tmp_path / '.bashrc').write_text(f'export AMENT_PREFIX_PATH= {bashrc}\n')
    asked = 'echo $AMENT_PREFIX_PATH $LD_LIBRARY_PATH $PYTHONPATH $RMW_IMPLEMENTATION'
    paths = {'AMENT_PREFIX_PATH': '/lab:/ros', 'LD_LIBRARY_PATH': '/lib', 'PYTHONPATH': '/lab'}
    here = {'VIRTUAL_ENV': sys.prefix, 'HOME': str(tmp_path), **paths}
    shown = run('bash', '--rcfile', 'config/lab_shell.bash', '-ic', asked, cwd=ROOT, **here)
    assert shown.split()[:3] == ['/lab:/ros', '/lib:/cuda', '/mine:/lab'], shown
    assert shown.split()[3:] == (['of_mine'] if SOURCED else []), shown


def _read_until(controller: int, wanted: str) -> str:
    """Return what a terminal shows up to a text; fails after 30 s with what it has shown."""
    shown = ''
    deadline = time.monotonic() + 30.0
    while wanted not in shown:
        left = max(0.0, deadline - time.monotonic())
        assert select.select([controller], [], [], left)[0], shown
        shown += os.read(controller, 4096).decode()
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
