# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The other lab of docs/rubrics.md: a right solution and two wrong ones, built and run."""

from dataclasses import replace
from pathlib import Path
import subprocess

from husky_grader.graded import StepGrade
from husky_grader.jail import find_sandbox
from husky_grader.lab.lab import grade_lab
from husky_grader.rubric.rubric_file import load_rubric
from husky_grader.rubric.steps import BuildStep, PublisherStep, ServiceStep, Step
import pytest

# Each program is waited for up to ten times longer on a busy machine: patience.MOST_TIMES.
pytestmark = pytest.mark.timeout(400)
ROOT = Path(__file__).resolve().parents[3]
RUBRIC = load_rubric(ROOT / 'docs' / 'rubrics' / 'services_and_parameters.yaml')
FORCE_SENSOR = """
from geometry_msgs.msg import WrenchStamped
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger


class ForceSensor(Node):

    def __init__(self):
        super().__init__('force_sensor')
        self.load = self.declare_parameter('load_n', 0.0).value
        rate = self.declare_parameter('rate_hz', 10.0).value
        self.zero = 0.0
        self.publisher = self.create_publisher(WrenchStamped, 'wrench', 10)
        self.create_service(Trigger, 'tare', self.on_tare)
        self.create_timer(1.0 / rate, self.on_timer)

    def on_tare(self, request, response):
        self.zero = self.load
        response.success = True
        response.message = f'tared at {self.load} N'
        return response

    def on_timer(self):
        message = WrenchStamped()
        message.header.frame_id = 'force_sensor'
        message.wrench.force.z = self.load - self.zero
        self.publisher.publish(message)


def main():
    rclpy.init()
    try:
        rclpy.spin(ForceSensor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
"""


LAUNCHED = 'wrench force_sensor'  # by its launch file, and not as an executable
LAUNCH = """
<launch>
  <arg name="rate_hz"/>
  <arg name="load_n"/>
  <node pkg="force_sensor" exec="force_sensor">
    <param name="rate_hz" value="$(var rate_hz)"/>
    <param name="load_n" value="$(var load_n)"/>
  </node>
</launch>
"""

# Each a program of the package force_sensor; its steps have its name behind theirs.
PROGRAMS = {
    'force_sensor': FORCE_SENSOR,
    'unset': FORCE_SENSOR.replace('1.0 / rate', '0.1').replace(
        "self.declare_parameter('load_n', 0.0).value", '0.0'
    ),
    'other_type': FORCE_SENSOR.replace('create_service(Trigger', 'create_service(SetBool'),
}


def steps_of(program: str) -> list[Step]:
    """Return the steps in which the rubric runs the program, for this one in its place."""
    steps: list[Step] = []
    for step in RUBRIC.steps:
        if isinstance(step, (PublisherStep, ServiceStep)):
            changed = replace(
                step,
                name=f'{step.name} {program}',
                executable=program,
                needs=tuple(f'{name} {program}' for name in step.needs),
            )
            if changed.name == LAUNCHED:
                given = tuple(f'{name}:={value}' for name, value in step.parameters.items())
                changed = replace(changed, executable='', launch='weigh.launch.xml')
                changed = replace(changed, arguments=given, parameters={})
            hurried = program == 'other_type'  # it will never do what is asked
            steps.append(replace(changed, within_sec=4.0) if hurried else changed)
    return steps


@pytest.fixture(scope='module')
def graded(module_path: Path) -> dict[str, StepGrade]:
    """Let a student create the package and write the programs; return the grades by step."""
    source = module_path / 'workspace' / 'src'
    source.mkdir(parents=True)
    create = ['ros2', 'pkg', 'create', 'force_sensor', '--build-type', 'ament_python']
    create += ['--node-name', 'force_sensor', '--license', 'Apache-2.0']
    create += ['--description', 'Weighs.', '--dependencies', 'rclpy', 'geometry_msgs', 'std_srvs']
    subprocess.run(create, cwd=source, check=True, stdout=subprocess.DEVNULL)
    package = source / 'force_sensor'
    script = "'force_sensor = force_sensor.force_sensor:main'"
    setup = (package / 'setup.py').read_text()
    assert script in setup
    scripts = [f"'{name} = force_sensor.{name}:main'" for name in PROGRAMS]
    (package / 'setup.py').write_text(setup.replace(script, ', '.join(scripts)))
    installed = "['package.xml']),"
    setup = (package / 'setup.py').read_text()
    launch = "('share/force_sensor/launch', ['launch/weigh.launch.xml']),"
    (package / 'setup.py').write_text(setup.replace(installed, installed + launch))
    (package / 'launch').mkdir()
    (package / 'launch' / 'weigh.launch.xml').write_text(LAUNCH)
    for name, program in PROGRAMS.items():
        (package / 'force_sensor' / f'{name}.py').write_text(program)
    given, build, *_ = RUBRIC.steps
    assert isinstance(build, BuildStep)
    tried = [step for name in PROGRAMS for step in steps_of(name)]
    needed = tuple(f'{name} unset' for name in build.needs_one_of)  # of which one has points
    rubric = replace(RUBRIC, steps=(given, replace(build, needs_one_of=needed), *tried))
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        profiles = ROOT / 'config' / 'fastdds.xml'
        patched.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(profiles))
        report, sandbox = module_path / 'report', find_sandbox('auto')
        grades = grade_lab(module_path / 'workspace', rubric, report, sandbox=sandbox)
    return {grade.name: grade for grade in grades}


def points_of(graded: dict[str, StepGrade], program: str) -> dict[str, float]:
    """Return the points that the steps would have if it were the only program."""
    points = {name: graded[name].points for name in ('package force_sensor', 'build')}
    names = [step.name for step in steps_of(program)]
    return {**points, **{name.split()[0]: graded[name].points for name in names}}


def test_a_right_force_sensor_gets_every_point(graded: dict[str, StepGrade]) -> None:
    points = points_of(graded, 'force_sensor')
    assert points == {step.name: step.points for step in RUBRIC.steps}, graded
    assert sum(points.values()) == 100.0


def test_one_that_takes_no_parameters_gets_its_service_only(graded: dict[str, StepGrade]) -> None:
    assert points_of(graded, 'unset') == {
        'package force_sensor': 10,
        'build': 10,
        'wrench': 0,
        'tare': 20,
        'tared': 0,
    }
    assert graded['wrench unset'].why == (
        'wrench.force.z is 0.0; the lab asks for 7.49 or more and 7.51 or less; '
        'about 10 messages a second; the lab asks for 20; '
        'it was run with --ros-args -p rate_hz:=20.0 -p load_n:=7.5'
    )
    assert graded['tared unset'].why.startswith('counts only with points for wrench unset; ')


def test_one_with_another_type_of_service_is_told_the_right(graded: dict[str, StepGrade]) -> None:
    points = points_of(graded, 'other_type')
    assert points == {'package force_sensor': 10, 'build': 10, 'wrench': 40, 'tare': 0, 'tared': 0}
    wrong = 'it offers /tare as std_srvs/srv/SetBool; the lab asks for std_srvs/srv/Trigger'
    for name, load in (('tare', '2.5'), ('tared', '7.5')):
        told = f'{wrong}; it was run with --ros-args -p load_n:={load}'
        assert graded[f'{name} other_type'].why == told
