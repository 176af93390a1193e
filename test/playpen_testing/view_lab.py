# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The view as people use it: a simulator, its page, and browsers that look at it."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from geometry_msgs.msg import Twist
from husky_runtime.domains import OwnDomain
from nav_msgs.msg import Odometry
from playwright.sync_api import Browser, Page
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool

from playpen_testing.browser import open_page
from playpen_testing.listener import Listener
from playpen_testing.processes import Process, Processes
from playpen_testing.services import ask
from playpen_testing.spinning import SpunNodes

COMMANDS = 'husky_velocity_controller/cmd_vel'


class Lab:
    """A simulator, its view, and somebody who listens; as processes, as anybody runs them."""

    def __init__(
        self,
        processes: Processes,
        nodes: SpunNodes,
        environment: dict[str, str],
        browser: Browser,
        folder: Path,
    ) -> None:
        self.browser = browser
        self.folder = folder
        self.nodes = nodes
        self._processes = processes
        self._environment = environment
        self.simulator = self.start_simulator()
        self.simulator.wait_for_text('obstacles')
        self.view = processes.start(
            *('ros2', 'run', 'husky_view', 'view', '--ros-args', '-p', 'viewer_port:=18080'),
            *('-p', f'waypoints_folder:={folder}'),
            environment=environment,
        )
        topics = {'/clock': Clock, COMMANDS: Twist, 'ground_truth/odom': Odometry}
        self.listener = self.nodes.start(Listener, topics)
        self.listener.latest('ground_truth/odom')
        self.view.wait_for_text('look at http://')
        self.address = self.view.output.split('look at ')[1].split()[0]

    def start_simulator(self, *robots: str) -> Process:
        """Start a simulator; of several robots ('NAME X Y YAW') if they are given."""
        given = ['--ros-args', '-p', f'robots:=[{", ".join(map(repr, robots))}]']
        self.simulator = self._processes.start(
            *('ros2', 'run', 'husky_sim', 'husky_sim'),
            *(given if robots else ()),
            environment=self._environment,
        )
        return self.simulator

    def pause(self) -> None:
        """Pause the simulator."""
        ask(self.listener, SetBool, 'husky_sim/pause', data=True)

    def drive(self, course: Path) -> Process:
        """Let follow_path drive a course."""
        return self._processes.start(
            *('ros2', 'run', 'husky_driver', 'follow_path', '--waypoints', str(course)),
            environment=self._environment,
        )

    @property
    def time_sec(self) -> float:
        clock = self.listener.heard['/clock'][-1].clock
        return float(clock.sec + clock.nanosec * 1e-9)

    @property
    def truth(self) -> Odometry:
        return self.listener.heard['ground_truth/odom'][-1]

    @property
    def speed_m_s(self) -> float:
        return float(self.truth.twist.twist.linear.x)

    def moves(self) -> bool:
        return self.speed_m_s > 0.2

    def stands(self) -> bool:
        return abs(self.speed_m_s) < 0.01

    def open(self, *size: int, drawn: bool = False) -> Page:
        """Look at the view."""
        page = open_page(self.browser, self.address, *size, drawn=drawn)
        page.locator('.husky-stop').wait_for(state='attached')
        return page


@contextmanager
def view_lab(folder: Path, browser: Browser) -> Iterator[Lab]:
    """Start everything in a domain of its own; waypoints are saved in a folder of it."""
    waypoints = folder / 'waypoints'
    waypoints.mkdir()
    with OwnDomain() as domain:
        environment = {
            'ROS_DOMAIN_ID': str(domain.number),
            'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
            'ROS_LOG_DIR': str(folder / 'ros_log'),
            'PYTHONUNBUFFERED': '1',
        }
        try:
            with Processes() as processes, SpunNodes(domain.number) as nodes:
                yield Lab(processes, nodes, environment, browser, waypoints)
        finally:
            for context in browser.contexts:
                context.close()
