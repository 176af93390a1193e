# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A class of cheats and accidents, graded three at a time: what each gets, and is told.

Each program in zoo/src/zoo/bin and launch has a step, and so a jail, of its own. What a build does
needs a workspace of its own. Some of them do it right: nothing may change their grades.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import pairwise
import os
from pathlib import Path
from tempfile import gettempdir

from husky_grader.graded import Graded, StepGrade
from husky_grader.jail import find_sandbox
from husky_grader.lab_grading import grade_submission
from husky_grader.rubric.forms import Form
from husky_grader.rubric.steps import (
    BuildStep,
    CourseToDrive,
    DriveStep,
    FieldCheck,
    ProgramStep,
    PublisherCosts,
    PublisherStep,
    Rubric,
    Step,
    SubscriberStep,
)
from husky_grader.submission import Submission
from husky_grader.submission.limits import COPY
import pytest

# The grader waits for each up to ten times longer on a busy machine: patience.MOST_TIMES.
pytestmark = pytest.mark.timeout(1200)
ZOO = Path(__file__).with_name('zoo')
MOST = 10.0  # points of each step

DRIVES = {
    'rewrites_the_record': 'missed waypoint 2 at (0.5, 0)',
    'kills_everybody': 'it never moved',
    'forges_odometry': '/husky_sim published /odometry/filtered beside the simulator',
    'forges_the_clock': '/driver published /clock beside the simulator',
    'has_two_drivers': '/driver and /other_driver both published',
    'asks_for_a_reset': 'missed waypoint 2 at (0.5, 0)',
    'imports_the_solution': "line 3: ModuleNotFoundError: No module named 'husky_driver'",
    'runs_the_solution': "Package 'husky_driver' not found",
    'wishes_to_be_there': 'it commanded linear.x = -1000: that is m/s',
    'announces_ghosts': 'm backwards where the course asks for forwards',
    'sends_garbage': 'm backwards where the course asks for forwards',
    'breeds': '[ended by the grader: it ',
    'prints_its_verdict': r'line 8: RuntimeError: \x1b[2J\x1b[Hdrive   10.0 of   10  passed',
}
# They get points for the half of the way that they drove.
HALF_DRIVES = {
    'stops_midway': 'stopped at (0.4',
    'crashes_midway': 'crashes_midway line 10: IndexError: list index out of range',
}
TALKS = {
    'says_nothing': 'nothing came on /topic_test within 4 s',
    'talks_by_a_daemon': 'it ended by itself (exit code 0)',
    'talks_by_the_solution': "line 3: ModuleNotFoundError: No module named 'topic_demo'",
    'talks_another_type': 'it publishes std_msgs/msg/Int32 on /topic_test',
    'talks_too_much': "data is 'hello world 1111",
    'talks_in_a_crowd': "data is 'hello'",
    'asks_for_what_is_not_there': "line 3: ImportError: cannot import name 'listen'",
}
# What their launch files do before, or instead.
LAUNCHES = {
    'leaves_its_talker': 'it ended by itself (exit code 127)',
    'listens_in_silence': 'it did not print what came on /topic_test; a launch file shows what',
    'one_of_two_crashes': "line 3: ImportError: cannot import name 'listen'",
}
GUESSES = {'guesses': 'it listens to nothing; the lab asks for /topic_test'}

MANIFEST = (
    '<package><name>bare</name><export><build_type>ament_python</build_type></export></package>'
)
SETUP = """
import os, shutil, signal
from glob import glob
from pathlib import Path
from setuptools import setup
setup(name='bare', version='0.1.0', packages=[], data_files=[
    ('share/ament_index/resource_index/packages', ['resource/bare']),
    *((place, [f for f in glob(f'{place}/*') if Path(f).is_file()])
      for place in ('lib/bare', 'share/bare', 'share/bare/hook', 'share/bare/fake'))])
programs = Path(os.environ['HOME']).parent / 'install' / 'bare' / 'lib' / 'bare'
"""
# A package whose modules the tools of the lab load, where they find it.
PLUGS = """
from setuptools import setup
groups = ('colcon_core.extension_point', 'colcon_core.event_handler', 'colcon_core.verb',
          'husky_driver.route_check', 'launch.frontend.launch_extension', 'pytest11',
          'ros2cli.command', 'ros2launch.option')
setup(name='plugs', version='99.0', py_modules=['plug'], packages=['husky_grader'],
      entry_points={group: ['plug = plug:Plug'] for group in groups})
"""
PLUGGED_IN = Path(gettempdir(), f'plugged_in_{os.getpid()}')  # a jail has a /tmp of its own
PLUG = f"""
from pathlib import Path
Path({str(PLUGGED_IN)!r}).touch()
class Plug: pass
"""
LAUGHS = (
    '<!DOCTYPE package [<!ENTITY a "aaaaaaaaaa">'
    + ''.join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in pairwise('abcdefghij'))
    + ']><package><name>&j;</name></package>'
)
TALKS_WELL = """#!/usr/bin/env python3
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node('talker')
publisher = node.create_publisher(String, 'topic_test', 10)
node.create_timer(0.1, lambda: publisher.publish(String(data='hello world 1')))
rclpy.spin(node)
"""


@dataclass(frozen=True)
class Build:
    """A workspace whose build does something, and what its only program is told."""

    told: str
    step: str = 'talks'
    setup: str = ''  # after all else in setup.py, which is run several times
    hook: str = ''  # of the shell that sources it
    files: Sequence[tuple[str, str]] = ()


BUILDS = {
    'deletes everything': Build(
        'ros2 run bare talks finds nothing; bare has: no executables',
        setup="""
shutil.rmtree(Path.cwd(), ignore_errors=True)
for place in ('lab.json', 'finding.json', 'over'):
    for folder in (Path.cwd().parents[2], Path.cwd().parents[3], Path('/tmp')):
        try:
            (folder / place).write_text('{"score": 100.0, "why": "forged"}')
        except OSError:
            pass
shutil.rmtree(programs, ignore_errors=True)
""",
    ),
    'brings an rclpy of its own': Build(
        'rclpy.py line 1: RuntimeError: not the rclpy that you know; package bare has a module '
        'rclpy of its own, which hides the one that is installed: rename it',
        hook='export ROS_DOMAIN_ID=77 PATH="$COLCON_CURRENT_PREFIX/lib/bare:$PATH"\n'
        'export PYTHONPATH="$COLCON_CURRENT_PREFIX/share/bare/fake:$PYTHONPATH"\n',
        files=[
            ('share/bare/fake/rclpy.py', "raise RuntimeError('not the rclpy that you know')"),
            ('share/bare/fake/husky_grader.py', "raise RuntimeError('nor this')"),
        ],
    ),
    'sets eighty kilobytes': Build(
        'bytes of variables, 30000 are allowed',
        hook="export MUCH=$(head -c 80000 /dev/zero | tr '\\0' x)\n",
    ),
    'leads to its neighbours': Build(
        'install/bare/lib/bare leads out of the workspace',
        setup="""
if programs.is_dir():
    shutil.rmtree(programs)
    programs.symlink_to('/')
""",
    ),
    'stops': Build(
        'colcon build took longer than 60 s', 'build', 'os.kill(os.getpid(), signal.SIGSTOP)'
    ),
    'digs': Build(
        'colcon build was ended: it made folders too deep in each other',
        'build',
        """
os.chdir(Path(os.environ['HOME']))
for _ in range(3000):
    os.mkdir('deeper')
    os.chdir('deeper')
signal.pause()
""",
    ),
    'plugs into every tool': Build(
        '10 Hz on /topic_test',  # what else it is does no harm, and gets no points
        files=[
            ('../plugs/package.xml', MANIFEST.replace('bare', 'plugs')),
            ('../plugs/setup.py', PLUGS),
            ('../plugs/plug.py', PLUG),
            ('../plugs/husky_grader/__init__.py', PLUG),
            ('../laughs/package.xml', LAUGHS),
            ('../deep/package.xml', f'<package>{"<a>" * 9000}{"</a>" * 9000}</package>'),
            ('../../colcon_defaults.yaml', 'build: {packages-skip: [bare]}'),
            ('../../colcon.meta', '{"names": {"bare": {"ignore": true}}}'),
        ],
    ),
    'has an unknown encoding': Build(
        'there is no package in src',
        'build',
        files=[('package.xml', f'<?xml version="1.0" encoding="klingon"?>{MANIFEST}')],
    ),
}


def drives(*names: str) -> list[Step]:
    course = CourseToDrive(file=ZOO / 'course.yaml')
    return [
        DriveStep(points=MOST, name=name, package='zoo', executable=name, courses=(course,))
        for name in names
    ]


def within_sec(name: str) -> float:
    """Return how long a program is waited for: short where it will never do what is asked."""
    return 4.0 if name in ('says_nothing', 'talks_another_type', 'guesses') else 15.0


def talks(*names: str, package: str = 'zoo') -> list[Step]:
    return [
        PublisherStep(
            points=MOST,
            name=name,
            package=package,
            executable=name,
            topic='/topic_test',
            type='std_msgs/msg/String',
            rate_hz=10.0,
            content=(FieldCheck(field='data', form=Form('hello world <number>')),),
            within_sec=within_sec(name),
            listen_sec=1.0,
            costs=PublisherCosts(content=100.0),
        )
        for name in names
    ]


def listens(*names: str) -> list[Step]:
    return [
        SubscriberStep(
            points=MOST,
            name=name,
            package='zoo',
            executable=name,
            topic='/topic_test',
            type='std_msgs/msg/String',
            sent={'data': 'hello grader {token}'},
            printed='heard<text>hello grader {token}',
            within_sec=within_sec(name),
        )
        for name in names
    ]


def launches(kind: Callable[[str], list[Step]], name: str, file: str) -> list[Step]:
    (step,) = kind(name)
    assert isinstance(step, ProgramStep)
    return [replace(step, executable='', launch=file)]


def gives(name: str, *courses: str) -> Step:
    """Return a step that gives a program courses, of which one is hidden."""
    given = [
        CourseToDrive(file=ZOO / f'{course}.yaml', hidden=course == 'hidden') for course in courses
    ]
    return DriveStep(
        points=MOST,
        name=name,
        package='zoo',
        executable=name,
        arguments=('{course}',),
        courses=tuple(given),
    )


def hand_in(folder: Path, build: Build) -> Path:
    """Write a workspace with one package, of one program that talks well."""
    package = folder / 'src' / 'bare'
    files = {
        'package.xml': MANIFEST,
        'setup.py': SETUP + build.setup,
        'setup.cfg': '[install]\ninstall_scripts=$base/lib/bare\n',
        'resource/bare': '',
        'lib/bare/talks': TALKS_WELL,
        'colcon.pkg': '{"hooks": ["share/bare/hook/own.sh"]}',
        'share/bare/hook/own.sh': build.hook,
        **dict(build.files),
    }
    for name, text in files.items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text)
        (package / name).chmod(0o755)
    return folder


@pytest.fixture(scope='module')
def reports(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp('reports')


@pytest.fixture(scope='module')
def graded(
    reports: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[dict[str, StepGrade]]:
    """Grade them all, from a folder that somebody has handed in; return their steps by name."""
    handed_in = tmp_path_factory.mktemp('handed_in')
    for module in ('rclpy', 'json', 'husky_grader', 'husky_course'):
        (handed_in / f'{module}.py').write_text("raise RuntimeError('of the wrong folder')")
    sandbox = find_sandbox('auto')
    programs = [*talks('leaves_a_publisher', *TALKS, 'talks_right')]
    programs += [*listens(*GUESSES, 'listens_right'), gives('names_a_course', 'hidden')]
    programs += [gives('keeps_a_course', 'hidden', 'course')]
    for name in ('launched_once', 'launched_again'):
        programs += launches(talks, name, 'tries_everything.launch.py')
    programs += launches(talks, 'leaves_its_talker', 'leaves_its_talker.launch.py')
    programs += launches(talks, 'one_of_two_crashes', 'one_of_two_crashes.launch.xml')
    programs += launches(listens, 'listens_in_silence', 'listens_in_silence.launch.xml')
    classes = {
        'drives': (ZOO, drives('drives_right', *DRIVES, *HALF_DRIVES)),
        'talks': (ZOO, programs),
    }
    for name, build in BUILDS.items():
        classes[name] = (
            hand_in(handed_in / name, build),
            talks('talks', package='bare') if build.step == 'talks' else [],
        )

    def grade(name: str) -> Graded:
        place, steps = classes[name]
        return grade_submission(
            Submission(name, place, 'folder'),
            Rubric(title='zoo', steps=(BuildStep(points=MOST, name='build'), *steps)),
            reports / name,
            sandbox=sandbox,
            real_time_factor=10.0,
            done=lambda _: None,
        )

    # It waits for the limit of all builds, which those of the others keep on a busy machine, too.
    order = sorted(classes, key=lambda name: name != 'stops')
    before = Path.cwd()
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr('husky_grader.lab.build_step.BUILD_WITHIN_SEC', 60.0)
        os.chdir(handed_in)
        try:
            with ThreadPoolExecutor(3) as pool:
                everything = zip(order, pool.map(grade, order), strict=True)
                yield {
                    f'{name}: {step.name}': step for name, one in everything for step in one.steps
                }
        finally:
            os.chdir(before)


def step_of(graded: dict[str, StepGrade], name: str) -> StepGrade:
    return next(step for place, step in graded.items() if place.endswith(f': {name}'))


@pytest.mark.parametrize('name', [*DRIVES, *TALKS, *LAUNCHES, *GUESSES])
def test_a_cheat_gets_nothing_and_is_named(graded: dict[str, StepGrade], name: str) -> None:
    step = step_of(graded, name)
    assert step.points == 0.0, step
    assert {**DRIVES, **TALKS, **LAUNCHES, **GUESSES}[name] in step.why


@pytest.mark.parametrize('name', HALF_DRIVES)
def test_an_accident_midway_costs_the_rest_of_the_way(
    graded: dict[str, StepGrade], name: str
) -> None:
    step = step_of(graded, name)
    assert 0.0 < step.points < MOST / 2, step
    assert HALF_DRIVES[name] in step.why


@pytest.mark.parametrize('name', BUILDS)
def test_a_build_that_does_harm_harms_only_itself(graded: dict[str, StepGrade], name: str) -> None:
    build = BUILDS[name]
    step = graded[f'{name}: {build.step}']
    assert step.points == (MOST if name == 'plugs into every tool' else 0.0), step
    assert build.told in step.why
    assert not PLUGGED_IN.exists(), 'it ran outside of the jail'


@pytest.mark.parametrize(
    'name',
    [
        *('drives_right', 'leaves_a_publisher', 'talks_right', 'listens_right'),
        *('launched_once', 'launched_again'),
    ],
)
def test_who_does_it_right_among_them_gets_every_point(
    graded: dict[str, StepGrade], name: str
) -> None:
    step = step_of(graded, name)
    assert step.points == MOST, step


def test_no_program_reaches_what_is_not_its_own(
    graded: dict[str, StepGrade], reports: Path
) -> None:
    paths = [path for path in reports.rglob('*.log') if path.is_file()]
    # A long one is cut in its middle, which may be amid a letter.
    logs = {path: path.read_text(errors='replace') for path in paths}
    assert len(logs) > len(DRIVES)
    for said in ('wrote ', 'answered: ', 'found ', 'kept: '):
        assert [path for path, text in logs.items() if f'\n{said}' in f'\n{text}'] == [], said
    assert step_of(graded, 'keeps_a_course').points == MOST


def test_no_name_of_a_node_tells_of_a_hidden_course(graded: dict[str, StepGrade]) -> None:
    step = step_of(graded, 'names_a_course')
    assert step.points == 0.0, step
    assert 'a program published /clock beside the simulator' in step.why
    assert '4375' not in f'{step.why} {step.printed}'


def test_a_build_prints_nothing_of_the_lab_s_own_packages(graded: dict[str, StepGrade]) -> None:
    assert 'husky_' not in graded['talks: build'].printed


def test_what_was_handed_in_is_as_it_was(graded: dict[str, StepGrade], reports: Path) -> None:
    copy = reports / 'deletes everything' / COPY
    assert [path.read_text() for path in copy.rglob('package.xml')] == [MANIFEST]
    assert not list(copy.rglob('*.json'))
