# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade whole workspaces: the lab's own packages as a student would hand them in, and broken."""

from collections.abc import Iterator
import contextlib
from dataclasses import replace
import io
import json
import os
from pathlib import Path
import shutil
import subprocess
import sys

from husky_grader.grade import main as grade
from husky_grader.jail import find_sandbox, Jail
from husky_grader.lab.build_step import build_step, sourced
from husky_grader.lab.drive_step import drive_step, DriveRunner
from husky_grader.lab.file_steps import package_step, workspace_step
from husky_grader.lab.finding import Finding
from husky_grader.lab.lab import grade_lab
from husky_grader.lab.live_steps import live_step
from husky_grader.lab.programs import Programs
from husky_grader.playpen import default_rubric
from husky_grader.rubric.rubric_file import load_rubric
from husky_grader.rubric.steps import (
    CourseToDrive,
    DriveLimits,
    DriveStep,
    PackageStep,
    PublisherStep,
    SubscriberStep,
    WorkspaceStep,
)
from husky_grader.run.live import drive_live
from playpen_testing.waiting import wait_until
import psutil
import pytest

# Neither its session, nor its parent, nor its environment tells where it comes from.
DAEMON = """
import os
if os.fork() == 0:
    os.setsid()
    os.closerange(0, 99)  # or colcon would wait for the end of its output
    os.open(os.devnull, os.O_RDWR), os.dup(0), os.dup(0)
    if os.fork() == 0:
        text = ('import os, sys, time; '
                'print(os.getpid(), file=open(sys.argv[1], "a"), flush=True); time.sleep(600)')
        os.execve({python!r}, [{python!r}, '-c', text, {pids!r}], {{}})
    os._exit(0)
os.wait()
"""
DEAF_COLCON = """#!%s
import os, signal, time
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, signal.SIG_IGN)
print('pid', os.getpid(), flush=True)
time.sleep(600)
"""
BUILD = """
from pathlib import Path
import sys
from husky_grader.lab.build_step import build_step
from husky_grader.jail import find_sandbox, Jail
workspace, report = map(Path, sys.argv[1:])
(report / 'built').mkdir()
with Jail(find_sandbox('none'), report / 'built') as jail:
    build_step(workspace, jail, report / 'build.log')
"""
PUBLISHER = """#!%s
import time, rclpy
from std_msgs.msg import String
rclpy.init()
publisher = rclpy.create_node('publisher').create_publisher(String, '%s', 10)
for number in range(1000):
    publisher.publish(String(data=f'hello world {time.time()}'))
    time.sleep(%g if number != 15 else 1.0)
"""
SUBSCRIBER = """#!%s
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node('subscriber')
node.create_subscription(String, 'topic_test', lambda m: print(%s, flush=True), 10)
rclpy.spin(node)
"""
FOLLOW_PATH = """#!%s
import sys
from husky_driver.follow_path import main
print(__file__, open(sys.argv[2]).read(), flush=True)
sys.exit(main(sys.argv))
"""
# A package that is built in no time.
PLAIN = """<package format="3">
  <name>my_driver</name><version>0.0.0</version><description>-</description>
  <maintainer email="a@example.org">A</maintainer><license>Apache-2.0</license>
  <export><build_type>cmake</build_type></export>
</package>"""
CMAKE = """
cmake_minimum_required(VERSION 3.8)
project(my_driver NONE)
install(FILES package.xml DESTINATION share/my_driver)
"""
SOURCE = Path(__file__).resolve().parents[2]
SHEET = load_rubric(default_rubric())
(WORKSPACE,) = (step for step in SHEET.steps if isinstance(step, WorkspaceStep))
TOPIC_DEMO, DRIVER = (step for step in SHEET.steps if isinstance(step, PackageStep))
(PUBLISHES,) = (step for step in SHEET.steps if isinstance(step, PublisherStep))
(LISTENS,) = (step for step in SHEET.steps if isinstance(step, SubscriberStep))


@pytest.fixture(autouse=True, scope='module')
def graph() -> Iterator[None]:
    """Let programs find each other quickly."""
    profiles = SOURCE.parent / 'config' / 'fastdds.xml'
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        patched.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(profiles))
        yield


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    return good_workspace(tmp_path)


def good_workspace(place: Path) -> Path:
    """Return a workspace with our topic_demo and the template that students copy."""
    folder = place / 'CSE461_07_03'
    ignore = shutil.ignore_patterns('test', '__pycache__', '*.egg-info')
    shutil.copytree(SOURCE / 'topic_demo', folder / 'src' / 'topic_demo', ignore=ignore)
    template = SOURCE / 'husky_driver' / 'template' / 'my_driver'
    shutil.copytree(template, folder / 'src' / 'my_driver', ignore=ignore)
    return folder


def open_jail(folder: Path) -> Jail:
    """Return a jail that separates nothing, but ends what was started in it."""
    return Jail(find_sandbox('none'), folder)


def built(folder: Path, package: str, executable: str, program: str) -> Path:
    """Return a workspace with a package of one program, built into a folder beside it."""
    manifest = folder / 'workspace' / 'src' / package / 'package.xml'
    manifest.parent.mkdir(parents=True)
    manifest.write_text(f'<package><name>{package}</name></package>')
    (manifest.parent / f'{executable}.py').touch()
    file = folder / 'built' / 'install' / package / 'lib' / package / executable
    file.parent.mkdir(parents=True)
    file.write_text(program)
    file.chmod(0o755)
    return folder / 'workspace'


def programs_of(workspace: Path) -> Programs:
    return Programs(workspace, workspace.with_name('built'), os.environ, find_sandbox('none'))


def found_of(step: PublisherStep | SubscriberStep, folder: Path, program: str) -> Finding:
    workspace = built(folder, step.package, step.executable, program)
    return live_step(step, programs_of(workspace), folder / 'log')


@pytest.mark.parametrize(('period_sec', 'defects'), [(0.1, set()), (0.2, {'rate'})])
def test_a_pause_of_a_publisher_does_not_change_its_rate(
    tmp_path: Path, period_sec: float, defects: set[str]
) -> None:
    program = PUBLISHER % (sys.executable, 'topic_test', period_sec)
    found = found_of(PUBLISHES, tmp_path, program)
    assert set(found.defects) == defects, found


def test_the_largest_float32_is_heard(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('ROS_PYTHON_CHECK_FIELDS', '1')
    program = PUBLISHER % (sys.executable, 'topic_test', 0.1)
    program = program.replace('String', 'Float32').replace(
        "f'hello world {time.time()}'", '3.4028234e38'
    )
    step = replace(PUBLISHES, type='std_msgs/msg/Float32', content=())
    assert found_of(step, tmp_path, program).score == 100.0


def test_a_rate_in_doubt_is_listened_to_for_longer(tmp_path: Path) -> None:
    program = PUBLISHER % (sys.executable, 'topic_test', 0.1)
    late = program.replace('0.1 if number != 15 else 1.0', '0.125 if number < 24 else 0.1')
    assert late != program
    assert not (found := found_of(PUBLISHES, tmp_path, late)).defects, found


@pytest.mark.parametrize(
    ('rate_hz', 'within_sec', 'period_sec', 'told'),
    [(0.5, 1.0, 2.0, ''), (4.0, 15.0, 1.0, 'about 1 messages a second; the lab asks for 4')],
)
def test_a_slow_publisher_is_heard_until_its_rate_is_known(
    tmp_path: Path, rate_hz: float, within_sec: float, period_sec: float, told: str
) -> None:
    step = replace(PUBLISHES, rate_hz=rate_hz, within_sec=within_sec, listen_sec=0.5)
    found = found_of(step, tmp_path, PUBLISHER % (sys.executable, 'topic_test', period_sec))
    assert (found.score, found.defects.get('rate', '')) == (100.0, told), found


@pytest.mark.parametrize(
    ('shown', 'defects'), [('"heard " + m.data', set()), ('m.data', {'printed'})]
)
def test_a_subscriber_that_prints_another_form_is_told(
    tmp_path: Path, shown: str, defects: set[str]
) -> None:
    found = found_of(LISTENS, tmp_path, SUBSCRIBER % (sys.executable, shown))
    assert set(found.defects) == defects, found


@pytest.fixture(scope='module')
def graded_class(graph: None, module_path: Path) -> tuple[Path, list[str]]:
    """Grade a good workspace and a hostile archive; return the report, and what is printed."""
    handed_in, report = module_path / 'handed_in', module_path / 'report'
    handed_in.mkdir()
    workspace = good_workspace(module_path)
    shutil.make_archive(str(handed_in / 'good'), 'gztar', module_path, workspace.name)
    (handed_in / 'hostile.zip').write_bytes(b'PK\x03\x04 and nothing else')
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        words = ['--lab', str(handed_in), '--report', str(report), '--real-time-factor', '4']
        assert grade(words) == 1
    return report, printed.getvalue().splitlines()


@pytest.mark.timeout(180)
def test_a_good_workspace_loses_points_only_for_its_drive(
    graded_class: tuple[Path, list[str]],
) -> None:
    report = graded_class[0] / 'good'
    steps = {step['name']: step for step in json.loads((report / 'lab.json').read_text())['steps']}
    drive = steps.pop('drive')
    short = {name: step for name, step in steps.items() if step['points'] < step['most']}
    assert short == {}
    assert set(steps) == {
        *('workspace', 'package topic_demo', 'driver package'),
        *('build', 'publisher', 'subscriber'),
    }
    assert 0.0 < drive['points'] < drive['most']
    assert 'missed waypoint 3 at (2.7, -2.6)' in drive['why']
    assert (report / 'drive' / 'report.html').is_file()


@pytest.mark.timeout(180)
def test_a_hostile_archive_costs_only_itself(graded_class: tuple[Path, list[str]]) -> None:
    report, (good, hostile, written) = graded_class
    assert written.startswith(f'written: {report}/class.html')
    steps = json.loads((report / 'good' / 'lab.json').read_text())
    assert good.startswith('good     ')
    points = sum(step['points'] for step in steps['steps'])
    assert steps['score'] == pytest.approx(points)
    assert f' {steps["score"]:.1f} of 100  drive: ' in good
    assert hostile.startswith('hostile  refused  ')
    assert steps['sandbox'] in ('bwrap', 'podman', 'docker', 'kernel')


@pytest.mark.timeout(120)
def test_a_broken_workspace_is_told_what_to_do_at_every_step(
    workspace: Path, tmp_path: Path
) -> None:
    setup = workspace / 'src' / 'topic_demo' / 'setup.py'
    setup.write_text(setup.read_text().replace("'subscriber = ", "'listener = "))
    publisher = workspace / 'src' / 'topic_demo' / 'topic_demo' / 'publisher.py'
    publisher.write_text(publisher.read_text().replace('        super()', '        super(1)'))
    shutil.rmtree(workspace / 'src' / 'my_driver')
    report = tmp_path / 'report'
    assert grade(['--lab', str(workspace), '--report', str(report)]) == 1
    steps = {step['name']: step for step in json.loads((report / 'lab.json').read_text())['steps']}
    why = {name: step['why'] for name, step in steps.items() if step['points'] < step['most']}
    lacking = 'a package with follow_path.py is not in src; packages there: topic_demo'
    assert why['driver package'] == why['drive'] == lacking
    counts = 'counts only with points for publisher or subscriber or drive; colcon build succeeded'
    assert why['build'] == counts
    assert why['publisher'].startswith('publisher.py line ')
    assert ': TypeError: ' in why['publisher']
    assert 'Traceback (most recent call last)' in steps['publisher']['printed']
    missing = 'ros2 run topic_demo subscriber finds nothing; topic_demo has: listener'
    assert missing in why['subscriber']
    assert not (workspace / 'install').exists()


@pytest.mark.timeout(60)
def test_a_report_in_the_workspace_is_no_part_of_it(tmp_path: Path) -> None:
    workspace, rubric = tmp_path / 'CSE461_07_03', tmp_path / 'rubric.yaml'
    (package := workspace / 'src' / 'my_driver').mkdir(parents=True)
    (package / 'package.xml').write_text(PLAIN)
    (package / 'CMakeLists.txt').write_text(CMAKE)
    rubric.write_text('title: T\nsteps:\n  - {kind: build, points: 1}\n')
    command = ['--lab', str(workspace), '--rubric', str(rubric), '--sandbox', 'none']
    for _ in range(2):
        assert grade([*command, '--report', str(workspace / 'report')]) == 0
    # Nor is what was graded for who builds the workspace himself.
    listed = subprocess.run(['colcon', 'list', '--names-only'], cwd=workspace, capture_output=True)
    assert listed.stdout.split() == [b'my_driver']


def test_an_empty_workspace_scores_nothing(tmp_path: Path) -> None:
    workspace = tmp_path / 'CSE461_07_03'
    (workspace / 'src').mkdir(parents=True)
    grades = grade_lab(workspace, SHEET, tmp_path / 'report', sandbox=find_sandbox('none'))
    assert {grade.name: grade.points for grade in grades if grade.points} == {}


@pytest.mark.timeout(60)
def test_a_package_as_it_was_created_gets_no_more_than_that(tmp_path: Path) -> None:
    workspace = tmp_path / 'CSE461_07_03'
    (workspace / 'src').mkdir(parents=True)
    create = ['ros2', 'pkg', 'create', 'topic_demo', '--build-type', 'ament_python']
    create += ['--dependencies', 'rclpy', 'std_msgs', '--node-name', 'publisher']
    subprocess.run(create, cwd=workspace / 'src', check=True, stdout=subprocess.DEVNULL)
    steps = grade_lab(workspace, SHEET, tmp_path / 'report', sandbox=find_sandbox('none'))
    grades = {grade.name: grade for grade in steps}
    points = {name: grade.points for name, grade in grades.items() if grade.points}
    assert points == {'workspace': 5.0, 'package topic_demo': 8.0}
    why = grades['package topic_demo'].why
    assert why == 'package.xml still says TODO: fill in its description and license'


@pytest.mark.timeout(60)
def test_a_hidden_course_is_known_by_its_title_only(tmp_path: Path) -> None:
    course = tmp_path / 'course.yaml'
    course.write_text('speed: 1.0\nwaypoints: [[0, 0], [-1.375, 0.125]]\n')
    step = DriveStep(
        points=10,
        name='drive',
        package_with='follow_path.py',
        executable='follow_path',
        arguments=('--waypoints', '{course}'),
        courses=(CourseToDrive(file=course, title='course A', hidden=True),),
        limits=DriveLimits(time_sec=1.0),
    )
    workspace = built(tmp_path, 'my_driver', 'follow_path', FOLLOW_PATH % sys.executable)
    drives = DriveRunner(programs_of(workspace), real_time_factor=4.0)
    found = drive_step(step, drives, tmp_path / 'report')
    report = json.loads((tmp_path / 'report' / 'staff' / 'drive' / 'report.json').read_text())
    assert found.score == max(report['score'] - 50.0, 0.0)
    assert found.why.startswith('course A: ')
    assert f' s, 1 s are allowed; score {report["score"]:.1f} of 100, ' in found.why
    assert [path.name for path in (tmp_path / 'report').iterdir()] == ['staff']
    assert [report['printed'].count(each) for each in (str(tmp_path), '1.375')] == [0, 1]
    assert '1.375' not in found.why


def test_a_workspace_of_another_name_is_told_the_right_one(tmp_path: Path) -> None:
    (tmp_path / 'ws' / 'src').mkdir(parents=True)
    found = workspace_step(WORKSPACE, tmp_path / 'ws')
    assert found.defects == {'name': 'named ws; the lab asks for CSE461_<digits>_<digits>'}
    assert WORKSPACE.cost_percent('name') == 50.0
    assert workspace_step(WORKSPACE, tmp_path).score == 0.0
    added = ('', '-1', ' (2)', '(2)', '-main', '-master (1)')
    for name in (f'{name}{each}' for name in ('CSE461-7-3', 'CSE461_07_03') for each in added):
        found = workspace_step(WORKSPACE, (tmp_path / 'ws').rename(tmp_path / name))
        assert found.defects == {}, name
        (tmp_path / name).rename(tmp_path / 'ws')


def test_a_manifest_that_lacks_a_dependency_is_told_the_line(workspace: Path) -> None:
    manifest = workspace / 'src' / 'topic_demo' / 'package.xml'
    manifest.write_text(manifest.read_text().replace('<exec_depend>std_msgs</exec_depend>', ''))
    found = package_step(TOPIC_DEMO, workspace)
    lacks = 'package.xml lacks: <exec_depend>std_msgs</exec_depend>'
    assert found.defects == {'dependencies': lacks}
    assert package_step(DRIVER, workspace).why == 'package.xml of my_driver is complete'


def test_a_pipe_in_the_place_of_a_manifest_is_not_read(workspace: Path) -> None:
    manifest = workspace / 'src' / 'topic_demo' / 'package.xml'
    manifest.unlink()
    os.mkfifo(manifest)
    found = package_step(TOPIC_DEMO, workspace)
    assert found.why == 'topic_demo is not in src; packages there: my_driver'


def test_a_workspace_that_is_not_there_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert grade(['--lab', str(tmp_path / 'nothing')]) == 2
    assert 'nothing: no such file or folder' in capsys.readouterr().err


def test_a_rubric_with_a_mistake_is_refused_before_anything(
    workspace: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rubric, report = tmp_path / 'rubric.yaml', tmp_path / 'report'
    rubric.write_text('title: T\nstep: []\n')
    arguments = ['--lab', str(workspace), '--rubric', str(rubric), '--report', str(report)]
    assert grade(arguments) == 2
    refused = f'{rubric}: line 2, column 1: step is no field; did you mean steps? allowed: title, '
    assert refused in capsys.readouterr().err
    assert not report.exists()


def running(pids: list[int]) -> list[int]:
    alive = []
    for pid in pids:
        with contextlib.suppress(psutil.NoSuchProcess):
            if psutil.Process(pid).status() != psutil.STATUS_ZOMBIE:
                alive.append(pid)
    return alive


def daemon(pids: Path) -> str:
    """Return a program that starts a daemon and waits until it has told its number."""
    ready = f'import os, time\nwhile not os.path.exists({str(pids)!r}): time.sleep(0.01)\n'
    return DAEMON.format(python=sys.executable, pids=str(pids)) + ready


def test_a_daemon_of_a_build_ends_with_the_build(workspace: Path, tmp_path: Path) -> None:
    shutil.rmtree(workspace / 'src' / 'my_driver')
    pids, report = tmp_path / 'pids', tmp_path / 'report'
    setup = workspace / 'src' / 'topic_demo' / 'setup.py'
    setup.write_text(setup.read_text() + daemon(pids))
    log = tmp_path / 'build.log'
    report.mkdir()
    with open_jail(report) as jail:
        found = build_step(workspace, jail, log)
    assert found.score == 100.0, found
    assert 'Finished <<< topic_demo' in log.read_text()
    assert running([int(pid) for pid in pids.read_text().split()]) == []


def test_a_daemon_of_a_publisher_ends_with_its_step(tmp_path: Path) -> None:
    pids = tmp_path / 'pids'
    found = found_of(PUBLISHES, tmp_path, f'#!{sys.executable}\n{daemon(pids)}')
    assert found.why == 'it ended by itself (exit code 0)'
    assert running([int(pid) for pid in pids.read_text().split()]) == []


def test_a_build_ends_with_the_killed_grader(workspace: Path, tmp_path: Path) -> None:
    colcon, log = tmp_path / 'colcon', tmp_path / 'build.log'
    colcon.write_text(DEAF_COLCON % sys.executable)
    colcon.chmod(0o755)
    environment = {**os.environ, 'PATH': f'{tmp_path}{os.pathsep}{os.environ["PATH"]}'}
    command = [sys.executable, '-c', BUILD, str(workspace), str(tmp_path)]
    grader = subprocess.Popen(command, env=environment)
    wait_until(
        lambda: log.is_file() and log.read_text().endswith('\n'), what='the start of the build'
    )
    pid = int(log.read_text().split()[1])
    assert running([pid])
    grader.kill()
    grader.wait()
    wait_until(lambda: not running([pid]), what='the end of the build')


@pytest.mark.parametrize(
    ('hook', 'why'), [('exit 3', 'exit code 3'), ('sleep 600', 'took longer than 1 s')]
)
def test_a_hook_that_breaks_the_shell_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, hook: str, why: str
) -> None:
    if 'sleep' in hook:
        monkeypatch.setattr('husky_grader.lab.build_step.SOURCE_WITHIN_SEC', 1.0)
    (place := tmp_path / 'install').mkdir()
    (place / 'local_setup.bash').write_text(f'export KNOWN=1\n{hook}\n')
    with open_jail(tmp_path) as jail, pytest.raises(ValueError, match=why):
        sourced(jail)
    monkeypatch.undo()
    (place / 'local_setup.bash').write_text('export KNOWN="a\nb" PATH=/\nprintf "=x\\0" >&10\n')
    with open_jail(tmp_path) as jail:
        assert [sourced(jail).get(name) for name in ('KNOWN', '')] == ['a\nb', None]


@pytest.mark.timeout(60)
def test_a_daemon_of_a_controller_ends_with_the_run(tmp_path: Path) -> None:
    pids, program = tmp_path / 'pids', tmp_path / 'controller.py'
    program.write_text(daemon(pids))
    course = tmp_path / 'course.yaml'
    course.write_text('waypoints: [[0, 0], [-2, 0]]')
    with open_jail(tmp_path) as jail:
        drive_live(f'{sys.executable} {program}', str(course), tmp_path / 'run', jail)
    assert running([int(pid) for pid in pids.read_text().split()]) == []


def test_without_a_sandbox_nothing_that_was_handed_in_runs(
    workspace: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv('PATH', '')
    assert grade(['--lab', str(workspace), '--report', str(tmp_path / 'report')]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('no sandbox works here (bwrap: ')
    assert line.endswith('--sandbox none runs what was handed in with all your rights')
    assert not (tmp_path / 'report').exists()
