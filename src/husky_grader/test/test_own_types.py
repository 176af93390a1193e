# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Rubrics with types of their own, and steps with a Husky beside: built, run and judged."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
import errno
import fcntl
import importlib.util
import os
from pathlib import Path
import shutil
import subprocess
import sys

from husky_course.checked_yaml import FileRefused
from husky_grader.autograder.packed_rubric import packed_rubric
from husky_grader.graded import StepGrade
from husky_grader.jail import find_sandbox
from husky_grader.lab.lab import grade_lab
from husky_grader.rubric.own_types import build_types, find_types, with_types
from husky_grader.rubric.rubric_file import load_rubric
from husky_grader.rubric.steps import BuildStep, PublisherStep, Rubric
from playpen_testing.which_ros import SOURCED
import pytest

ROOT = Path(__file__).resolve().parents[3]
RUBRIC = ROOT / 'docs' / 'rubrics' / 'services_messages_frames.yaml'
INTERFACES = RUBRIC.with_name('odometer_interfaces')
NO_TYPE = (
    "'flaot64 distance_m' of 'odometer_interfaces/Distance': ''flaot64' is an invalid message name"
    if SOURCED
    else "Distance.msg:1: 'flaot64' is no type"
)
ODOMETER = """
import math

from nav_msgs.msg import Odometry
from odometer_interfaces.msg import Distance
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Odometer(Node):

    def __init__(self):
        super().__init__('odometer')
        self.distance, self.last = 0.0, None
        self.publisher = self.create_publisher(Distance, 'distance', 10)
        self.create_subscription(Odometry, 'odometry/filtered', self.on_odometry, 10)

    def on_odometry(self, odometry):
        here = odometry.pose.pose.position.x, odometry.pose.pose.position.y
        self.distance += math.dist(here, self.last or here)
        self.last = here
        self.publisher.publish(Distance(distance_m=self.distance))


def main():
    rclpy.init()
    try:
        rclpy.spin(Odometer())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
"""


# Each a program of the package odometer.
PROGRAMS = {
    'odometer': ODOMETER,
    'forgets': ODOMETER.replace('+= math', '= math'),
    'guesses': ODOMETER.replace('distance_m=self.distance', 'distance_m=1.3'),
}


@pytest.fixture(scope='module')
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Build types anew, once for all that only use them, and let programs find each other."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv('XDG_CACHE_HOME', str(tmp_path_factory.mktemp('cache')))
        patched.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        profiles = ROOT / 'config' / 'fastdds.xml'
        patched.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(profiles))
        build_types.cache_clear()
        yield
        build_types.cache_clear()


@pytest.fixture
def own_cache(cache: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """Build types anew for a test alone."""
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'cache'))
    build_types.cache_clear()
    yield
    build_types.cache_clear()


def rubric_of_distance(executables: Iterable[str]) -> Rubric:
    """Return a rubric that asks of each executable what the lab asks of the first."""
    rubric = load_rubric(RUBRIC)
    (build,) = (step for step in rubric.steps if isinstance(step, BuildStep))
    (distance,) = (step for step in rubric.steps if step.name == 'distance')
    assert isinstance(distance, PublisherStep)
    steps = [
        replace(distance, name=name, executable=name, needs_one_of=()) for name in executables
    ]
    return replace(rubric, steps=(replace(build, needs_one_of=()), *steps))


@pytest.fixture(scope='module')
def package(module_path: Path) -> Path:
    """Create the package as a student does, and write all programs."""
    create = ['ros2', 'pkg', 'create', 'odometer', '--build-type', 'ament_python']
    create += ['--node-name', 'odometer']
    subprocess.run(create, cwd=module_path, check=True, stdout=subprocess.DEVNULL)
    setup = module_path / 'odometer' / 'setup.py'
    script = "'odometer = odometer.odometer:main'"
    assert script in setup.read_text()
    scripts = [f"'{name} = odometer.{name}:main'" for name in PROGRAMS]
    setup.write_text(setup.read_text().replace(script, ', '.join(scripts)))
    for name, program in PROGRAMS.items():
        (setup.parent / 'odometer' / f'{name}.py').write_text(program)
    return setup.parent


def grades_of_distance(
    folder: Path, package: Path, executables: Iterable[str] = ('odometer',)
) -> dict[str, StepGrade]:
    """Grade programs of the package, beside what is in src; return their grades by name."""
    workspace = folder / 'workspace'
    shutil.copytree(package, workspace / 'src' / 'odometer')
    rubric, sandbox = rubric_of_distance(executables), find_sandbox('auto')
    grades = grade_lab(workspace, rubric, folder / 'report', sandbox=sandbox)
    return {grade.name: grade for grade in grades}


def own_interfaces(folder: Path) -> Path:
    return Path(shutil.copytree(INTERFACES, folder / 'workspace' / 'src' / INTERFACES.name))


@pytest.fixture(scope='module')
def grades(cache: None, module_path: Path, package: Path) -> dict[str, StepGrade]:
    """Grade all programs, in one workspace with the interfaces of the lab."""
    own_interfaces(module_path)
    return grades_of_distance(module_path, package, PROGRAMS)


@pytest.mark.timeout(180)
def test_a_distance_is_judged_after_the_husky_has_driven(grades: dict[str, StepGrade]) -> None:
    grade = grades['odometer']
    assert grade.is_full, grade.why
    assert grade.why.endswith('Hz on /distance, odometer_interfaces/msg/Distance')


@pytest.mark.timeout(180)
def test_a_distance_that_does_not_grow_is_seen(grades: dict[str, StepGrade]) -> None:
    grade = grades['forgets']
    assert grade.why.startswith('distance_m is ')
    assert 'the lab asks for 1.2 or more' in grade.why
    assert grade.points == grade.most / 2


@pytest.mark.timeout(180)
def test_a_distance_that_needs_no_husky_is_worth_nothing(grades: dict[str, StepGrade]) -> None:
    grade = grades['guesses']
    assert grade.points == 0
    assert grade.why == 'what it publishes is the same before the Husky has driven'


@pytest.mark.timeout(90)
@pytest.mark.usefixtures('cache')
def test_another_definition_of_the_message_is_told_by_its_fields(
    tmp_path: Path, package: Path
) -> None:
    message = own_interfaces(tmp_path) / 'msg' / 'Distance.msg'
    message.write_text('builtin_interfaces/Time stamp\nfloat32 distance_m\nuint32 resets\n')
    grade = grades_of_distance(tmp_path, package)['odometer']
    assert grade.points == 0
    assert grade.why == (
        'its odometer_interfaces/msg/Distance has other fields; the lab asks for stamp '
        '(builtin_interfaces/Time), distance_m (float64), resets (uint32)'
    )


@pytest.mark.timeout(90)
@pytest.mark.usefixtures('cache')
@pytest.mark.parametrize('is_sourced', [False, True])
def test_the_types_of_the_grader_are_no_types_of_the_students(
    tmp_path: Path, package: Path, monkeypatch: pytest.MonkeyPatch, is_sourced: bool
) -> None:
    if is_sourced:  # as by a terminal in which somebody's solution is sourced
        for name, value in with_types(os.environ, (INTERFACES,)).items():
            monkeypatch.setenv(name, value)
    grade = grades_of_distance(tmp_path, package)['odometer']
    assert grade.points == 0
    assert "ModuleNotFoundError: No module named 'odometer_interfaces'" in grade.why


def fill_the_disk(path: Path, *_: object, **__: object) -> None:
    path.touch()
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.usefixtures('own_cache')
def test_types_are_built_once_and_anew_when_need_be(tmp_path: Path) -> None:
    package = Path(shutil.copytree(INTERFACES, tmp_path / 'other' / INTERFACES.name))
    with pytest.MonkeyPatch.context() as full:
        full.setattr(Path, 'write_text', fill_the_disk)
        with pytest.raises(OSError, match='No space left'):
            build_types((package,))
    first = build_types((package,))
    build_types.cache_clear()
    built = Path(first['AMENT_PREFIX_PATH'].split(':')[0])
    since = built.stat().st_mtime_ns
    assert build_types((package,)) == first
    assert built.stat().st_mtime_ns == since
    # A build that was killed is done again, ...
    kept = next((tmp_path / 'cache' / 'husky_playpen_lab' / 'interfaces').glob('*/variables.json'))
    kept.unlink()
    shutil.rmtree(kept.parent / 'install')
    build_types.cache_clear()
    assert build_types((package,)) == first
    assert (kept.parent / 'install' / 'share' / 'odometer_interfaces' / 'package.xml').is_file()
    # ... and one of what has changed since.
    with (package / 'msg' / 'Distance.msg').open('a') as stream:
        stream.write('bool moving\n')
    build_types.cache_clear()
    assert build_types((package,)) != first


@pytest.mark.usefixtures('own_cache')
def test_types_of_the_rubric_go_before_those_of_a_sourced_workspace(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = Path(shutil.copytree(INTERFACES, tmp_path / 'spare_interfaces'))
    for file in (path for path in package.rglob('*') if path.is_file()):
        file.write_text(file.read_text().replace(INTERFACES.name, package.name))
    sourced = tmp_path / 'workspace' / package.name
    sourced.mkdir(parents=True)
    (sourced / '__init__.py').touch()
    monkeypatch.setattr(sys, 'path', [str(sourced.parent), *sys.path])
    find_types((package,))
    found = importlib.util.find_spec(f'{package.name}.msg')
    assert found is not None
    assert Path(found.origin or '').is_relative_to(tmp_path / 'cache')


@pytest.mark.usefixtures('own_cache')
def test_a_wrong_definition_is_a_mistake_of_the_rubric(tmp_path: Path) -> None:
    package = Path(shutil.copytree(INTERFACES, tmp_path / INTERFACES.name))
    (package / 'msg' / 'Distance.msg').write_text('flaot64 distance_m\n')
    file = tmp_path / 'rubric.yaml'
    steps = 'steps:\n  - {kind: build, points: 1}\n'
    file.write_text(f'title: T\ninterfaces: [odometer_interfaces]\n{steps}')
    with pytest.raises(FileRefused) as refused:
        load_rubric(file)
    told = str(refused.value)
    assert told.startswith(f'{file}: line 2, column 13: interfaces: ')
    assert NO_TYPE in told
    assert '\n' not in told
    file.write_text(f'title: T\ninterfaces: [none]\n{steps}')
    with pytest.raises(
        FileRefused, match=r'none has no package\.xml; name the folder of a package'
    ):
        load_rubric(file)


@pytest.mark.usefixtures('own_cache')
def test_a_cache_that_cannot_be_written_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / 'file').touch()
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'file'))
    with pytest.raises(ValueError, match='let XDG_CACHE_HOME name a folder that can be written'):
        build_types((INTERFACES,))


@pytest.mark.usefixtures('cache')
def test_what_a_rubric_is_read_from_holds_its_interfaces() -> None:
    rubric = load_rubric(RUBRIC)
    assert rubric.packages == ('odometer_interfaces', 'odometer')
    assert rubric.files[0] == RUBRIC
    assert INTERFACES / 'msg' / 'Distance.msg' in rubric.files
    assert RUBRIC.parent / 'courses' / 'short.yaml' in rubric.files
    packed = packed_rubric(rubric)
    assert 'docs/rubrics/odometer_interfaces/msg/Distance.msg' in packed.files


@pytest.mark.usefixtures('own_cache')
def test_a_machine_without_colcon_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('PATH', str(tmp_path))
    with pytest.raises(ValueError, match='colcon, which builds them, is not installed here'):
        build_types((INTERFACES,))


@pytest.mark.usefixtures('own_cache')
def test_a_cache_that_cannot_be_locked_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_locks(*_: object) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))  # as by NFS without its daemon

    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    monkeypatch.setattr(fcntl, 'flock', no_locks)
    with pytest.raises(ValueError, match='No locks available; let XDG_CACHE_HOME name a folder'):
        build_types((INTERFACES,))


def test_a_user_without_a_home_is_told() -> None:
    somebody = ['unshare', '--user', '--map-user=12345', 'env', '-u', 'HOME']
    if subprocess.run([*somebody, 'true'], capture_output=True).returncode != 0:
        pytest.skip('nobody else can be made here')
    environment = {name: value for name, value in os.environ.items() if name != 'XDG_CACHE_HOME'}
    program = (
        'from pathlib import Path\n'
        'from husky_grader.jail import Limits\n'
        'from husky_grader.jail.folders import mounts_of\n'
        'from husky_grader.rubric.own_types import build_types\n'
        'mounts_of(Path("/tmp"), (), Limits())\n'
        f'build_types((Path({str(INTERFACES)!r}),))\n'
    )
    run = subprocess.run(
        [*somebody, sys.executable, '-c', program], env=environment, capture_output=True, text=True
    )
    last = run.stderr.splitlines()[-1]
    assert 'ValueError: interfaces cannot be built in ~/.cache/' in last
    assert 'this user has no home; let XDG_CACHE_HOME name a folder that can be written' in last
