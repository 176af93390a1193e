# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 pkg` and `ros2 interface`: what is installed, and new packages."""

from __future__ import annotations

from collections.abc import Callable
import importlib
from pathlib import Path
import shutil
import subprocess
import sys
from typing import Any

import pytest
from ros2pkg import api


def test_packages_of_every_prefix_are_listed(
    installed_package: Callable[..., Path], ros2: Callable[..., Any]
) -> None:
    prefix = installed_package('demo', show='#!/bin/sh\n')
    lines = ros2('pkg', 'list').lines
    assert {'demo', 'rclpy', 'std_msgs'} <= set(lines)
    assert lines == sorted(lines)
    assert ros2('pkg', 'prefix', 'demo').out == f'{prefix}\n'
    assert ros2('pkg', 'prefix', '--share', 'demo').out == f'{prefix}/share/demo\n'
    assert ros2('pkg', 'executables', 'demo').lines == ['demo show']
    assert 'demo show' in ros2('pkg', 'executables').lines
    assert ros2('pkg', 'executables', '--full-path', 'demo').lines == [f'{prefix}/lib/demo/show']


def test_the_manifest_is_shown(ros2: Callable[..., Any]) -> None:
    assert ros2('pkg', 'xml', 'std_msgs', '--tag', 'name').out == 'std_msgs\n'
    assert '<name>std_msgs</name>' in ros2('pkg', 'xml', 'std_msgs').out
    for words, message in (
        (('xml', 'std_msgs', '-t', 'nothing'), 'XML tag not found'),
        (('xml', 'std_mgs'), "Package not found: 'std_mgs': no such package is sourced"),
        (('prefix', 'std_mgs'), "did you mean 'std_msgs'"),
    ):
        answer = ros2('pkg', *words)
        assert answer.status == 1
        assert message in answer.err


def test_programs_of_a_package_are_found_from_python(
    installed_package: Callable[..., Path],
) -> None:
    prefix = installed_package('demo', show='#!/bin/sh\n')
    assert 'demo' in api.get_package_names()
    assert api.get_prefix_path('demo') == str(prefix)
    assert api.get_prefix_path('no.package') is None
    assert api.get_executable_paths(package_name='demo') == [f'{prefix}/lib/demo/show']
    with pytest.raises(api.PackageNotFound):
        api.get_executable_paths(package_name='nothing')


def test_a_new_python_package_builds_passes_its_tests_and_runs(
    ros2: Callable[..., Any], tmp_path: Path
) -> None:
    source = tmp_path / 'src'
    source.mkdir()
    answer = ros2(
        'pkg', 'create', 'my_package', '--build-type', 'ament_python', '--node-name', 'my_node',
        '--license', 'Apache-2.0', '--dependencies', 'rclpy', 'std_msgs', folder=source,
    )  # fmt: skip
    assert answer.status == 0
    assert 'going to create a new package' in answer.lines
    package = source / 'my_package'
    assert 'Apache License' in (package / 'LICENSE').read_text()
    before = ros2('run', 'my_package', 'my_node', folder=tmp_path)
    assert before.status == 1
    assert 'but not built; run `colcon build --packages-select my_package`' in before.err
    _colcon('build', tmp_path)
    unsourced = ros2('run', 'my_package', 'my_node', folder=tmp_path)
    assert f'run `source {tmp_path}/install/setup.bash`' in unsourced.err
    _colcon('test', tmp_path)
    _colcon('test-result', tmp_path)
    command = f'{sys.executable} -m ros2cli run my_package my_node'
    ran = subprocess.run(
        ['bash', '-c', f'source install/setup.bash && {command}'],
        cwd=tmp_path, capture_output=True, text=True,
    )  # fmt: skip
    assert ran.stdout == 'Hi from my_package.\n', ran.stderr


@pytest.mark.parametrize(
    ('shell', 'command'),
    [
        ('bash', '`source /ws/install/setup.bash`'),
        ('zsh', '`source /ws/install/setup.zsh`'),
        ('fish', '`bash -c "source /ws/install/setup.bash && exec fish"`'),
    ],
)
def test_a_workspace_is_sourced_by_what_the_shell_can_read(
    tmp_path: Path, shell: str, command: str
) -> None:
    # Of the shell nothing but its name counts, and not every computer has all three.
    (tmp_path / shell).symlink_to('/bin/bash')
    tell = 'import pathlib; from ros2_diagnosis import packages; '
    tell += 'print(packages.how_to_source(pathlib.Path("/ws")))'
    told = subprocess.check_output(
        [tmp_path / shell, '-c', '"$0" -c "$1"; true', sys.executable, tell], text=True
    )
    assert told.strip() == command


@pytest.mark.parametrize(
    ('command', 'instead'),
    [
        ('rviz2', 'viewer:=true'),
        ('rqt', 'here `ros2 service call` calls a service, `ros2 run rqt_graph rqt_graph` shows'),
        ('ros2 run rqt_console rqt_console', '`ros2 topic echo /rosout`'),
        ('ros2 run demo_nodes_cpp introspection_service', 'ros2 run demo_nodes_py introspection'),
        (
            'ros2 launch demo_nodes_cpp add_two_ints_launch.py',
            'ros2 pkg executables demo_nodes_py',
        ),
        ('ros2 run ros_gz_sim create', 'husky_playpen.launch.py'),
        ('ros2 run teleop_twist_keyboard teleop_twist_keyboard', 'ros2 run husky_driver teleop'),
        ('ros2 run demo_nodes_cpp talker', 'ros2 run demo_nodes_py talker'),
        ('ros2 launch turtle_tf2_cpp turtle_tf2_demo.launch.py', '`ros2 launch turtle_tf2_py '),
        ('ros2 run joint_state_publisher_gui joint_state_publisher_gui', '-p delta:=0.05'),
        ('ros2 run examples_rclpy_minimal_service service', 'demo_nodes_py add_two_ints_server'),
        ('ros2 run rqt_image_view rqt_image_view', 'shows what the camera sees'),
        ('ros2 run image_tools cam2image', 'a sourced ROS 2 Jazzy has it'),
    ],
)
def test_a_program_without_wheel_names_what_does_its_job(command: str, instead: str) -> None:
    done = subprocess.run(command.split(), capture_output=True, text=True)
    assert done.returncode == 1
    assert instead in done.stderr
    assert done.stderr.count('\n') == 1


def _colcon(verb: str, workspace: Path) -> None:
    colcon = shutil.which('colcon')
    assert colcon, 'colcon is part of the installation'
    done = subprocess.run([colcon, verb], cwd=workspace, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_new_cpp_package_has_what_it_declares(ros2: Callable[..., Any], tmp_path: Path) -> None:
    words = ('--node-name', 'mine', '--library-name', 'mine', '--dependencies', 'std_msgs')
    answer = ros2('pkg', 'create', 'other', *words, folder=tmp_path)
    assert '[WARNING] renaming node to mine_node' in answer.err
    package = tmp_path / 'other'
    lists = (package / 'CMakeLists.txt').read_text()
    assert 'add_executable(mine_node src/mine_node.cpp)' in lists
    assert 'find_package(std_msgs REQUIRED)' in lists
    assert (package / 'include' / 'other' / 'mine.hpp').is_file()
    # What colcon reads manifests with; it carries no types.
    parsed = importlib.import_module('catkin_pkg.package').parse_package(
        str(package / 'package.xml')
    )
    assert [str(d) for d in parsed.buildtool_depends] == ['ament_cmake_ros']
    assert parsed.get_build_type() == 'ament_cmake'


@pytest.mark.parametrize(
    ('words', 'status', 'message'),
    [
        (('My-Package',), 2, "'My-Package' is no package name"),
        (('test', '--build-type', 'ament_python'), 1, "can't be named 'test'"),
        (('here',), 1, 'The directory already exists'),
        (('a', '--maintainer-email', 'me'), 2, "'me' is no email address"),
        (('a', '--node-name', 'my node'), 2, "'my node' is no node name"),
    ],
)
def test_a_bad_package_is_refused(
    ros2: Callable[..., Any], tmp_path: Path, words: tuple[str, ...], status: int, message: str
) -> None:
    (tmp_path / 'here').mkdir()
    answer = ros2('pkg', 'create', *words, folder=tmp_path)
    assert answer.status == status
    assert message in answer.err
    assert [path.name for path in tmp_path.iterdir()] == ['here']


def test_a_new_package_is_whole_whoever_reads_a_line_of_it_alone(tmp_path: Path) -> None:
    piped = 'set -o pipefail; ros2 pkg create mine --build-type ament_python | head -c 1 | wc -c'
    answer = subprocess.run(
        ['bash', '-c', piped], cwd=tmp_path, capture_output=True, text=True, timeout=30.0
    )
    assert (answer.stdout.strip(), answer.stderr) == ('1', '')
    assert (tmp_path / 'mine' / 'setup.py').is_file()
    assert (tmp_path / 'mine' / 'test' / 'test_pep257.py').is_file()


def test_licenses_are_listed(ros2: Callable[..., Any]) -> None:
    assert {'Apache-2.0', 'MIT', 'BSD-3-Clause'} <= set(
        ros2('pkg', 'create', 'x', '--license', '?').lines
    )


def test_interfaces_are_listed_by_kind(
    installed_package: Callable[..., Path], ros2: Callable[..., Any]
) -> None:
    index = installed_package('kinds') / 'share/ament_index/resource_index/rosidl_interfaces'
    index.mkdir()
    (index / 'kinds').write_text('msg/Num.msg\nsrv/Add.srv\naction/Go.action\n')
    lines = ros2('interface', 'list').lines
    assert lines[0] == 'Messages:'
    assert lines.index('Services:') < lines.index('    std_srvs/srv/Empty')
    assert lines.index('    std_msgs/msg/String') < lines.index('Services:')
    assert ros2('interface', 'package', 'std_srvs').lines == [
        'std_srvs/srv/Empty',
        'std_srvs/srv/SetBool',
        'std_srvs/srv/Trigger',
    ]
    for option, found in (('-m', 'msg/Num'), ('-s', 'srv/Add'), ('--only-actions', 'action/Go')):
        assert ros2('interface', 'package', 'kinds', option).lines == [f'kinds/{found}']
    for wrong in ('std_svs', 'std_srvs/'):  # the Tab key writes the latter beside such a folder
        missing = ros2('interface', 'package', wrong)
        assert missing.status == 1
        assert missing.err.startswith(f"Unknown package '{wrong}': ")
    assert 'std_srvs' in ros2('interface', 'packages', '-s').lines
    assert 'std_srvs' not in ros2('interface', 'packages', '-m').lines


def test_an_interface_is_shown_with_what_it_contains(ros2: Callable[..., Any]) -> None:
    assert ros2('interface', 'show', '--no-comments', 'geometry_msgs/msg/Twist').lines == [
        'Vector3  linear', '\tfloat64 x', '\tfloat64 y', '\tfloat64 z',
        'Vector3  angular', '\tfloat64 x', '\tfloat64 y', '\tfloat64 z',
    ]  # fmt: skip
    piped = ros2('interface', 'show', '-', text='std_srvs/srv/Trigger\n')
    assert '---' in piped.lines
    for short in ('geometry_msgs/Twist', 'Twist'):  # as ROS 1 has it, or by its name alone
        wrong = ros2('interface', 'show', short)
        assert f"Invalid name '{short}'. Expected three parts separated by '/'; did" in wrong.err
        assert "you mean 'geometry_msgs/msg/Twist'?" in wrong.err
        assert wrong.status == 1
    wrong = ros2('interface', 'show', 'std_msgs/msg/Sting')
    assert wrong.status == 1
    assert "did you mean 'std_msgs/msg/String'" in wrong.err


def test_a_prototype_can_be_filled_in(ros2: Callable[..., Any]) -> None:
    assert ros2('interface', 'proto', 'std_srvs/srv/SetBool', '--no-quotes').lines == [
        'data: false',
        '',
    ]
