# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator as a process: its exit status and its output."""

from collections.abc import Iterator
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import time

from husky_course.record import read_record
from husky_runtime.domains import OwnDomain
from husky_runtime.settings import NODE_PARAMETERS
from playpen_testing.forks import Ended, run_forked
from playpen_testing.processes import Child, find_line
from playpen_testing.services import ask
from playpen_testing.spinning import SpunNodes
import pytest
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import ListParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter


def run_process(
    *arguments: str,
    module: str = 'husky_sim.ros.node',
    cwd: Path | None = None,
    env: dict[str, str] | None = None,
) -> 'subprocess.Popen[str]':
    return Child(
        [sys.executable, '-m', module, '--ros-args', *arguments],
        stderr=subprocess.PIPE,
        cwd=cwd,
        env=env,
    )


def test_a_bad_world_gives_one_line_and_exit_status_2(domain_id: int) -> None:
    del domain_id
    process = run_process('-p', 'world:=nowhere.xml')
    _, said = process.communicate(timeout=20.0)
    assert process.returncode == 2
    assert said.count('\n') == 1
    assert said.startswith(f"husky_sim: world='{Path.cwd()}/nowhere.xml': no such file")


@pytest.fixture
def operator(domain_id: int) -> Iterator[Node]:
    """Spin a node that asks the simulator."""
    with SpunNodes(domain_id) as nodes:
        yield nodes.start(Node, 'operator')


def test_help_tells_of_every_parameter_that_a_simulator_has(operator: Node) -> None:
    command = [sys.executable, '-m', 'husky_sim.ros.node', '--help']
    helped = subprocess.run(command, capture_output=True, text=True, timeout=20.0)
    assert (helped.returncode, helped.stderr) == (0, '')
    told = set(re.findall(r'^  (\w+)', helped.stdout.partition('parameters')[2], re.MULTILINE))
    process = run_process()
    try:
        names = ask(operator, ListParameters, '/husky_sim/list_parameters').result.names
        assert told == {name for name in names if '.' not in name} - set(NODE_PARAMETERS)
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20.0)


def test_physics_that_breaks_down_are_told_of_once(domain_id: int, tmp_path: Path) -> None:
    del domain_id
    world = tmp_path / 'world.xml'
    world.write_text(
        '<mujoco><worldbody><geom name="floor" type="plane" size="9 9 1"/><body name="gate">'
        '<joint type="slide" stiffness="1e12"/><geom size="0.1" mass="1" pos="3 0 1"/></body>'
        '</worldbody></mujoco>',
        encoding='utf-8',
    )
    process = run_process('-p', f'world:={world}', '-p', 'limit_sec:=3.0')
    _, said = process.communicate(timeout=30.0)
    (line,) = [line for line in said.splitlines() if 'broke down' in line]
    assert 'the physics broke down at gate, and everything is back at its start: this run' in line
    assert f'more mass in {world}, or' in line


@pytest.mark.parametrize('file', ['husky_playpen.launch.py', 'multi_husky_playpen.launch.py'])
def test_arguments_of_launch_files_are_shown_in_words(file: str) -> None:
    process = Child(['ros2', 'launch', 'husky_sim', file, '--show-args'], stdout=subprocess.PIPE)
    shown, _ = process.communicate(timeout=20.0)
    assert '(default: not headless)' in shown
    assert ' object at 0x' not in shown


TOO_SLOW = ('1.0e-12', '1.0e-300', '0.0009')
OF_ANOTHER_TYPE = ('robots:=alpha 0 0 0', 'robots:=5', 'robots:=[1, 2]', 'x:=[]')


@pytest.fixture(scope='module')
def refused() -> dict[str, Ended]:
    given = (*(f'real_time_factor:={factor}' for factor in TOO_SLOW), *OF_ANOTHER_TYPE)
    with OwnDomain() as domain, pytest.MonkeyPatch.context() as changed:
        changed.setenv('ROS_DOMAIN_ID', str(domain.number))
        ended = run_forked(*(('husky_sim.ros.node', '--ros-args', '-p', each) for each in given))
    return dict(zip(given, ended, strict=True))


@pytest.mark.parametrize('factor', TOO_SLOW)
def test_a_pace_too_slow_for_a_timer_gives_one_line(
    refused: dict[str, Ended], factor: str
) -> None:
    ended = refused[f'real_time_factor:={factor}']
    assert ended.status == 2
    allowed = '0 or a number from 0.001 to 1000 is allowed'
    assert ended.err == f'husky_sim: real_time_factor={float(factor)}: {allowed}\n'


def test_a_refused_pace_is_answered_and_the_run_goes_on(operator: Node) -> None:
    def answer(factor: float) -> SetParametersResult:
        asked = [Parameter('real_time_factor', value=factor).to_parameter_msg()]
        answered = ask(operator, SetParameters, '/husky_sim/set_parameters', parameters=asked)
        (result,) = answered.results
        return result

    process = run_process()
    try:
        for factor in (1e-12, 5e-324, 0.0009):
            refused = answer(factor)
            assert not refused.successful
            assert refused.reason.endswith(
                f'{factor}: 0 or a number from 0.001 to 1000 is allowed'
            )
        for factor in (0.001, 0.0, 2.0):
            assert answer(factor).successful
    finally:
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=20.0)
    assert 'Traceback' not in said
    assert process.returncode == 0


@pytest.mark.parametrize('given', OF_ANOTHER_TYPE)
def test_a_parameter_of_another_type_gives_one_line(refused: dict[str, Ended], given: str) -> None:
    ended = refused[given]
    assert ended.status == 2
    assert ended.err.count('\n') == 1
    assert ended.err.startswith(f'husky_sim: {given.partition(":")[0]}=')


def test_a_world_and_a_record_are_named_by_absolute_paths(
    domain_id: int, tmp_path: Path, worlds: Path
) -> None:
    del domain_id
    home, here = tmp_path / 'home', tmp_path / 'here'
    for folder in (home, here):
        folder.mkdir()
    world = here / 'my_world.xml'
    crate = '<body name="crate" pos="3 0 1"><geom size=".1"/></body></worldbody>'
    world.write_text((worlds / 'empty.xml').read_text().replace('</worldbody>', crate))
    process = run_process(
        *('-p', 'world:=my_world.xml', '-p', 'record:=~/run.record'),
        cwd=here,
        env={**os.environ, 'HOME': str(home), 'ROS_LOG_DIR': str(tmp_path / 'log')},
    )
    assert process.stderr is not None
    try:
        find_line(process.stderr, f'{world}: 1 obstacle, husky;')
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20.0)
    assert read_record(home / 'run.record').world == str(world)
    assert list(here.iterdir()) == [world], 'no folder is called ~'


def test_no_robots_are_one_and_what_counts_for_nothing_is_told(domain_id: int) -> None:
    del domain_id
    process = run_process(
        *('-p', 'robots:=[]', '-p', 'yaw:=90.0', '-p', 'seed:=2', '-p', 'battery_charge:=0.5')
    )
    assert process.stderr is not None
    try:
        for said in (
            'battery_charge=0.5 changes nothing without battery:=true',
            'seed=2 changes nothing without noise:=true or realistic:=true',
            r'yaw=90\.0 is taken for radians, more than a turn; 90 degrees are 1\.5708',
            '34 obstacles, husky; 1 x real time',
        ):
            find_line(process.stderr, said)
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20.0)


def test_without_mujoco_it_says_how_to_install_it() -> None:
    program = "import sys; sys.modules['mujoco'] = None; sys.argv = ['/a/husky_sim']\n"
    program += 'from husky_sim.programs import main; sys.exit(main())'
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.startswith(f"husky_sim: {sys.executable} has no module 'mujoco'; ")
    assert done.stderr.count('\n') == 1
    listed = Path(done.stderr.split(' -r ')[1].split('`')[0])
    assert 'mujoco' in (Path(__file__).parents[3] / listed).read_text()


def test_a_signal_while_it_still_loads_ends_it_without_a_word(domain_id: int) -> None:
    del domain_id
    process = run_process(module='husky_sim.programs')
    maps = Path(f'/proc/{process.pid}/maps')
    deadline = time.monotonic() + 20.0
    while 'numpy' not in maps.read_text():
        assert time.monotonic() < deadline, 'it never began to load'
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=20.0)
    assert (process.returncode, said) == (0, '')


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_it_soon_and_the_record_is_whole(
    domain_id: int, tmp_path: Path, number: signal.Signals
) -> None:
    del domain_id
    path = tmp_path / 'deep' / 'run.record'
    process = run_process(
        '-p', f'record:={path}', '-p', 'real_time_factor:=0.0', module='husky_sim.programs'
    )
    assert process.stderr is not None
    assert 'obstacles' in process.stderr.readline()
    process.send_signal(number)
    begin = time.monotonic()
    _, said = process.communicate(timeout=20.0)
    assert time.monotonic() - begin < 2.0
    assert process.returncode == 0
    assert 'Traceback' not in said
    record = read_record(path)
    assert record.complete
    assert len(record.obstacles) == 34
    assert record.min_clearance_m(0) == pytest.approx(0.73, abs=0.02)


def test_a_second_simulator_is_refused_by_name(domain_id: int) -> None:
    command = [sys.executable, '-m', 'husky_sim.ros.node']
    first = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert first.stdout is not None
    try:
        find_line(first.stdout, 'real time')
        second = subprocess.run(command, capture_output=True, text=True, timeout=20.0)
        first.send_signal(signal.SIGSTOP)
        third = subprocess.run(command, capture_output=True, text=True, timeout=20.0)
    finally:
        first.send_signal(signal.SIGCONT)
        first.send_signal(signal.SIGINT)
        first.communicate(timeout=10.0)
    assert second.returncode == 2
    (line,) = second.stderr.splitlines()
    assert f'another simulator runs in ROS domain {domain_id}: process {first.pid} ' in line
    assert 'export ROS_DOMAIN_ID=' in line
    assert 'Ctrl-Z' not in line
    assert 'stopped as by Ctrl-Z (`fg` continues it)' in third.stderr
