# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A package or script of a student with a name of ROS or Python is told to be the cause."""

from dataclasses import replace
import os
from pathlib import Path
import sys

from husky_grader.jail import find_sandbox
from husky_grader.lab.hiding import hiding
from husky_grader.lab.live_steps import live_step
from husky_grader.lab.programs import Programs
from husky_grader.playpen import default_rubric
from husky_grader.rubric.rubric_file import load_rubric
from husky_grader.rubric.steps import PublisherStep
import pytest

(PUBLISHES,) = (
    step for step in load_rubric(default_rubric()).steps if isinstance(step, PublisherStep)
)
PLACE = 'lib/python3/site-packages'


def installed(built: Path, *files: str) -> dict[str, str]:
    """Write files where a build installs them; return the variables of who has sourced it."""
    for file in files:
        (built / 'install' / file).parent.mkdir(parents=True, exist_ok=True)
        (built / 'install' / file).touch()
    found = sorted((built / 'install').glob(f'*/{PLACE}'))
    return {'PYTHONPATH': ':'.join(map(str, found))}


@pytest.mark.parametrize(
    ('error', 'hidden'),
    [
        ("a.py line 3: ModuleNotFoundError: No module named 'std_msgs.msg'", 'msgs std_msgs'),
        ("a.py line 3: ImportError: cannot import name 'Node' from 'rclpy' (b.py)", 'lib rclpy'),
        ("a.py line 3: AttributeError: module 'random' has no attribute 'x'", 'lib random'),
        ("random.py line 3: NameError: name 'x' is not defined", 'lib random'),
        ("a.py line 3: KeyError: 'rclpy'", ''),
        ("a.py line 3: ModuleNotFoundError: No module named 'own_part'", ''),
        ("a.py line 3: ModuleNotFoundError: No module named 'topic_demo.part'", ''),
        ("a.py line 3: ModuleNotFoundError: No module named 'geometry_msgs.mgs'", ''),
        ('', ''),
    ],
)
def test_a_module_that_an_error_names_is_told_if_it_hides_one(
    tmp_path: Path, error: str, hidden: str
) -> None:
    environment = installed(
        tmp_path,
        f'msgs/{PLACE}/std_msgs/__init__.py',
        f'lib/{PLACE}/rclpy.py',
        'lib/lib/lib/random.py',
        f'lib/{PLACE}/own_part.py',
        f'topic_demo/{PLACE}/topic_demo/__init__.py',
    )
    package, _, module = hidden.partition(' ')
    told = (
        f'package {package} has a module {module} of its own, which hides the one that is '
        'installed: rename it'
    )
    assert hiding(error, tmp_path, environment) == (told if hidden else '')


def test_nothing_is_looked_for_outside_of_the_workspace(tmp_path: Path) -> None:
    environment = installed(tmp_path / 'built', 'lib/lib/other')
    (tmp_path / 'rclpy.py').touch()
    (tmp_path / 'built' / 'install' / 'lib' / 'lib' / 'lib').symlink_to(tmp_path)
    places = (environment['PYTHONPATH'], tmp_path, tmp_path / 'built' / 'install' / '..' / '..')
    environment = {'PYTHONPATH': ':'.join(map(str, places))}
    error = "a.py line 3: ModuleNotFoundError: No module named 'rclpy.node'; 'rclpy' is no package"
    assert hiding(error, tmp_path / 'built', environment) == ''


def test_a_package_of_that_name_beside_the_others_is_told(tmp_path: Path) -> None:
    installed(tmp_path, f'numpy/{PLACE}/numpy/__init__.py')
    # As a hook of a package sets it, which thinks that a package is a module.
    environment = {'PYTHONPATH': str(tmp_path / 'install')}
    error = "a.py line 3: AttributeError: module 'numpy' has no attribute 'array'"
    assert hiding(error, tmp_path, environment).startswith('package numpy has a module numpy')


def test_a_program_beside_its_own_rclpy_is_told(tmp_path: Path) -> None:
    package = PUBLISHES.package
    manifest = tmp_path / 'workspace' / 'src' / package / 'package.xml'
    manifest.parent.mkdir(parents=True)
    manifest.write_text(f'<package><name>{package}</name></package>')
    built = tmp_path / 'built'
    installed(built, f'{package}/lib/{package}/rclpy.py', f'{package}/lib/{package}/publisher')
    program = built / 'install' / package / 'lib' / package / 'publisher'
    program.write_text(f'#!{sys.executable}\nfrom rclpy.node import Node\n')
    program.chmod(0o755)
    programs = Programs(manifest.parents[2], built, os.environ, find_sandbox('none'))
    found = live_step(replace(PUBLISHES, within_sec=3.0), programs, tmp_path / 'log')
    assert found.why == (
        "publisher line 2: ModuleNotFoundError: No module named 'rclpy.node'; 'rclpy' is not a "
        f'package; package {package} has a module rclpy of its own, which hides the one that is '
        'installed: rename it'
    )
