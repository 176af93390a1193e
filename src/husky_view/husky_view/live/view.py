# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The page of one running simulation."""

from contextlib import ExitStack
import json
import math
import os
from pathlib import Path
import time

from husky_course.frames import Pose
from husky_runtime.children import ChildProcess
from husky_sim.errors import SimulatorError
from husky_sim.scene_topic import joined, origin_of, QOS, RATE_HZ, read_scene, Scene, world_key
from husky_sim.world import load_world, World
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Float64MultiArray

from husky_view.editor.editor import Editor
from husky_view.live.camera_pane import CameraPane
from husky_view.live.checks import RealTimeFactor, SceneCheck, SimulatorMonitor, State
from husky_view.live.links import RobotLink
from husky_view.live.panel import Panel
from husky_view.live.simulator import SimulatorControl, SimulatorQuery
from husky_view.picture.picture import Picture
from husky_view.server import ActionQueue, PageServer

FIGURES_HZ = 5.0
DRIVER = 'follow_path'
DRIVER_END_SEC = 1.0
_SELDOM_SEC = 2.0

UNWATCHED_SCENES = 30
"""While no tab is open, so many are taken at once: only the trails and the plots grow then."""

_WARNINGS = {
    State.HERE: '',
    State.GONE: 'The simulator is gone, or it hangs. This page goes on as soon as it is back.',
    State.ANOTHER_WORLD: 'Another world is simulated now than the one in {world}. If this stays, '
    'start the simulator again.',
    State.TWO: 'Two simulators run at the same time: end one of them. The first is shown.',
}

_INVALID = 'Not drawn, for it cannot be true: {what}.'
_INVALID_SEC = 3.0


class DriverProcess:
    """The driver as a process, started from the page to drive a file; at most one at a time."""

    def __init__(self) -> None:
        self._process: ChildProcess | None = None

    @property
    def is_running(self) -> bool:
        """Tell whether the last one still drives."""
        return self._process is not None and self._process.exit_code is None

    def start(self, file: Path, namespace: str, *, world: str, start: Pose) -> None:
        """
        Begin to drive; one that still drives is ended first.

        :param world: the MJCF file whose obstacles the course is checked against.
        :param start: where the robot starts in that world.
        """
        self.end()
        path = json.dumps(str(Path(world).absolute()), ensure_ascii=False)  # values are YAML
        self._process = ChildProcess(
            [
                *('ros2', 'run', 'husky_driver', DRIVER, '--waypoints', str(file)),
                *('--ros-args', '-p', 'use_sim_time:=true', '-r', f'__ns:=/{namespace}'),
                *('-p', f'world:={path}', '-p', f'start:={list(start)}'),
            ],
            os.environ,
        )

    def end(self) -> None:
        """Stop driving; may be called twice."""
        process, self._process = self._process, None
        if process is not None:
            process.end(within_sec=DRIVER_END_SEC)


class LiveView:
    """
    Shows one simulation and controls it.

    :param query: of the simulator; asked again when scenes of another world come.
    :param folder: where the editor keeps waypoint files.
    :param is_stopped: whether the emergency stop is pressed already.
    """

    def __init__(
        self,
        node: Node,
        server: PageServer,
        query: SimulatorQuery,
        world: World,
        folder: Path,
        *,
        is_stopped: bool,
    ) -> None:
        self.next_world: Future[World] = Future()  # done when another world is to be shown
        self._node = node
        self._server = server
        self._query = query
        self._world = world
        self._monitor = SimulatorMonitor(world_key(world), now_sec=time.monotonic())
        self._check = SceneCheck(world)
        self._factor = RealTimeFactor()
        self._scene: Scene | None = None  # the newest
        self._unread: list[Scene] = []  # of one run
        self._invalid, self._invalid_sec = '', -math.inf
        self._is_watched = False  # by a tab; nothing is drawn for nobody
        self._unshown = ''  # why the next world is not shown, as last told
        self._driven = 0  # place of the robot that is driven
        self._figures_due_sec = 0.0
        self._actions = ActionQueue()
        self._driver = DriverProcess()
        self._closing = ExitStack()
        self._picture = Picture(server, server.tabs, world)
        self._control = SimulatorControl(node, query.name, self._on_refused, self._closing)
        many = len(world.robots) > 1
        namespaces = [f'{robot.name}/' if many else '' for robot in world.robots]
        self._links = [
            RobotLink(
                *(node, self._picture, place, namespace, self._on_invalid, self._closing),
                is_stopped=is_stopped,
            )
            for place, namespace in enumerate(namespaces)
        ]
        self._panel = Panel(
            server,
            self._actions,
            self._control,
            robots=[robot.name for robot in world.robots],
            stop=self._on_stop,
            choose_robot=self._on_choose_robot,
            choose_camera=self._picture.choose_camera,
        )
        self._camera = CameraPane(
            node,
            server.gui,
            [f'{namespace}camera/image_raw' for namespace in namespaces],
            later=self._actions.put,
            invalid=self._on_invalid,
            closing=self._closing,
        )
        self._editor = Editor(
            server,
            self._actions,
            world,
            folder=folder,
            ground_m=self._picture.scene.ground_m,
            drive=self._on_drive_file,
            on_editing=lambda editing: self._picture.show_numbers(not editing),
            notify=self._panel.notify,
        )
        self._create_entities()

    def _create_entities(self) -> None:
        node, steady = self._node, Clock(clock_type=ClockType.STEADY_TIME)
        self._closing.callback(self._editor.close)
        self._closing.callback(self._driver.end)
        scenes = node.create_subscription(
            Float64MultiArray, f'{self._query.name}/scene', self._on_scene, QOS
        )
        self._closing.callback(node.destroy_subscription, scenes)
        for period_sec, callback in (
            (1.0 / RATE_HZ, self._on_frame),
            (_SELDOM_SEC, self._on_seldom),
        ):
            timer = node.create_timer(period_sec, callback, clock=steady)
            self._closing.callback(node.destroy_timer, timer)

    @property
    def is_stopped(self) -> bool:
        """Tell whether every robot is held by its emergency stop."""
        return all(link.is_stopped for link in self._links)

    def close(self) -> None:
        """Stop showing it, and end the driver that was started here; may be called twice."""
        self._closing.close()

    def hear_last_stop(self) -> None:
        """Hear of a stop that was clicked while this was closed; the next view publishes it."""
        self._actions.run_urgent()

    def _on_scene(self, msg: Float64MultiArray) -> None:
        now = time.monotonic()
        if not self._monitor.accept(*origin_of(msg), now_sec=now):
            return
        try:
            scene = read_scene(msg, robots=len(self._links))
        except ValueError as error:
            self._on_invalid(f'~/scene: {error}')
            return
        self._factor.add(wall_sec=now, time_sec=float(scene.time_sec[-1]))
        if self._unread and self._unread[0].run != scene.run:
            self._read_scenes()
        self._unread.append(scene)
        if self._is_watched or len(self._unread) >= UNWATCHED_SCENES:
            self._read_scenes()

    def _read_scenes(self) -> None:
        """Take what has come of one run, as one scene: that costs the same as each of them."""
        if not self._unread:
            return
        scene = joined(self._unread)
        self._unread = []
        if reason := self._check.error_in(scene):
            self._on_invalid(f'~/scene: {reason}')
            return
        if self._scene is None:
            for link, stopped in zip(self._links, scene.stopped, strict=True):
                link.adopt_stop(stopped=stopped)
        elif self._scene.run != scene.run:
            self._control.factor = None  # it is another simulator
        self._scene = scene
        if self._picture.show(scene):
            for link in self._links:
                link.begin_run()

    def _on_invalid(self, what: str) -> None:
        """Report what is not drawn: on the page for a while, in the log once."""
        if what != self._invalid:
            self._node.get_logger().warning(_INVALID.format(what=what))
        self._invalid, self._invalid_sec = what, time.monotonic()

    def _warning(self, state: State, now_sec: float) -> str:
        if state is State.HERE and now_sec - self._invalid_sec < _INVALID_SEC:
            return _INVALID.format(what=self._invalid)
        return _WARNINGS[state].format(world=self._world.path)

    def _on_frame(self) -> None:
        now = time.monotonic()
        self._actions.run()
        self._panel.show_stopped(self.is_stopped, now_sec=now)
        command = self._panel.teleop.command(now_sec=now)
        if command is not None:
            self._links[self._driven].drive(*command, now_sec=now)
        for link in self._links:
            link.end_idle_commands(now)
        self._editor.draw()
        if self._server.is_watched != self._is_watched:
            self._is_watched = not self._is_watched
            self._read_scenes()
            self._figures_due_sec = now
            self._look_through_camera()
        if self._is_watched:
            for link in self._links:
                link.draw()
            self._picture.draw(now)
        if now >= self._figures_due_sec:
            self._figures_due_sec = now + 1.0 / FIGURES_HZ
            state = self._monitor.state(now_sec=now)
            self._panel.show_warning(self._warning(state, now))
            if self._is_watched:
                self._camera.draw()
                if self._scene is not None:
                    self._show_figures(self._scene, state)
            if state is State.ANOTHER_WORLD:
                self._look_for_another_world()
        if self._is_watched:
            self._server.flush()

    def _on_seldom(self) -> None:
        self._editor.look_for_files()
        self._control.poll_factor()
        self._look_through_camera()

    def _look_through_camera(self) -> None:
        if self._is_watched:
            self._camera.look()
        else:
            self._camera.end()  # a simulator draws what somebody subscribes to

    def _look_for_another_world(self) -> None:
        try:
            answer = self._query.poll()
            if answer is None or self.next_world.done():
                return
            world = load_world(*answer)
        except SimulatorError as error:
            if str(error) != self._unshown:  # it is asked again and again
                self._unshown = str(error)
                self._on_refused('Not shown', self._unshown)
            return
        if world_key(world) != self._monitor.world:
            self._node.get_logger().info(f'another simulation runs now: {world.path}')
            self.next_world.set_result(world)

    def _show_figures(self, scene: Scene, state: State) -> None:
        robot = self._picture.robots[self._driven]
        unknown = scene.paused or state is State.GONE
        self._panel.show(
            time_sec=float(scene.time_sec[-1]),
            real_time_factor=None if unknown else self._factor.value,
            paused=scene.paused,
            speed_m_s=robot.speed_m_s,
            cross_track_m=robot.cross_track_m,
            waypoints_left=self._links[self._driven].waypoints_left,
            collisions=self._picture.collisions.count,
            colors=self._picture.colors() | self._editor.colors(),
            ground=self._picture.ground_html(),
            history=self._picture.history,
        )

    def _on_stop(self, stopped: bool) -> None:
        for link in self._links:
            link.stop(stopped)
        self._panel.teleop.release_all()

    def _on_choose_robot(self, place: int) -> None:
        self._driven = place
        self._picture.follow(place)
        self._editor.choose_robot(place)
        self._camera.choose_robot(place)

    def _on_refused(self, what: str, reason: str) -> None:
        self._node.get_logger().warning(f'{what}: {reason}')
        self._panel.notify(what, reason, True)

    def _on_drive_file(self, file: Path) -> None:
        """Drive a saved file from the start."""
        robot, world = self._world.robots[self._driven], self._world.path
        name = robot.name if len(self._links) > 1 else ''
        parts = [self._node.get_namespace().strip('/'), name]
        namespace = '/'.join(part for part in parts if part)
        driving = (DRIVER, f'/{namespace}') in self._node.get_node_names_and_namespaces()
        if driving and not self._driver.is_running:
            self._on_refused('Not driven', f'{DRIVER} drives this robot already: end it first')
            return
        self._driver.end()
        self._control.reset(
            then=lambda: self._driver.start(file, namespace, world=world, start=robot.pose)
        )
