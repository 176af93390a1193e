# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade whole workspaces: the lab's own packages as a student would hand them in, and broken."""

import json
from pathlib import Path
import shutil

from husky_driver.grade import main as grade
from husky_driver.lab_steps import driver_package, package_step, workspace_step
import pytest

SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """Return a workspace with our topic_demo and the template that students copy."""
    folder = tmp_path / 'CSE461_07_03'
    ignore = shutil.ignore_patterns('test', '__pycache__', '*.egg-info')
    shutil.copytree(SOURCE / 'topic_demo', folder / 'src' / 'topic_demo', ignore=ignore)
    template = SOURCE / 'husky_driver' / 'template' / 'my_driver'
    shutil.copytree(template, folder / 'src' / 'my_driver', ignore=ignore)
    return folder


@pytest.mark.timeout(180)
def test_a_good_workspace_gets_every_point_but_those_of_the_unfinished_drive(
    workspace: Path, tmp_path: Path, courses: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    profile = courses.parent / 'fastdds.xml'
    monkeypatch.setenv('FASTDDS_DEFAULT_PROFILES_FILE', str(profile))
    report = tmp_path / 'report'
    arguments = ['--lab', str(workspace), '--report', str(report), '--real-time-factor', '4']
    assert grade(arguments) == 1
    steps = {step['name']: step for step in json.loads((report / 'lab.json').read_text())['steps']}
    drive = steps.pop('drive')
    short = {name: step for name, step in steps.items() if step['points'] < step['most']}
    assert short == {}
    assert set(steps) == {
        *('workspace', 'package topic_demo', 'package my_driver'),
        *('build', 'publisher', 'subscriber'),
    }
    assert 0.0 < drive['points'] < drive['most']
    assert 'missed waypoint 3 at (2.7, -2.6)' in drive['why']
    assert (report / 'drive' / 'report.html').is_file()
    assert not (workspace / 'install').exists()


@pytest.mark.timeout(120)
def test_a_broken_workspace_is_told_what_to_do_at_every_step(
    workspace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    setup = workspace / 'src' / 'topic_demo' / 'setup.py'
    setup.write_text(setup.read_text().replace("'subscriber = ", "'listener = "))
    publisher = workspace / 'src' / 'topic_demo' / 'topic_demo' / 'publisher.py'
    publisher.write_text(publisher.read_text().replace("'topic_test'", "'topic_text'"))
    monkeypatch.setattr('husky_driver.lab_graph.APPEAR_WITHIN_SEC', 6.0)
    shutil.rmtree(workspace / 'src' / 'my_driver')
    report = tmp_path / 'report'
    assert grade(['--lab', str(workspace), '--report', str(report)]) == 1
    why = {
        step['name']: step['why']
        for step in json.loads((report / 'lab.json').read_text())['steps']
        if step['points'] < step['most']
    }
    assert why['package husky_driver'].endswith('packages there: topic_demo')
    assert why['publisher'] == 'it publishes on /topic_text; the sheet asks for /topic_test'
    assert (
        'ros2 run topic_demo subscriber finds nothing; topic_demo has: listener'
        in (why['subscriber'])
    )
    assert 'ros2 run husky_driver follow_path finds nothing' in why['drive']


def test_a_workspace_of_another_name_gets_half_of_its_points(tmp_path: Path) -> None:
    (tmp_path / 'ws' / 'src').mkdir(parents=True)
    step = workspace_step(tmp_path / 'ws', 5.0)
    assert step.points == 2.5
    assert 'CSE461_<section>_<group>' in step.why
    assert workspace_step(tmp_path, 5.0).points == 0.0


def test_a_manifest_that_lacks_a_dependency_is_told_the_line(workspace: Path) -> None:
    manifest = workspace / 'src' / 'topic_demo' / 'package.xml'
    manifest.write_text(manifest.read_text().replace('<exec_depend>std_msgs</exec_depend>', ''))
    step = package_step(workspace, 'topic_demo', 10.0)
    assert step.points == 5.0
    assert step.why == 'package.xml lacks: <exec_depend>std_msgs</exec_depend>'
    assert driver_package(workspace) == 'my_driver'


def test_a_workspace_that_is_not_there_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert grade(['--lab', str(tmp_path / 'nothing')]) == 2
    assert 'no such folder; give your workspace' in capsys.readouterr().err
