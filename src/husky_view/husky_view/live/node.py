# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The live view as a ROS 2 node: shows a running simulator in the browser and controls it.

It asks the simulator for its world, so it can be started at any time, before or after it.
"""

import math
from pathlib import Path
import time
from typing import Any

from husky_sim.errors import SimulatorError
from husky_sim.scene_topic import origin_of, QOS, RATE_HZ, read_scene, Scene, world_key
from husky_sim.world import load_world
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Float64MultiArray
import viser

from husky_view.editor.course import waypoint_folder
from husky_view.editor.editor import Editor
from husky_view.live.driver_process import DRIVER, DriverProcess
from husky_view.live.pace import Pace
from husky_view.live.panel import Controls, Numbers, Panel, trouble_html
from husky_view.live.plausibility import SceneCheck
from husky_view.live.presence import Presence, State
from husky_view.live.robot_link import RobotLink
from husky_view.live.simulator import SimulatorLink, world_and_robots
from husky_view.picture.picture import Picture
from husky_view.server import address_of, close_server, open_server
from husky_view.work import Work

TITLE = 'Husky playpen'
NUMBERS_HZ = 5.0
_ASK_AGAIN_SEC = 0.05
_ANSWER_SEC = 2.0
_LOOK_FOR_FILES_SEC = 2.0
_HINT_AFTER_SEC = 3.0

_TROUBLE = {
    State.HERE: '',
    State.GONE: 'The simulator is gone, or it hangs. This page goes on as soon as it is back.',
    State.ANOTHER_WORLD: 'Another world is simulated now than the one in {world}. If this stays, '
    'start the simulator again.',
    State.TWO: 'Two simulators run at the same time: end one of them. The first is shown.',
}

_NONSENSE = 'Not drawn, for it cannot be true: {what}.'
_NONSENSE_SEC = 3.0

_PARAMETERS = {
    'simulator': ('husky_sim', 'Name of the simulator node to show.'),
    'viewer_host': ('127.0.0.1', 'Address to serve the page at; 0.0.0.0 lets others look.'),
    'viewer_port': (8080, 'Port of the page; the next free one if it is taken.'),
    'waypoints_folder': ('', "Where the editor saves; empty: the workspace's config/waypoints."),
}


class ViewNode(Node):
    """Serves the page of one simulation."""

    def __init__(self, server: viser.ViserServer | None = None, **arguments: Any) -> None:
        """
        Open the page; it is filled when the simulator answers.

        :param server: of the node before this one, whose page goes on.
        :param arguments: what `rclpy.node.Node` takes: context, parameter_overrides, ...
        :raises AddressError: if the page cannot be served there.
        """
        super().__init__('husky_view', **arguments)
        settings: dict[str, Any] = {
            name: self.declare_parameter(
                name, default, ParameterDescriptor(description=text, read_only=True)
            ).value
            for name, (default, text) in _PARAMETERS.items()
        }
        self.over: Future[None] = Future()
        self.another_runs = False
        self._simulator = SimulatorLink(self, settings['simulator'], self._on_refused)
        self.server = server or open_server(
            settings['viewer_host'], settings['viewer_port'], title=TITLE
        )
        self.address = address_of(self.server)
        self._waiting = self.server.gui.add_html(
            trouble_html(f'Waiting for the simulator {self._simulator.name}: is it running?')
        )
        self._folder = Path(settings['waypoints_folder'] or waypoint_folder())
        self._driver = DriverProcess()
        self._work = Work()
        self._panel: Panel | None = None
        self._editor: Editor | None = None
        self._scene: Scene | None = None
        self._answer: Any = None
        self._answer_due_sec = 0.0
        self._pace = Pace()
        self._driven = 0
        self._stopped = False
        self._numbers_due_sec = 0.0
        self._hint_due_sec = time.monotonic() + _HINT_AFTER_SEC
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._asking = self.create_timer(_ASK_AGAIN_SEC, self._on_ask, clock=self._steady)

    def _on_ask(self) -> None:
        """Wait for the simulator's answer, then build the picture."""
        answer = self._answer_of_simulator()
        if answer is not None:
            self._asking.cancel()
            self._build(*world_and_robots(answer))
        elif time.monotonic() > self._hint_due_sec:
            self._hint_due_sec = float('inf')
            self.get_logger().warning(
                f'{self._simulator.name} does not answer yet: is the simulator running?'
            )

    def _answer_of_simulator(self) -> Any:
        """Ask the simulator what it runs; returns None until it has answered."""
        now = time.monotonic()
        if self._answer is None or now > self._answer_due_sec:
            self._answer = self._simulator.ask()
            self._answer_due_sec = now + _ANSWER_SEC
        elif self._answer.done():
            answer, self._answer = self._answer.result(), None
            return answer
        return None

    def _build(self, world_file: str, robots: Any) -> None:
        world = load_world(world_file, robots)
        self._waiting.remove()
        self._presence = Presence(world_key(world), now_sec=time.monotonic())
        self._picture = Picture(self.server, world)
        self._check = SceneCheck(world)
        self._nonsense, self._nonsense_sec = '', -math.inf
        many = len(robots) > 1
        self._links = [
            RobotLink(
                self, self._picture, place, f'{robot.name}/' if many else '', self._disbelieve
            )
            for place, robot in enumerate(robots)
        ]
        controls = Controls(
            pause=self._simulator.pause,
            step=self._simulator.step,
            reset=self._simulator.reset,
            set_factor=self._simulator.set_factor,
            stop=self._on_stop,
            choose_robot=self._on_choose_robot,
            choose_camera=self._on_choose_camera,
        )
        self._panel = Panel(
            self.server, self._work, controls, robots=[robot.name for robot in robots]
        )
        self._scenes = self.create_subscription(
            Float64MultiArray, f'{self._simulator.name}/scene', self._on_scene, QOS
        )
        self._frames = self.create_timer(1.0 / RATE_HZ, self._on_frame, clock=self._steady)
        self._editor = Editor(
            self.server,
            self._work,
            world,
            folder=self._folder,
            ground_m=self._picture.scene.ground_m,
            drive=self._on_drive_file,
            tell=self._panel.tell,
        )
        self._files = self.create_timer(
            _LOOK_FOR_FILES_SEC, self._editor.look_for_files, clock=self._steady
        )
        self.get_logger().info(f'look at {self.address}')

    def _on_scene(self, msg: Float64MultiArray) -> None:
        now = time.monotonic()
        if not self._presence.hear(*origin_of(msg), now_sec=now):
            return
        try:
            scene = read_scene(msg, robots=len(self._links))
        except ValueError as error:
            self._disbelieve(f'~/scene: {error}')
            return
        if what := self._check.complaint(scene):
            self._disbelieve(f'~/scene: {what}')
            return
        self._pace.add(wall_sec=now, time_sec=float(scene.time_sec[-1]))
        self._scene = scene
        self._picture.show(scene)

    def _disbelieve(self, what: str) -> None:
        """Say what came that is not drawn: on the page for a while, in the log once."""
        if what != self._nonsense:
            self.get_logger().warning(_NONSENSE.format(what=what))
        self._nonsense, self._nonsense_sec = what, time.monotonic()

    def _trouble(self, state: State, now_sec: float) -> str:
        if state is State.HERE and now_sec - self._nonsense_sec < _NONSENSE_SEC:
            return _NONSENSE.format(what=self._nonsense)
        return _TROUBLE[state].format(world=self._picture.world.path)

    def _on_frame(self) -> None:
        panel = self._panel
        if panel is None:
            return
        now = time.monotonic()
        self._work.do()
        command = panel.pad.command(now_sec=now)
        if command is not None:
            self._links[self._driven].drive(*command, now_sec=now)
        for link in self._links:
            link.draw(now)
        self._picture.draw(now)
        if now >= self._numbers_due_sec:
            self._numbers_due_sec = now + 1.0 / NUMBERS_HZ
            state = self._presence.state(now_sec=now)
            panel.show_trouble(self._trouble(state, now))
            if self._scene is not None:
                panel.show(self._numbers(self._scene, state))
            if state is State.ANOTHER_WORLD:
                self._look_for_another()
        self.server.flush()

    def _look_for_another(self) -> None:
        """End this node if the simulator has a world to show that is not the one shown."""
        answer = self._answer_of_simulator()
        if answer is None:
            return
        try:
            world = load_world(*world_and_robots(answer))
        except SimulatorError as error:
            self._on_refused('Not shown', str(error))
            return
        if world_key(world) != self._presence.world and not self.over.done():
            self.get_logger().info(f'another simulation runs now: {world.path}')
            self.another_runs = True
            self.over.set_result(None)

    def _numbers(self, scene: Scene, state: State) -> Numbers:
        robot = self._picture.robots[self._driven]
        return Numbers(
            time_sec=float(scene.time_sec[-1]),
            real_time_factor=None if scene.paused or state is State.GONE else self._pace.factor,
            paused=scene.paused,
            speed_m_s=robot.speed_m_s,
            cross_track_m=robot.cross_track_m,
            waypoints_left=self._links[self._driven].waypoints_left,
            collisions=self._picture.collision_count,
        )

    def _on_stop(self, stopped: bool) -> None:
        self._stopped = stopped
        for link in self._links:
            link.stop(stopped)
        if self._panel is not None:
            self._panel.pad.release_all()
            self._panel.show_stopped(stopped)

    def _on_choose_robot(self, place: int) -> None:
        self._driven = self._picture.followed = place
        if self._editor is not None:
            self._editor.choose_robot(place)

    def _on_choose_camera(self, client: Any, preset: str) -> None:
        robot = self._picture.scene.position(self._driven)
        yaw = self._picture.robots[self._driven].yaw
        self._picture.cameras.choose(
            client, preset, robot=robot, yaw=yaw, now_sec=time.monotonic()
        )

    def _on_refused(self, what: str, reason: str) -> None:
        self.get_logger().warning(f'{what}: {reason}')
        if self._panel is not None:
            self._panel.tell(what, reason, True)

    def _on_drive_file(self, file: Path) -> None:
        """Drive a saved file from the start."""
        robot = self._picture.world.robots[self._driven].name
        parts = [self.get_namespace().strip('/'), robot if len(self._links) > 1 else '']
        namespace = '/'.join(part for part in parts if part)
        driving = (DRIVER, f'/{namespace}') in self.get_node_names_and_namespaces()
        if driving and not self._driver.is_running:
            self._on_refused('Not driven', f'{DRIVER} drives this robot already: end it first')
            return
        self._driver.end()
        self._simulator.reset(then=lambda: self._driver.start(file, namespace))

    def destroy_node(self) -> None:
        """Close the page, unless another node goes on with it; may be called twice."""
        self._driver.end()
        if self.another_runs:
            if self._editor is not None:
                self._editor.close()
            self.server.gui.reset()
            self.server.scene.reset()
        else:
            close_server(self.server)
        super().destroy_node()
