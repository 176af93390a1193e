# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The view as a process: its address, its end, and that it cannot hold up the physics."""

from collections.abc import Iterator
from contextlib import ExitStack
from http import HTTPStatus
from pathlib import Path
import resource
from shutil import copy
import signal
import socket
import time
from urllib.parse import urlsplit
import urllib.request

from ament_index_python.packages import get_package_prefix
from husky_runtime.domains import OwnDomain
from husky_runtime.supervise import END_WITHIN_SEC
from husky_sim.world import default_worlds
from nav_msgs.msg import Odometry
from playpen_testing.forks import Ended, run_forked
from playpen_testing.listener import Listener
from playpen_testing.page_client import PageClient, stalled_tab
from playpen_testing.processes import Process, Processes
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rosgraph_msgs.msg import Clock

WORLDS = Path(__file__).resolve().parent.parent / 'worlds'
CRATE = """\
  <body name="crate" pos="0.4 4 0.3"><geom type="box" size="0.2 0.2 0.3"/></body>
</worldbody>"""
"""0.6 m to the left of a robot that has driven 1 m from (1, 3), to the north."""

VIEW = ('ros2', 'run', 'husky_view', 'view', '--ros-args', '-p')
PORT = 18480


class Shown:
    """
    A view that shows one simulator after the other, in a domain of its own.

    Its waypoint files are in the folder `home`; it runs in another one.
    """

    def __init__(self, processes: Processes, nodes: SpunNodes, number: int, home: Path) -> None:
        self.nodes = nodes
        self.home = home
        self._processes = processes
        self._environment = {
            'ROS_DOMAIN_ID': str(number),
            'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
            'ROS_LOG_DIR': str(home / 'ros_log'),
            'PYTHONUNBUFFERED': '1',
            'HOME': str(home),
        }
        program = Path(get_package_prefix('husky_view')) / 'lib' / 'husky_view' / 'view'
        settings = (f'viewer_port:={PORT}', '-p', 'waypoints_folder:=~')
        self.view = self.start(str(program), '--ros-args', '-p', *settings)
        self.simulator: Process | None = None

    def start(self, *command: str, cwd: Path | None = None) -> Process:
        """Start a process in the domain of the view."""
        return self._processes.start(*command, cwd=cwd, environment=self._environment)

    def simulate(self, *settings: str, cwd: Path | None = None) -> Process:
        """Start a simulator in the place of the one before."""
        if self.simulator is not None:
            self.simulator.close()
        given = [word for setting in settings for word in ('-p', setting)]
        command = ('ros2', 'run', 'husky_sim', 'husky_sim', '--ros-args', *given)
        self.simulator = self.start(*command, cwd=cwd)
        return self.simulator

    def show_any(self) -> None:
        """Wait until a simulator is shown, whichever it is; start one if there is none."""
        if self.simulator is None:
            self.simulate()
        self.view.wait_for_text('look at http://localhost:')

    @property
    def address(self) -> str:
        return self.view.output.split('look at ')[1].split()[0]


@pytest.fixture(scope='module')
def shown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Shown]:
    home = tmp_path_factory.mktemp('home')
    with OwnDomain() as domain, Processes() as processes, SpunNodes(domain.number) as nodes:
        yield Shown(processes, nodes, domain.number, home)


def stamp_sec(clock: Clock) -> float:
    return float(clock.clock.sec + clock.clock.nanosec * 1e-9)


def wall_sec_of(listener: Listener, simulated_sec: float) -> float:
    """Return how long a simulated time takes by the clock on the wall."""
    begun_sec, wall_sec = stamp_sec(listener.latest('/clock')), time.monotonic()
    wait_until(
        lambda: stamp_sec(listener.latest('/clock')) > begun_sec + simulated_sec,
        timeout_sec=10.0,
        what=f'{simulated_sec} simulated seconds',
    )
    return time.monotonic() - wall_sec


def wait_for_real_time(listener: Listener) -> None:
    """Wait for three simulated seconds that pass in three of the clock on the wall."""
    # Once more where it had no processor for a moment: it leaves out what it cannot catch up.
    wait_until(
        lambda: wall_sec_of(listener, 3.0) == pytest.approx(3.0, abs=0.5),
        timeout_sec=30.0,
        what='three simulated seconds in three of the clock on the wall',
    )


@pytest.mark.timeout(60)
def test_a_launch_serves_the_page_on_the_loopback_alone(processes: Processes) -> None:
    launch = processes.start(
        *('ros2', 'launch', 'husky_sim', 'husky_playpen.launch.py'),
        *('viewer:=true', 'viewer_port:=18380'),
    )
    launch.wait_for_text('look at http://localhost:')
    address = launch.output.split('look at ')[1].split()[0]
    port = urlsplit(address).port or 0
    with urllib.request.urlopen(address, timeout=10.0) as page:
        assert '<html' in page.read().decode()
    others = [str(row[4][0]) for row in socket.getaddrinfo(socket.gethostname(), port)]
    for host in (address for address in others if not address.startswith(('127.', '::1'))):
        with pytest.raises(OSError, match='refused'):
            socket.create_connection((host, port), timeout=2.0)
    begun = time.monotonic()
    launch.signal(signal.SIGINT)
    assert launch.wait(timeout_sec=10.0) == 0
    assert time.monotonic() - begun < 4.0
    assert 'Traceback' not in launch.output


@pytest.mark.timeout(60)
def test_a_view_without_a_simulator_says_what_it_waits_for(shown: Shown) -> None:
    view = shown.view
    view.wait_for_text('husky_sim does not answer yet: is the simulator running, with ROS_DOMAIN_')
    view.wait_for_text(' and RMW_IMPLEMENTATION=')
    assert 'look at http://localhost:' not in view.output
    shown.simulate()
    view.wait_for_text('look at http://localhost:')


@pytest.mark.timeout(60)
def test_a_taken_port_gives_the_next_and_ctrl_c_ends_in_2_s(shown: Shown) -> None:
    shown.show_any()
    with socket.socket() as taken:
        taken.bind(('127.0.0.1', 0))
        taken.listen()
        port = taken.getsockname()[1]
        view = shown.start(*VIEW, f'viewer_port:={port}')
        view.wait_for_text('look at http://localhost:')
        assert f'localhost:{port}/' not in view.output
        assert 'viser' not in view.output, 'one line tells the address, and no other'
        begun = time.monotonic()
        view.signal(signal.SIGINT)
        assert view.wait(timeout_sec=10.0) == 0
        assert time.monotonic() - begun < 2.0
        assert 'Traceback' not in view.output


@pytest.mark.timeout(60)
def test_connections_that_take_every_file_of_the_view_do_not_end_it(shown: Shown) -> None:
    shown.show_any()
    view = shown.view
    port = urlsplit(shown.address).port or 0
    before = resource.prlimit(view.pid, resource.RLIMIT_NOFILE)
    resource.prlimit(view.pid, resource.RLIMIT_NOFILE, (48, before[1]))
    try:
        with ExitStack() as stack:
            for _ in range(60):
                stack.enter_context(socket.create_connection(('127.0.0.1', port), timeout=10.0))
            view.wait_for_text('Too many open files')
            begun = time.monotonic()  # it looks for waypoint files every two
            wait_until(
                lambda: time.monotonic() > begun + 3.0 or view.returncode is not None,
                timeout_sec=5.0,
                what='three seconds',
            )
        wait_until(
            lambda: answers(shown.address), timeout_sec=20.0, what=lambda: view.output[-2000:]
        )
    finally:
        resource.prlimit(view.pid, resource.RLIMIT_NOFILE, before)


def answers(address: str) -> bool:
    try:
        with urllib.request.urlopen(address, timeout=2.0) as page:
            return bool(page.status == HTTPStatus.OK)
    except OSError:
        return False


@pytest.mark.timeout(60)
@pytest.mark.parametrize(
    ('program', 'library', 'number'),
    [
        ('husky_sim', '_rclpy_pybind11', signal.SIGINT),
        ('husky_sim', 'libmujoco', signal.SIGTERM),
        ('view', 'libmujoco', signal.SIGINT),
        ('replay', 'libmujoco', signal.SIGINT),
    ],
)
def test_an_interrupt_while_a_program_loads_ends_it_silently(
    processes: Processes, program: str, library: str, number: signal.Signals
) -> None:
    package = 'husky_sim' if program == 'husky_sim' else 'husky_view'
    installed = Path(get_package_prefix(package)) / 'lib' / package / program
    process = processes.start(str(installed), 'nothing')
    maps = Path(f'/proc/{process.pid}/maps')
    wait_until(lambda: library in maps.read_text(), timeout_sec=20.0, what=f'{library} in it')
    begun = time.monotonic()
    process.signal(number)
    assert process.wait(timeout_sec=10.0) == 0, process.output
    assert time.monotonic() - begun < 2.0
    assert process.output == ''


BUSY = (
    'from husky_view.live.node import _exit_soon; print(1, flush=True); _exit_soon()\nwhile 1: 1'
)


def test_a_view_that_builds_its_page_ends_within_the_time_of_a_drive(
    processes: Processes,
) -> None:
    view = processes.start('python3', '-c', BUSY)
    view.wait_for_text('1')
    assert view.wait(timeout_sec=END_WITHIN_SEC) == 0


REFUSED = {
    'viewer_host:=192.0.2.1': "host '192.0.2.1'",
    'viewer_host:=5': 'viewer_host=5: a text is allowed',
    'viewerport:=3': 'parameter viewerport does not exist; did you mean viewer_port? ',
    'simulator:=a b': 'Invalid service name',
}


@pytest.fixture(scope='module')
def refused() -> dict[str, Ended]:
    module, *words = 'husky_view.live.node', '--ros-args', '-p'
    ended = run_forked(*((module, *words, given) for given in REFUSED))
    return dict(zip(REFUSED, ended, strict=True))


@pytest.mark.timeout(60)
@pytest.mark.parametrize('given', REFUSED)
def test_a_parameter_that_cannot_be_is_refused_in_one_line(
    refused: dict[str, Ended], given: str
) -> None:
    ended = refused[given]
    assert ended.status == 2
    said = [line for line in ended.err.splitlines() if line.startswith('view: ')]
    assert len(said) == 1
    assert REFUSED[given] in said[0]
    assert 'Traceback' not in ended.out + ended.err


def test_the_record_behind_the_names_of_a_replay_is_no_name(tmp_path: Path) -> None:
    run = str(tmp_path / 'run')
    (ended,) = run_forked(('husky_view.replay.replay', '--names', 'lab.example.edu', run))
    assert ended.status == 2
    assert ended.err.startswith(f'replay: {run}: ')


@pytest.mark.timeout(60)
def test_a_node_that_is_no_simulator_is_refused_in_one_line(processes: Processes) -> None:
    processes.start('ros2', 'run', 'demo_nodes_py', 'talker')
    view = processes.start(*VIEW, 'simulator:=talker')
    assert view.wait() == 2
    (said,) = [line for line in view.lines if line.startswith('view: ')]
    assert "simulator='talker': this node is no simulator" in said
    assert 'Traceback' not in view.output


@pytest.mark.timeout(60)
def test_a_view_that_hangs_does_not_hold_up_the_physics(shown: Shown) -> None:
    shown.show_any()
    listener = shown.nodes.start(Listener, {'/clock': Clock})
    shown.view.signal(signal.SIGSTOP)
    try:
        wait_for_real_time(listener)
    finally:
        shown.view.signal(signal.SIGCONT)
        shown.nodes.close(listener)


@pytest.mark.timeout(60)
def test_ten_stalled_tabs_do_not_hold_up_the_physics(shown: Shown) -> None:
    shown.show_any()
    tabs = [stalled_tab(shown.address) for _ in range(10)]
    listener = shown.nodes.start(Listener, {'/clock': Clock})
    try:
        wait_for_real_time(listener)
    finally:
        for tab in tabs:
            tab.close()
        shown.nodes.close(listener)


@pytest.mark.timeout(60)
def test_a_next_world_that_cannot_be_loaded_is_told_of_once(shown: Shown, tmp_path: Path) -> None:
    shown.show_any()
    view = shown.view
    assert shown.simulator is not None
    shown.simulator.close()
    world, moved = tmp_path / 'my_world.xml', tmp_path / 'moved.xml'
    copy(default_worlds() / 'empty.xml', world)
    view.signal(signal.SIGSTOP)
    try:
        shown.simulate(f'world:={world}').wait_for_text('0 obstacles')
        world.rename(moved)
    finally:
        view.signal(signal.SIGCONT)
    view.wait_for_text(f"Not shown: world='{world}': no such file")
    listener = shown.nodes.start(Listener, {'/clock': Clock})
    wall_sec_of(listener, 3.0)
    shown.nodes.close(listener)
    assert view.output.count('Not shown') == 1
    moved.rename(world)
    view.wait_for_text(f'another simulation runs now: {world}')


@pytest.mark.timeout(60)
def test_a_world_that_was_named_in_another_folder_is_shown(
    processes: Processes, tmp_path: Path
) -> None:
    copy(default_worlds() / 'empty.xml', tmp_path / 'my_world.xml')
    world = ('--ros-args', '-p', 'world:=my_world.xml')
    processes.start('ros2', 'run', 'husky_sim', 'husky_sim', *world, cwd=tmp_path)
    view = processes.start(*VIEW, 'viewer_port:=18780')
    view.wait_for_text('look at http://localhost:')


@pytest.mark.timeout(90)
def test_a_course_is_checked_in_the_world_and_from_the_start_shown(shown: Shown) -> None:
    view, folder = shown.view, shown.home / 'worlds'
    folder.mkdir()
    world = (WORLDS / 'empty.xml').read_text().replace('</worldbody>', CRATE)
    (folder / 'my world.xml').write_text(world)
    (shown.home / 'ahead.yaml').write_text('waypoints: [[0, 0], [1.5, 0]]\n')
    robots = "robots:=['alpha 0 0 0', 'beta 1 3 1.5708']"
    shown.show_any()
    # Named in a folder that is not the view's.
    shown.simulate('world:=my world.xml', robots, cwd=folder)
    view.wait_for_text(f'another simulation runs now: {folder}/my world.xml')
    with PageClient(shown.address) as tab:
        tab.set('Robot', 'beta')
        tab.set('Open', 'ahead')
        tab.set('Save and drive it', True)
        view.wait_for_text('done: 2 of 2 waypoints', timeout_sec=60.0)
    (warning,) = [line for line in view.lines if ' m from ' in line]
    assert 'the robot passes 0.06 m from crate near (' in warning


@pytest.mark.timeout(60)
def test_a_robot_that_may_be_fast_is_drawn(shown: Shown) -> None:
    shown.show_any()
    world = default_worlds() / 'empty.xml'
    shown.simulate(
        f'world:={world}',
        'speed_limit_m_s:=10.0',
        'command_timeout_sec:=60.0',
        'real_time_factor:=0.0',
    )
    shown.view.wait_for_text(f'another simulation runs now: {world}')
    listener = shown.nodes.start(Listener, {'ground_truth/odom': Odometry})
    listener.command(10.0)
    wait_until(
        lambda: listener.latest('ground_truth/odom').pose.pose.position.x > 500.0,
        timeout_sec=20.0,
        what='a robot that has driven 500 m',
    )
    assert 'Not drawn' not in shown.view.output
