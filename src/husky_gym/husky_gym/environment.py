# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The environment `HuskyPlaypen-v0`: one Husky drives a course.

An episode is a function of the settings, of the seeds that `reset` is given and of the actions,
bit for bit. Its rewards add up to the score that the grader gives it, from 0 to 100.
"""

from dataclasses import fields
import math
from typing import Any

import gymnasium
from gymnasium.utils import EzPickle
from husky_course.frames import Pose
from husky_course.record import Collision
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_grader.playpen import default_course
from husky_grader.scoring import Report, STANDING_M_S, STANDING_RAD_S
from husky_sim.errors import SimulatorError
from husky_sim.sensors import Camera
import numpy as np
import numpy.typing as npt

from husky_gym.husky import Husky
from husky_gym.observation import action_space, GREATEST, Observation, observation_space, Sight
from husky_gym.progress import Progress
from husky_gym.running_score import report_on, RunningScore
from husky_gym.settings import EnvironmentSettings

Action = npt.NDArray[np.floating[Any]]
Info = dict[str, Any]

MAX_DRAWS = 1000
PERIODS_A_SECOND = 50


class HuskyPlaypen(gymnasium.Env[Observation, Action], EzPickle):
    """
    See docs/learning.md for what is seen, commanded and rewarded, and in which units.

    A copy, or what `pickle` makes of one, is a new one with the same settings, as of Gymnasium's
    own environments: not all of MuJoCo can be copied.
    """

    metadata: dict[str, Any] = {
        'render_modes': ['rgb_array'],
        'render_fps': PERIODS_A_SECOND,
    }

    def __init__(self, *, render_mode: str | None = None, **settings: Any) -> None:
        """
        Load the course and the world.

        :param render_mode: rgb_array: `render` returns what the camera on the robot sees.
        :param settings: those of `EnvironmentSettings`.
        :raises ValueError: if a setting, the course or the start cannot be used.
        """
        EzPickle.__init__(self, render_mode=render_mode, **settings)
        if render_mode not in (None, 'rgb_array'):
            raise ValueError(f'render_mode={render_mode!r}: allowed is rgb_array or None')
        self.render_mode = render_mode
        known = [each.name for each in fields(EnvironmentSettings)]
        for name in settings.keys() - known:
            raise ValueError(f'{name}: no such setting; allowed are {", ".join(known)}')
        self.settings = EnvironmentSettings(**settings)
        self.metadata = {
            **self.metadata,
            'render_fps': PERIODS_A_SECOND / self.settings.frame_skip,
        }
        course = load_course(self.settings.course or default_course())
        self.planned = plan_route(course)  # what the grader judges by
        self.route = self.planned.begun_at((0.0, 0.0))
        self.husky = Husky(self.settings, visual=render_mode is not None)
        self.limit_sec = self.settings.time_limit_sec or self.route.limit_sec
        self.action_space = action_space()  # type: ignore[assignment]
        self.observation_space = observation_space(self.settings)  # type: ignore[assignment]
        self._sight = Sight(self.route, self.settings)
        self._place = Progress(self.route)
        self._score = RunningScore(self.route.par_time_sec, self.route.length_m)
        self._camera: Camera | None = None
        self._is_over = True

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """
        Begin an episode.

        :param options: none are known.
        :raises ValueError: if there is an option, or no free place to start at.
        """
        super().reset(seed=seed)
        if options:
            raise ValueError(f'options={options!r}: reset knows none; give settings to make')
        self.husky.begin(self._drawn_start(), int(self.np_random.integers(2**31)))
        for each in (self._sight.place, self._place, self._score):
            each.restart()
        self._place.follow(*self.husky.place)
        self._worth, self._is_over = 0.0, False
        self._touches: list[Collision] = []
        self._rows = [self.husky.row()]
        return self._observation(), self._info()

    def _drawn_start(self) -> Pose:
        """Return a start near that of the course, by chance, where nothing stands."""
        m, rad = self.settings.random_start_m, self.settings.random_start_rad
        if not m and not rad:
            return 0.0, 0.0, 0.0
        for _ in range(MAX_DRAWS):
            x, y, yaw = self.np_random.uniform([-m, -m, -rad], [m, m, rad]).tolist()
            if self.husky.is_free((x, y, yaw)):
                return x, y, yaw
        raise ValueError(
            f'random_start_m={m}, random_start_rad={rad}: no free place among {MAX_DRAWS}; '
            'start farther away from obstacles'
        )

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, Info]:
        """
        Drive for `frame_skip` control periods; what is beyond the limits is cut to them.

        :param action: speed and yaw rate as parts of GREATEST, from -1 to 1.
        :raises ValueError: if the action is not two finite numbers.
        :raises RuntimeError: if the episode is over.
        """
        speed, yaw_rate = _checked(action)
        if self._is_over:
            raise RuntimeError('the episode is over, or none has begun: call reset() first')
        for _ in range(self.settings.frame_skip):
            ended = self._drive_period(speed, yaw_rate)
            time_sec = self.husky.simulation.time_sec
            truncated = not ended and time_sec >= self.limit_sec
            if ended or truncated:
                break
        self._is_over = ended or truncated
        report = self._report() if self._is_over else None
        worth = self._score.value(time_sec) if report is None else report.score
        reward, self._worth = worth - self._worth, worth
        return self._observation(), reward, ended, truncated, self._info(report)

    def _drive_period(self, speed_m_s: float, yaw_rate_rad_s: float) -> bool:
        """Drive for one control period; tell whether that ends the episode."""
        husky, place = self.husky, self._place
        touches = husky.drive(speed_m_s, yaw_rate_rad_s)
        self._touches += touches
        self._rows.append(husky.row())
        place.follow(*husky.place)
        self._score.add(place, speed_m_s=husky.robot.state.velocity[0])
        return bool(touches) or place.away_m > self.settings.lost_m or self._has_arrived()

    def _has_arrived(self) -> bool:
        """Tell whether it stands at the last waypoint, as the grader sees it."""
        course, state = self.route.course, self.husky.robot.state
        if (
            self._place.left_m > course.tolerance_m
            or abs(state.velocity[0]) >= STANDING_M_S
            or abs(state.angular_velocity[2]) >= STANDING_RAD_S
        ):
            return False
        last = course.stops[-1]
        x, y = self.husky.place
        return math.hypot(x - last.x_m, y - last.y_m) <= course.tolerance_m

    def _report(self) -> Report:
        simulation = self.husky.simulation
        self._touches += simulation.unreported_touches()
        return report_on(self._rows, self._touches, self.planned, simulation.config)

    def _observation(self) -> Observation:
        return self._sight.observe(self.husky.estimate, self.husky.ranges)

    def _info(self, report: Report | None = None) -> Info:
        """Return what a policy must not see; of an episode that is over, the report on it, too."""
        info: Info = {
            'time_sec': self.husky.simulation.time_sec,
            'odometry': self.husky.estimate,
            'along_m': self._place.along_m,
            'offset_m': self._place.offset_m,
        }
        if report is not None:
            info |= {
                'score': report.score,
                'passed': report.passed,
                'parts': {part.name: part.factor for part in report.parts},
                'reasons': report.reasons,
                'trajectory_sha256': report.trajectory_sha256,
            }
        return info

    def render(self) -> npt.NDArray[np.uint8] | None:  # type: ignore[override]
        """
        Return what the camera on the robot sees, 480 rows of 640 pixels; None without a mode.

        :raises RuntimeError: if pictures cannot be drawn here.
        """
        if self.render_mode is None:
            return None
        if self._camera is None:
            simulation = self.husky.simulation
            try:
                self._camera = Camera(
                    self.husky.start.name,
                    simulation.model,
                    simulation.data,
                    setting='render_mode',
                    off='None',
                )
            except SimulatorError as error:
                raise RuntimeError(str(error)) from None
        return self._camera.picture().copy()

    def close(self) -> None:
        """Release what pictures are drawn with; may be called twice."""
        if self._camera is not None:
            self._camera.close()
            self._camera = None


def _checked(action: Any) -> tuple[float, float]:
    """Return speed and yaw rate; of what is not finite the robot would just stand."""
    try:
        speed, yaw_rate = np.asarray(action, dtype=np.float64).tolist()
        is_usable = math.isfinite(speed) and math.isfinite(yaw_rate)
    except (TypeError, ValueError):
        is_usable = False
    if not is_usable:
        raise ValueError(
            f'action={action!r}: allowed are two finite numbers, the parts of the greatest speed '
            'and of the greatest yaw rate, from -1 to 1'
        )
    return speed * GREATEST[0], yaw_rate * GREATEST[1]
