# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Packages say what they need, need nothing above them, and run with that alone."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib import metadata
from importlib.util import find_spec
from inspect import getmodulename
import os
from pathlib import Path
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

from ament_index_python.packages import get_package_share_directory
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from playpen_testing.which_ros import SOURCED
import pytest

pytestmark = pytest.mark.timeout(180)  # one of them builds every package

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / 'src'
PACKAGES = sorted(path.parent.name for path in SOURCE.glob('*/package.xml'))

# Who may import whom: a package stands above all that it imports.
LAYERS = (
    ('husky_course', 'topic_demo'),
    ('husky_runtime',),
    ('husky_driver', 'husky_sim'),
    ('husky_view', 'husky_grader'),
    ('husky_gym',),
)
# What rosdep (github.com/ros/rosdistro, rosdep/python.yaml) and pip call otherwise than Python.
MODULES = {'python3-yaml': 'yaml', 'PyYAML': 'yaml', 'resvg-py': 'resvg_py'}
TYPED = {'ros2launch', 'ros2run'}  # what people start the package by
OPTIONAL = {'simulation_interfaces'}  # only used where it is installed; the wheels lack it
LAUNCH_COMMANDS = re.compile(r"'ros2',\s*'(run|launch)'")
IN_LAUNCH_FILES = re.compile(r"(?:FindPackageShare\(|package=)'(\w+)'")


@dataclass(frozen=True)
class Import:
    """One import of a module of ours: what, by whom, where."""

    module: str
    by: str
    place: str


def sources(package: str) -> list[Path]:
    """Return the modules and the launch files of a package."""
    folder = SOURCE / package
    return [*sorted((folder / package).rglob('*.py')), *sorted(folder.glob('launch/*.py'))]


def module_name(path: Path) -> str:
    return '.'.join(path.relative_to(SOURCE).with_suffix('').parts[1:]).removesuffix('.__init__')


@cache
def imports(package: str) -> tuple[Import, ...]:
    found = []
    for path in sources(package):
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.module:
                names = [as_module(node.module, alias.name) for alias in node.names]
            place = f'{path.relative_to(ROOT)}:{getattr(node, "lineno", 0)}'
            found += [Import(name, module_name(path), place) for name in names]
    return tuple(found)


def as_module(module: str, name: str) -> str:
    """Return the module that `from MODULE import NAME` imports."""
    folder = SOURCE / module.partition('.')[0] / module.replace('.', '/')
    return f'{module}.{name}' if (folder / f'{name}.py').is_file() else module


def declared(package: str) -> set[str]:
    """Return what package.xml says, and what setup.py asks pip for because rosdep lacks it."""
    root = ElementTree.parse(SOURCE / package / 'package.xml').getroot()
    keys = {str(entry.text) for entry in root.iter('exec_depend')}
    modules = {MODULES.get(key, key.removeprefix('python3-')) for key in keys}
    setup = (SOURCE / package / 'setup.py').read_text(encoding='utf-8')
    asked = re.search(r'install_requires=(\[[^\]]*\])', setup)
    assert asked, f'{package}/setup.py: no install_requires'
    wanted = {MODULES.get(name, name) for name in ast.literal_eval(asked[1])}
    return modules | wanted - {'setuptools'}


def used(package: str) -> set[str]:
    """Return the top-level modules and ROS packages that a package uses."""
    modules = {each.module.partition('.')[0] for each in imports(package)}
    for path in sources(package):
        text = path.read_text(encoding='utf-8')
        modules |= {f'ros2{verb}' for verb in LAUNCH_COMMANDS.findall(text)}
        modules |= set(IN_LAUNCH_FILES.findall(text)) if path.parent.name == 'launch' else set()
    return modules - set(sys.stdlib_module_names) - OPTIONAL - {package, '__future__'}


@pytest.mark.parametrize('package', PACKAGES)
def test_a_package_declares_just_what_it_uses(package: str) -> None:
    assert used(package) <= declared(package)
    assert declared(package) - used(package) <= TYPED | OPTIONAL


def test_no_package_imports_one_above_it() -> None:
    layer = {package: number for number, names in enumerate(LAYERS) for package in names}
    assert sorted(layer) == PACKAGES
    upwards = [
        f'{each.place}: {each.module}'
        for package in PACKAGES
        for each in imports(package)
        for other in [each.module.partition('.')[0]]
        if other in layer and other != package and layer[other] >= layer[package]
    ]
    assert upwards == []


def test_others_import_only_the_front_of_a_folder() -> None:
    inside = [
        f'{each.place}: {each.module}'
        for package in PACKAGES
        for each in imports(package)
        if each.module.partition('.')[0] in set(PACKAGES) - {package}
        if each.module.count('.') > 1
    ]
    assert inside == []


def cycle_in(edges: dict[str, set[str]]) -> list[str]:
    """Return modules that import each other in a circle; empty if there are none."""
    done: set[str] = set()

    def visit(module: str, way: list[str]) -> list[str]:
        if module in way:
            return [*way[way.index(module) :], module]
        if module in done:
            return []
        for other in sorted(edges.get(module, ())):
            if found := visit(other, [*way, module]):
                return found
        done.add(module)
        return []

    return next((found for module in sorted(edges) if (found := visit(module, []))), [])


@pytest.mark.parametrize('depth', [2, 9], ids=['folders', 'modules'])
@pytest.mark.parametrize('package', PACKAGES)
def test_no_import_runs_in_a_circle(package: str, depth: int) -> None:
    edges: dict[str, set[str]] = {}
    for each in imports(package):
        ours, theirs = ('.'.join(name.split('.')[:depth]) for name in (each.by, each.module))
        if theirs.startswith(f'{package}.') and ours != theirs:
            edges.setdefault(ours, set()).add(theirs)
    assert cycle_in(edges) == []


def test_a_circle_is_found() -> None:
    assert cycle_in({'a': {'b'}, 'b': {'c'}, 'c': {'b'}}) == ['b', 'c', 'b']


@pytest.fixture(scope='module')
def only_declared(
    built_packages: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Path]:
    """Link what each package declares, and what that needs, into a folder: all that it gets."""
    folders, here = {}, tmp_path_factory.mktemp('only_declared')
    for package in PACKAGES:
        folders[package] = here / package
        folders[package].mkdir()
        places = (place for name in closure(package) for place in places_of(name, built_packages))
        for name, path in {path.name: path for path in places}.items():
            (folders[package] / name).symlink_to(path)
    return folders


def closure(package: str) -> set[str]:
    """Return a package, and all modules that it and those need, as they declare it."""
    found: set[str] = set()
    left = {package}
    while left:
        name = left.pop()
        found.add(name)
        if name in PACKAGES:
            left |= declared(name) - found
        else:
            found |= modules_with(name)
            left |= needed_by(name) - found if SOURCED else set()
    return found


def needed_by(name: str) -> set[str]:
    """Return what a package of a sourced ROS needs; that of a wheel stands in its metadata."""
    try:
        share = Path(get_package_share_directory(name))
    except (LookupError, ValueError):  # ValueError: this cannot be the name of a package
        return set()
    root = ElementTree.parse(share / 'package.xml').getroot()
    kinds = ('depend', 'exec_depend', 'build_export_depend')
    keys = {str(entry.text) for kind in kinds for entry in root.iter(kind)}
    return {MODULES.get(key, key.removeprefix('python3-')) for key in keys}


@cache
def modules_with(name: str) -> set[str]:
    """Return the modules of a module's distribution, and of all that this requires."""
    found: set[tuple[str, str]] = set()
    owners = [each for each, modules in modules_of().items() if name in modules]
    left = {(each, extra) for each in owners for extra in ('', 'fastrtps')}  # that of rclpy
    while left:
        found.add(distribution := left.pop())
        left |= set(required_by(*distribution)) - found
    return {module for distribution, _ in found for module in modules_of().get(distribution, ())}


def required_by(distribution: str, extra: str) -> Iterator[tuple[str, str]]:
    """Yield the distributions that one requires here with an extra, and their extras."""
    for requirement in map(Requirement, metadata.requires(distribution) or ()):
        if requirement.marker is None or requirement.marker.evaluate({'extra': extra}):
            for its_extra in ('', *requirement.extras):
                yield canonicalize_name(requirement.name), its_extra


@cache
def modules_of() -> dict[str, set[str]]:
    """Return the modules of every distribution (Python 3.10 itself tells only of some)."""
    found: dict[str, set[str]] = {}
    for distribution in metadata.distributions():
        modules = found.setdefault(canonicalize_name(distribution.name), set())
        for file in distribution.files or ():
            module = getmodulename(file.name) if len(file.parts) == 1 else file.parts[0]
            if module and module.isidentifier():
                modules.add(module)
    return found


def places_of(name: str, built: Path) -> list[Path]:
    """Return the files and folders to link for a module; none for a ROS package without one."""
    if name in PACKAGES:
        return sorted(built.glob(f'{name}/lib/python3*/site-packages/{name}'))
    spec = find_spec(name)
    if spec is None or spec.origin is None:
        return [Path(place) for place in spec.submodule_search_locations or ()] if spec else []
    return [Path(spec.origin).parent if spec.submodule_search_locations else Path(spec.origin)]


def run_alone(folder: Path, program: str) -> subprocess.CompletedProcess[str]:
    """Run a program with nothing to import but the standard library and what lies in a folder."""
    environment = {**os.environ, 'PYTHONPATH': str(folder), 'PYTHONNOUSERSITE': '1'}
    command = [sys.executable, '-S', '-c', program]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60.0)


@pytest.mark.parametrize('package', PACKAGES)
def test_a_package_imports_with_what_it_declares(
    package: str, only_declared: dict[str, Path]
) -> None:
    modules = [module_name(path) for path in sources(package) if path.parent.name != 'launch']
    program = ''.join(f'import {module}\n' for module in modules)
    done = run_alone(only_declared[package], program)
    assert done.returncode == 0, done.stderr


def test_the_driver_runs_without_mujoco(only_declared: dict[str, Path]) -> None:
    folder = only_declared['husky_driver']
    assert not (folder / 'mujoco').exists()
    program = 'import sys\nfrom husky_driver.follow_path import main\n'
    program += 'sys.exit(main(["follow_path", "--waypoints", "none.yaml"]))'
    done = run_alone(folder, program)
    assert (done.returncode, done.stderr) == (2, 'none.yaml: no such file\n')


@pytest.mark.parametrize(
    ('package', 'name', 'now'),
    [
        ('husky_driver', 'check', 'husky_grader'),
        ('husky_driver', 'drive', 'husky_grader'),
        ('husky_driver', 'grade', 'husky_grader'),
        ('husky_sim', 'replay', 'husky_view'),
        ('husky_sim', 'view', 'husky_view'),
    ],
)
def test_a_moved_program_runs_and_says_where_it_is(package: str, name: str, now: str) -> None:
    refused = ['--ros-args', '-p', 'viewer_port:=99999']
    command = ['ros2', 'run', package, name, *(refused if name == 'view' else ['--help'])]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60.0)
    moved, _, rest = done.stderr.partition('\n')
    assert moved == f'{name} has moved: ros2 run {now} {name}'
    assert done.returncode == (2 if name == 'view' else 0)
    assert 'a port is from 1' in rest if name == 'view' else 'usage:' in done.stdout
