# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Samples a simulation into the record of its run."""

from collections.abc import Callable, Iterable
from pathlib import Path
from types import TracebackType

from husky_course.frames import Indices
from husky_course.record import Disturbance, MAX_RATE, Overturn, RecordWriter, Row
import numpy as np

from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.errors import SettingError
from husky_sim.robot.diff_drive import limited
from husky_sim.simulation import SimulatedRobot, Simulation
from husky_sim.world.world import World

MOVED = 1e-3
"""Of any joint coordinate: a millimetre, or about a tenth of a degree."""

_DIGITS = 4


def loose_body_ids(world: World) -> dict[str, int]:
    """
    Return the number in the model of every loose body, by name.

    Loose is every body outside the robots that has a joint.
    """
    model = world.model
    robots = {int(model.body(f'{robot.name}/base_link').rootid[0]) for robot in world.robots}
    return {
        model.body(body).name or f'body {body}': body
        for body in range(model.nbody)
        if model.body_jntnum[body] and int(model.body_rootid[body]) not in robots
    }


def loose_bodies(world: World) -> dict[str, slice]:
    """Return which part of qpos belongs to every loose body, by name."""
    model = world.model
    ends = [*model.jnt_qposadr.tolist(), model.nq]
    return {
        name: slice(
            ends[model.body_jntadr[body]], ends[model.body_jntadr[body] + model.body_jntnum[body]]
        )
        for name, body in loose_body_ids(world).items()
    }


class PushedBodies:
    """Watches the loose bodies of a simulation: a pose is recorded only when it has moved."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._loose = loose_bodies(simulation.world)
        places = [place for part in self._loose.values() for place in range(part.start, part.stop)]
        self._places: Indices = np.array(places, dtype=np.int64)
        self.restart()

    def restart(self) -> None:
        """Use the poses of now as those before any push."""
        self._noted = self._simulation.data.qpos.copy()
        self._was_calm = False

    def moved(self) -> list[tuple[str, list[float]]]:
        """Return name and joint coordinates of what has moved; call it after every period."""
        was_calm, self._was_calm = self._was_calm, self._simulation.only_robots_awake
        if was_calm and self._was_calm:
            return []
        qpos, places = self._simulation.data.qpos, self._places
        if not (np.abs(qpos[places] - self._noted[places]) > MOVED).any():
            return []
        found = []
        for name, part in self._loose.items():
            if (np.abs(qpos[part] - self._noted[part]) > MOVED).any():
                self._noted[part] = qpos[part]
                found.append((name, [round(value, _DIGITS) for value in qpos[part].tolist()]))
        return found


class RunRecorder:
    """Records a run, one row every control period; the first is the start."""

    def __init__(
        self,
        simulation: Simulation,
        path: str | Path,
        *,
        complain: Callable[[str], object] | None = None,
    ) -> None:
        """
        Begin the file with the simulation as it is now; its folder is made where there is none.

        :param complain: called with one line when nothing more can be written (a full disk); the
            run continues without a record. None: OSError is raised.
        :raises OSError: if the file cannot be made.
        """
        self._simulation = simulation
        self._pushed = PushedBodies(simulation)
        self._writer = RecordWriter(
            path,
            world=simulation.config.world,
            conditions=simulation.config.conditions,
            control_period_sec=CONTROL_PERIOD_SEC,
            robots=simulation.world.robots,
            obstacles=simulation.world.obstacles,
            on_full=complain,
        )
        self._record_start()

    def restart(self) -> None:
        """Drop everything and begin with the simulation as it is now."""
        self._writer.restart()
        self._pushed.restart()
        self._record_start()

    def append(self) -> None:
        """Add the end of a control period."""
        simulation = self._simulation
        time_sec = simulation.time_sec
        for body, qpos in self._pushed.moved():
            self._writer.add_push(body=body, time_sec=time_sec, qpos=qpos)
        for touch in simulation.touches:
            self._writer.add_collision(touch)
        for robot in simulation.robots:
            if robot.turned_over:
                self._writer.add_overturn(Overturn(robot=robot.name, time_sec=time_sec))
        self._writer.append(_row(robot, time_sec) for robot in simulation.robots)
        if simulation.touches:
            self._writer.flush()

    def disturb(self, time_sec: float, topic: str, nodes: Iterable[str]) -> None:
        """Note that others than this run's own nodes were heard on a topic."""
        disturbance = Disturbance(time_sec=time_sec, topic=topic, nodes=tuple(nodes))
        self._writer.add_disturbance(disturbance)
        self._writer.flush()

    def close(self) -> None:
        """Say that this is the end; may be called twice."""
        if not self._writer.closed:
            for touch in self._simulation.unreported_touches():
                self._writer.add_collision(touch)
            self._writer.end(self._simulation.time_sec)

    def _record_start(self) -> None:
        self.append()
        self._writer.flush()

    def __enter__(self) -> 'RunRecorder':
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if error is None:
            self.close()
        else:
            self._writer.close()  # a run that broke off has no end


def open_recorder(
    simulation: Simulation, path: str, complain: Callable[[str], object]
) -> RunRecorder | None:
    """
    Return the recorder that a simulator's parameter `record` asks for; empty: none.

    :raises SettingError: if the file cannot be made.
    """
    if not path:
        return None
    try:
        return RunRecorder(simulation, path, complain=complain)
    except OSError as error:
        raise SettingError(
            f'record={path!r}: cannot be written: {error.strerror}; name a file in a folder of '
            'your own'
        ) from error


def _row(robot: SimulatedRobot, time_sec: float) -> Row:
    state, filtered, controller = robot.state, robot.filtered, robot.controller
    return Row(
        time_sec=time_sec,
        x=state.position[0],
        y=state.position[1],
        yaw=state.yaw,
        odom_x=filtered.x,
        odom_y=filtered.y,
        odom_yaw=filtered.yaw,
        speed_m_s=state.velocity[0],
        yaw_rate_rad_s=state.angular_velocity[2],
        command_speed_m_s=limited(controller.asked_speed_m_s, MAX_RATE),
        command_yaw_rate_rad_s=limited(controller.asked_yaw_rate_rad_s, MAX_RATE),
    )
