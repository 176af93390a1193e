# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The view as people use it: a simulator, its page, and browsers that look at it."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock

from playpen_testing import chromium
from playpen_testing.browser import Browser
from playpen_testing.domain import free_domain_id
from playpen_testing.listener import Listener
from playpen_testing.page import number
from playpen_testing.processes import Process, Processes
from playpen_testing.spinning import SpunNodes

COMMANDS = 'husky_velocity_controller/cmd_vel'


class Browsers:
    """The browsers of some tests."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._program = chromium.find_or_install()
        self._open: list[Browser] = []

    def open(
        self, url: str, width: int = 1000, height: int = 700, *, drawn: bool = False
    ) -> Browser:
        """Open the view in a browser of its own; unless drawn, its 3D scene stays empty."""
        profile = self._folder / f'profile_{len(self._open)}'
        browser = Browser(self._program, profile, width=width, height=height)
        self._open.append(browser)
        if not drawn:
            browser.draw_nothing()
        browser.visit(url)
        browser.wait_for(number('time'), what='the panel of the view')
        return browser

    def close(self) -> None:
        """Close all of them; may be called twice."""
        for browser in self._open:
            browser.close()


class Lab:
    """A simulator, its view, and somebody who listens; as processes, as anybody runs them."""

    def __init__(
        self,
        processes: Processes,
        nodes: SpunNodes,
        environment: dict[str, str],
        browsers: Browsers,
        folder: Path,
    ) -> None:
        self.browsers = browsers
        self.folder = folder
        self._processes = processes
        self._environment = environment
        processes.start('ros2', 'run', 'husky_sim', 'husky_sim', environment=environment)
        self.view = processes.start(
            *('ros2', 'run', 'husky_sim', 'view', '--ros-args', '-p', 'viewer_port:=18080'),
            *('-p', f'waypoints_folder:={folder}'),
            environment=environment,
        )
        topics = {'/clock': Clock, COMMANDS: Twist, 'ground_truth/odom': Odometry}
        self.listener = nodes.start(Listener, topics)
        self.listener.latest('ground_truth/odom')
        self.view.wait_for_text('look at http://')
        self.address = self.view.output.split('look at ')[1].split()[0]

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

    def open(self, *size: int, drawn: bool = False) -> Browser:
        """Look at the view."""
        page = self.browsers.open(self.address, *size, drawn=drawn)
        page.wait_for("document.querySelector('.husky-stop')", what='the pad in its place')
        return page


@contextmanager
def view_lab(folder: Path) -> Iterator[Lab]:
    """Start everything in a domain of its own; waypoints are saved in a folder of it."""
    domain = free_domain_id()
    environment = {
        'ROS_DOMAIN_ID': str(domain),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'ROS_LOG_DIR': str(folder / 'ros_log'),
        'PYTHONUNBUFFERED': '1',
    }
    waypoints = folder / 'waypoints'
    waypoints.mkdir()
    browsers = Browsers(folder)
    try:
        with Processes() as processes, SpunNodes(domain) as nodes:
            yield Lab(processes, nodes, environment, browsers, waypoints)
    finally:
        browsers.close()
