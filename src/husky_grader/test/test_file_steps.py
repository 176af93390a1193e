# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which packages of a workspace are looked at, and what their manifests say."""

from dataclasses import replace
import os
from pathlib import Path
import subprocess
import sys

from husky_grader.clone import CLONE
from husky_grader.jail import find_sandbox, Jail, remove
from husky_grader.lab.build_step import build_step
from husky_grader.lab.file_steps import find_manifests, IGNORED, package_step
from husky_grader.lab.lab import grade_lab
from husky_grader.lab.programs import ProgramMissing, Programs
from husky_grader.rubric.steps import (
    BuildStep,
    DriveStep,
    PackageStep,
    Rubric,
    WorkspaceStep,
)
from playpen_testing.jails import as_ordinary_user
from playpen_testing.which_ros import SOURCED
import pytest

DRIVE = DriveStep(points=10, package_with='follow_path.py', executable='follow_path', courses=())

ABOUT = (
    '<version>0.0.0</version><description>d</description><license>MIT</license>'
    '<maintainer email="a@example.org">a</maintainer>'
)

PYTHON = ('<export><build_type>ament_python</build_type>', '</export>')


def write_package(folder: Path, *lines: str) -> Path:
    """Write a manifest, and a program's source beside it."""
    folder.mkdir(parents=True)
    text = '\n'.join((f'<package><name>{folder.name}</name>', *lines, '</package>'))
    (folder / 'package.xml').write_text(text)
    (folder / 'follow_path.py').touch()
    return folder


def install(workspace: Path, package: str, folder: str) -> Path:
    """Put a program where a build does; return it."""
    program = workspace.with_name('built') / 'install' / package / folder / 'follow_path'
    program.parent.mkdir(parents=True)
    program.touch(mode=0o755)
    return program


def programs_of(workspace: Path) -> Programs:
    return Programs(workspace, workspace.with_name('built'), {}, find_sandbox('none'))


@pytest.mark.parametrize('mark', sorted(IGNORED))
def test_a_package_that_colcon_passes_over_is_none(tmp_path: Path, mark: str) -> None:
    write_package(tmp_path / 'src' / 'my_driver')
    old = write_package(tmp_path / 'src' / 'backup' / 'a_driver')
    old.with_name(mark).touch()
    (write_package(tmp_path / 'src' / 'b_driver') / mark).touch()
    write_package(tmp_path / 'src' / '.trash' / 'c_driver')
    write_package(tmp_path / 'src' / 'my_driver' / 'old' / 'd_driver')
    assert [each.name for each in find_manifests(tmp_path)] == ['my_driver']


@pytest.mark.parametrize(
    ('manifest', 'why'),
    [
        ('<package><name>topic_demo</nam>', ' cannot be read: mismatched tag: line 1, column 27'),
        ('', ' cannot be read: no element found: line 1, column 0'),
        ('<package/>', ' has no <name>'),
        (f'<package>{" " * 100_000}</package>', ' is larger than 100000 bytes'),
    ],
    ids=['not closed', 'empty', 'no name', 'large'],
)
def test_a_package_whose_manifest_is_wrong_is_told_why(
    tmp_path: Path, manifest: str, why: str
) -> None:
    write_package(tmp_path / 'src' / 'my_driver')
    (write_package(tmp_path / 'src' / 'topic_demo') / 'package.xml').write_text(manifest)
    found = package_step(PackageStep(points=10, package='topic_demo'), tmp_path)
    assert found.why == (
        'topic_demo is not in src; packages there: my_driver; src/topic_demo is no package: its '
        f'package.xml{why}'
    )


def test_a_package_that_colcon_does_not_find_is_told_why(tmp_path: Path) -> None:
    inner = write_package(write_package(tmp_path / 'src' / 'my_driver') / 'topic_demo')
    write_package(tmp_path / 'src' / 'a_backup').joinpath('COLCON_IGNORE').touch()
    step = PackageStep(points=10, package='topic_demo')
    told = 'src/my_driver/topic_demo is passed over: it lies in my_driver'
    assert package_step(step, tmp_path).why.endswith(told)
    inner.with_name('package.xml').unlink()
    (inner / 'package.xml').write_text('<package><name>Topic Demo</name></package>')
    (tmp_path / 'log').mkdir()
    with Jail(find_sandbox('none'), tmp_path / 'log') as jail:
        found = build_step(tmp_path, jail, tmp_path / 'build.log')
    assert found.why == (
        'there is no package in src; src/a_backup is passed over: a COLCON_IGNORE is in it; '
        "src/my_driver/topic_demo is no package: its <name> is 'Topic Demo': letters, digits and "
        '_ are allowed, a letter first'
    )


def test_spaces_around_what_a_manifest_says_cost_nothing(tmp_path: Path) -> None:
    lines = ('<depend>\n  rclpy\n</depend>', '<export><build_type> ament_python </build_type>')
    write_package(tmp_path / 'src' / 'topic_demo', *lines, '</export>')
    step = PackageStep(points=10, package='topic_demo', dependencies=('rclpy',))
    assert package_step(step, tmp_path).defects == {}


def test_of_several_packages_with_a_file_the_right_one_counts(tmp_path: Path) -> None:
    workspace = tmp_path / 'workspace'
    write_package(workspace / 'src' / 'a_first_try')
    write_package(
        workspace / 'src' / 'my_driver',
        '<depend>rclpy</depend><export><build_type>ament_python</build_type></export>',
    )
    (tmp_path / 'built' / 'install' / 'a_first_try').mkdir(parents=True)
    program = install(workspace, 'my_driver', 'lib/my_driver')
    step = PackageStep(points=10, package_with='follow_path.py', dependencies=('rclpy',))
    assert package_step(step, workspace).why == 'package.xml of my_driver is complete'
    assert package_step(step, workspace).defects == {}
    assert programs_of(workspace).command_of(DRIVE) == [str(program)]


def test_a_script_for_the_python_of_ubuntu_runs_by_the_one_with_ros(tmp_path: Path) -> None:
    write_package(tmp_path / 'workspace' / 'src' / 'my_driver')
    program = install(tmp_path / 'workspace', 'my_driver', 'lib/my_driver')
    command_of = programs_of(tmp_path / 'workspace').command_of
    for line, by in {
        '#!/usr/bin/python3\n': [] if sys.prefix == sys.base_prefix else [sys.executable],
        '#!/usr/bin/python3\r\n': [],  # that is refused
        '#!/usr/bin/env python3\n': [],
    }.items():
        program.write_bytes(line.encode())
        assert command_of(DRIVE) == [*by, str(program)]


def test_a_package_without_setup_py_is_told_of_cmake(tmp_path: Path) -> None:
    workspace = tmp_path / 'workspace'
    write_package(workspace / 'src' / 'my_driver')
    program = install(workspace, 'my_driver', 'lib/my_driver')
    program.rename(program.with_name('drive'))
    with pytest.raises(ProgramMissing, match='has: drive; install follow_path into lib/my_driver'):
        programs_of(workspace).command_of(DRIVE)
    program.touch(mode=0o644)
    with pytest.raises(ProgramMissing, match='; follow_path may not be executed: install it by P'):
        programs_of(workspace).command_of(DRIVE)


def test_a_package_of_python_without_setup_py_is_told_so(tmp_path: Path) -> None:
    workspace = tmp_path / 'workspace'
    write_package(workspace / 'src' / 'my_driver', ABOUT, *PYTHON)
    makes_one = 'ros2 pkg create --build-type ament_python makes one'
    (built := tmp_path / 'built').mkdir()
    with Jail(find_sandbox('none'), built) as jail:
        found = build_step(workspace, jail, tmp_path / 'build.log')
    needs = 'my_driver has no setup.py, which the build type ament_python needs'
    assert found.why == f'colcon build failed: {needs}; {makes_one}'
    with pytest.raises(ProgramMissing, match=f'; it has no setup.py; {makes_one}'):
        programs_of(workspace).command_of(DRIVE)


def test_a_report_tells_nothing_of_where_the_lab_lies(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace, log = tmp_path / 'workspace', tmp_path / 'report' / 'build.log'
    package = write_package(workspace / 'src' / 'my_driver', ABOUT, *PYTHON)
    (package / 'setup.py').write_text('import os\nraise ValueError(os.__file__)\n')
    library = Path(os.__file__).parent
    monkeypatch.setenv('HOME', str(library.parent))
    rubric = Rubric(title='R', steps=(BuildStep(points=10, name='build'),))
    (step,) = grade_lab(workspace, rubric, log.parent, sandbox=find_sandbox('none'))
    assert step.why == (
        f'colcon build failed: setup.py line 2: ValueError: ~/{library.name}/os.py'
    )
    for place in (library.parent, CLONE):
        assert f'{place}/' not in step.printed
    assert f'{library}/' in log.read_text(), 'nothing was left out'


def test_a_program_that_no_setup_cfg_has_put_in_its_place_is_told(tmp_path: Path) -> None:
    workspace = tmp_path / 'workspace'
    write_package(workspace / 'src' / 'my_driver')
    install(workspace, 'my_driver', 'bin')
    with pytest.raises(ProgramMissing) as missing:
        programs_of(workspace).command_of(DRIVE)
    assert str(missing.value).endswith(
        'it was put into install/my_driver/bin; its setup.cfg lacks: [install] '
        'install_scripts=$base/lib/my_driver'
    )


def test_a_launch_file_is_found_where_it_was_installed_or_told(tmp_path: Path) -> None:
    workspace = tmp_path / 'workspace'
    write_package(workspace / 'src' / 'my_driver')
    step = replace(DRIVE, executable='', launch='go.launch.py', arguments=('speed:=0.5',))
    command_of = programs_of(workspace).command_of
    with pytest.raises(ProgramMissing, match=r'go\.launch\.py finds nothing: package my_driver'):
        command_of(step)
    launch = install(workspace, 'my_driver', 'share/my_driver/launch').with_name('go.launch.py')
    told = 'has installed: no launch files; put it into share/my_driver/launch, by data_files in'
    with pytest.raises(ProgramMissing, match=told):
        command_of(step)
    launch.touch()
    assert command_of(step) == ['ros2', 'launch', str(launch), 'speed:=0.5']
    (launch.parents[1] / launch.name).touch()
    with pytest.raises(ProgramMissing, match=r'finds two: go\.launch\.py and launch/go\.'):
        command_of(step)
    with pytest.raises(ProgramMissing, match=r'has installed: go\.launch\.py, go\.launch\.py; '):
        command_of(replace(step, launch='stop.launch.py'))


def test_no_depth_of_folders_stops_the_search_for_a_launch_file(tmp_path: Path) -> None:
    workspace = tmp_path / 'workspace'
    write_package(workspace / 'src' / 'my_driver')
    launch = install(workspace, 'my_driver', 'share/my_driver/launch').with_name('go.launch.py')
    launch.touch()
    deep = 'import os\nfor _ in range(1500):\n    os.mkdir("d")\n    os.chdir("d")'
    subprocess.run([sys.executable, '-c', deep], cwd=launch.parent, check=True)
    step = replace(DRIVE, executable='', launch='go.launch.py')
    try:
        assert programs_of(workspace).command_of(step) == ['ros2', 'launch', str(launch)]
    finally:
        remove(launch.parent)  # as deep, pytest cannot


def test_links_in_a_circle_are_no_programs(tmp_path: Path) -> None:
    workspace = tmp_path / 'workspace'
    write_package(workspace / 'src' / 'my_driver')
    programs = install(workspace, 'my_driver', 'lib').parent / 'my_driver'
    programs.symlink_to('my_driver')
    with pytest.raises(ProgramMissing, match='my_driver has: no executables; install follow_path'):
        programs_of(workspace).command_of(DRIVE)


CLOSED = """
from pathlib import Path
import sys
from husky_grader.jail import find_sandbox, Jail
from husky_grader.lab.build_step import sourced
from husky_grader.lab.file_steps import find_packages
from husky_grader.lab.programs import find_executable
workspace, built = map(Path, sys.argv[1:])
(package,) = find_packages(workspace, 'my_driver', '')
for closed in (built / 'install' / 'my_driver' / 'lib', built / 'install'):
    closed.chmod(0)
    try:
        find_executable(built, package, 'follow_path')
    except ValueError as error:
        print(error)
with Jail(find_sandbox('none'), built) as jail:
    try:
        sourced(jail)
    except ValueError as error:
        print(error)
closed.chmod(0o755)
"""


def test_a_folder_closed_by_its_build_costs_its_student_alone(tmp_path: Path) -> None:
    workspace = tmp_path / 'workspace'
    write_package(workspace / 'src' / 'my_driver')
    install(workspace, 'my_driver', 'lib/my_driver')
    arguments = ['-c', CLOSED, str(workspace), str(workspace.with_name('built'))]
    command = as_ordinary_user([sys.executable, *arguments])
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, '')
    assert done.stdout.splitlines() == [
        'ros2 run my_driver follow_path finds nothing; my_driver has: no executables; install '
        'follow_path into lib/my_driver in its CMakeLists.txt',
        'ros2 run my_driver follow_path finds nothing: package my_driver was not built',
        'nothing was built',
    ]


def test_a_package_that_is_there_twice_is_named(tmp_path: Path) -> None:
    for place in ('src', 'src/copy'):
        write_package(tmp_path / 'ws' / place / 'my_driver', ABOUT)
    (tmp_path / 'built').mkdir()
    with Jail(find_sandbox('none'), tmp_path / 'built') as jail:
        found = build_step(tmp_path / 'ws', jail, tmp_path / 'log')
    twice = 'package my_driver is in src twice; take one of the two out'
    assert found.why == f'colcon build failed: {twice}'


SETUP = """from setuptools import setup
setup(name='my_driver', entry_points={'console_scripts': [%s]})
"""


@pytest.mark.parametrize(
    ('text', 'told'),
    [
        (
            'import os\nraise ValueError(os.getcwd())',
            'setup.py line 2: ValueError: ws/src/my_driver',
        ),
        (
            'from setuptools import setup\nprint("hello")\nsetup(name="my_driver")',
            'setup.py of my_driver prints to its standard output, which colcon reads; let it not',
        ),
    ],
    ids=['an error', 'a print'],
)
def test_a_setup_py_that_fails_is_told_why(tmp_path: Path, text: str, told: str) -> None:
    assert built_with(text, tmp_path) == f'colcon build failed: {told}'


# In words of setuptools, or of the lab's colcon, which a sourced ROS has not.
@pytest.mark.parametrize(
    ('text', 'told'),
    [
        (
            SETUP % "'a = my_driver.a:main' 'b = my_driver.b:main'",
            'my_driver.a:mainb = my_driver.b',
        ),
        (SETUP % "'a = my_driver/a:main'", 'my_driver/a:main'),
        ('import setuptools\n', 'setup.py does not call setup()'),
    ],
    ids=['no comma', 'no entry point', 'no setup'],
)
def test_what_colcon_does_not_tell_of_a_setup_py_is_told(
    tmp_path: Path, text: str, told: str
) -> None:
    why = built_with(text, tmp_path)
    assert why.startswith('colcon build failed: my_driver: ')
    assert told in why


HANGS = """import pathlib, sys, time
if '--version' in sys.argv:
    print('hello', flush=True)
    (pathlib.Path(__file__).parents[3] / 'built' / f'asked_{time.time_ns()}').touch()
    time.sleep(60.0)
"""


def test_all_setup_pys_that_are_asked_have_the_time_of_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr('husky_grader.lab.build_step.SOURCE_WITHIN_SEC', 3.0)
    for name in ('first', 'second', 'third'):
        export = '<export><build_type>ament_python</build_type></export>'
        package = write_package(tmp_path / 'ws' / 'src' / name, ABOUT, export)
        (package / 'setup.py').write_text(HANGS)
    assert built(tmp_path).startswith('colcon build failed: ')
    assert len(list((tmp_path / 'built').glob('asked_*'))) < 2


def built_with(text: str, tmp_path: Path) -> str:
    """Build a package with this setup.py; return what is found out."""
    export = '<export><build_type>ament_python</build_type></export>'
    package = write_package(tmp_path / 'ws' / 'src' / 'my_driver', ABOUT, export)
    (package / 'setup.py').write_text(text)
    return built(tmp_path)


def built(folder: Path) -> str:
    """Build the workspace `ws` in a folder; return what is found out."""
    (folder / 'built').mkdir()
    with Jail(find_sandbox('none'), folder / 'built') as jail:
        return build_step(folder / 'ws', jail, folder / 'log').why


@pytest.mark.skipif(SOURCED, reason='the colcon of a ROS that is sourced passes over it')
def test_what_a_manifest_has_that_colcon_cannot_read_is_told(tmp_path: Path) -> None:
    export = '<export><build_type>ament_cmake</build_type></export>'
    about = ABOUT.replace('a@example.org', 'a@home')
    package = write_package(tmp_path / 'ws' / 'src' / 'my_msgs', about, export)
    (package / 'CMakeLists.txt').write_text(
        'project(my_msgs)\nfind_package(ament_cmake REQUIRED)\n'
    )
    told = 'my_msgs: package.xml: Invalid email "a@home" for person "a"'
    assert built(tmp_path) == f'colcon build failed: {told}'


def test_a_build_of_no_package_is_no_success(tmp_path: Path) -> None:
    export = '<export><build_type>ament_python</build_type></export>'
    package = write_package(tmp_path / 'ws' / 'src' / 'my_driver', ABOUT, export)
    (package / 'setup.py').write_text(SETUP % '')
    (package / 'colcon.pkg').write_text('{"type": "unknown"}')
    assert built(tmp_path).startswith('colcon build has built no package: it passed over all')


def test_a_program_of_a_package_that_failed_is_not_told_of_its_entry_point(tmp_path: Path) -> None:
    workspace = tmp_path / 'workspace'
    package = write_package(workspace / 'src' / 'my_driver')
    (package / 'setup.py').touch()
    install(workspace, 'my_driver', 'share/my_driver')
    with pytest.raises(ProgramMissing, match=r'add .* to console_scripts in its setup'):
        programs_of(workspace).command_of(DRIVE)
    left = tmp_path / 'built' / 'build' / 'my_driver' / 'colcon_build.rc'
    left.parent.mkdir(parents=True)
    left.write_text('1\n')
    with pytest.raises(
        ProgramMissing, match='my_driver has: no executables; its build has failed'
    ):
        programs_of(workspace).command_of(DRIVE)
    with pytest.raises(ProgramMissing, match='no launch files; its build has failed'):
        programs_of(workspace).command_of(replace(DRIVE, executable='', launch='go.launch.py'))
    left.unlink()
    left.symlink_to('/proc/self/mem')  # a file that nobody can read from its beginning
    with pytest.raises(ProgramMissing, match=r'add .* to console_scripts in its setup'):
        programs_of(workspace).command_of(DRIVE)


def test_what_a_killed_grading_has_left_is_removed(tmp_path: Path) -> None:
    (tmp_path / 'running-a1b2c3d4' / 'home').mkdir(parents=True)
    (tmp_path / 'running-shoes_12').mkdir()
    rubric = Rubric(title='T', steps=(WorkspaceStep(points=1.0, name='workspace'),))
    grade_lab(tmp_path / 'ws', rubric, tmp_path, sandbox=find_sandbox('none'))
    assert [path.name for path in tmp_path.iterdir()] == ['running-shoes_12']
