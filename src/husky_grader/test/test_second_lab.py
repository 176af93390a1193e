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
from husky_grader.rubric.steps import PublisherStep, Rubric, ServiceStep
import pytest

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


def graded(folder: Path, program: str, rubric: Rubric = RUBRIC) -> dict[str, StepGrade]:
    """Let a student create the package and write the program; return the grades by step."""
    source = folder / 'workspace' / 'src'
    source.mkdir(parents=True)
    create = ['ros2', 'pkg', 'create', 'force_sensor', '--build-type', 'ament_python']
    create += [
        '--node-name',
        'force_sensor',
        '--license',
        'Apache-2.0',
        '--description',
        'Weighs.',
    ]
    create += ['--dependencies', 'rclpy', 'geometry_msgs', 'std_srvs']
    subprocess.run(create, cwd=source, check=True, stdout=subprocess.DEVNULL)
    (source / 'force_sensor' / 'force_sensor' / 'force_sensor.py').write_text(program)
    grades = grade_lab(
        folder / 'workspace', rubric, folder / 'report', sandbox=find_sandbox('auto')
    )
    return {grade.name: grade for grade in grades}


@pytest.fixture(autouse=True)
def graph(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let programs find each other quickly."""
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(ROOT / 'config' / 'fastdds.xml'))


@pytest.mark.timeout(60)
def test_a_right_force_sensor_gets_every_point(tmp_path: Path) -> None:
    grades = graded(tmp_path, FORCE_SENSOR)
    assert [grade for grade in grades.values() if not grade.is_full] == []
    assert sum(grade.points for grade in grades.values()) == 100.0


@pytest.mark.timeout(60)
def test_one_that_takes_no_parameters_gets_its_service_only(tmp_path: Path) -> None:
    program = FORCE_SENSOR.replace('1.0 / rate', '0.1').replace(
        "self.declare_parameter('load_n', 0.0).value", '0.0'
    )
    grades = graded(tmp_path, program)
    points = {name: grade.points for name, grade in grades.items()}
    assert points == {'package force_sensor': 10, 'build': 10, 'wrench': 0, 'tare': 20, 'tared': 0}
    assert grades['wrench'].why == (
        'wrench.force.z is 0.0; the lab asks for 7.49 or more and 7.51 or less; '
        'about 10 messages a second; the lab asks for 20'
    )
    assert grades['tared'].why.startswith('counts only with points for wrench; ')


@pytest.mark.timeout(60)
def test_one_with_another_type_of_service_is_told_the_right(tmp_path: Path) -> None:
    program = FORCE_SENSOR.replace('create_service(Trigger', 'create_service(SetBool')
    hurried = [
        replace(step, within_sec=4.0) if isinstance(step, (PublisherStep, ServiceStep)) else step
        for step in RUBRIC.steps
    ]
    grades = graded(tmp_path, program, replace(RUBRIC, steps=tuple(hurried)))
    points = {name: grade.points for name, grade in grades.items()}
    assert points == {'package force_sensor': 10, 'build': 10, 'wrench': 40, 'tare': 0, 'tared': 0}
    wrong = 'it offers /tare as std_srvs/srv/SetBool; the lab asks for std_srvs/srv/Trigger'
    assert grades['tare'].why == grades['tared'].why == wrong
