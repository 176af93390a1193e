# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node: it answers every odometry message with one command of a `Drive`."""

from collections.abc import Callable
from functools import partial
import time
from typing import Any

from husky_course.route import plan_route, Route
from husky_course.waypoints import load_course
from husky_runtime.parameters import declare_settings
from husky_runtime.settings import names_of, refuse_unknown
from nav_msgs.msg import Odometry as OdometryMsg
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from rclpy.task import Future
from sensor_msgs.msg import Imu, LaserScan
from std_srvs.srv import SetBool

from husky_driver.checks.plausibility import no_rotation
from husky_driver.drive.drive import Drive
from husky_driver.motion import Odometry, relative_odometry
from husky_driver.obstacle_stop import ObstacleStop
from husky_driver.ros.commands import Commands, NO_STAMP
from husky_driver.ros.display import DriveDisplay
from husky_driver.ros.imu_wait import ImuWait
from husky_driver.ros.missing import what_is_missing
from husky_driver.ros.mixture import others_that_command
from husky_driver.ros.progress import make_progress
from husky_driver.ros.readings import (
    has_orientation,
    read_imu_message,
    read_odometry,
    read_scan,
    time_of,
    wrong_imu,
    wrong_scan,
)
from husky_driver.ros.settings import refuse, Settings

TICK_SEC = 0.05  # wall time: progress, waiting and giving up
HINT_AFTER_SEC = 2.0
DELIVERY_SEC = 1.0  # how long the first command may take to arrive
# How long to wait for the robot to stand when the drive is broken off; it takes 0.33 s.
STOP_WITHIN_SEC = 1.0

DONE, GAVE_UP, INTERRUPTED, TERMINATED = 0, 1, 130, 143
SENSOR = QoSProfile(depth=50, reliability=ReliabilityPolicy.BEST_EFFORT)
RELIABLE = QoSProfile(depth=50)

Warn = Callable[[str], object]
ChooseDrive = Callable[[Settings, Warn], Drive]
CheckRoute = Callable[[Route, Settings, Warn], object]
"""Raises a ValueError when the settings say that a route must not be driven."""


def _check_nothing(_route: Route, _settings: Settings, _warn: Warn) -> None:
    pass


class FollowPath(Node):
    """Drives the Husky; `finished` becomes done with the exit code of the process."""

    def __init__(
        self, choose_drive: ChooseDrive, check_route: CheckRoute = _check_nothing, **arguments: Any
    ) -> None:
        """
        Read the parameters, choose the drive, and begin to listen to odometry.

        :param choose_drive: returns what to drive; it is given the settings, and a function
            that logs a warning. What it raises goes through.
        :param check_route: looks at the route of another file that is set on the way; when left
            out, any is driven.
        :param arguments: what `rclpy.node.Node` takes: context, parameter_overrides, ...
        :raises ValueError: for a parameter that does not exist or a value that is not allowed.
        """
        arguments.setdefault('automatically_declare_parameters_from_overrides', True)
        super().__init__('follow_path', **arguments)
        refuse_unknown(self.get_parameters_by_prefix(''), names_of(Settings))
        self.settings = declare_settings(self, Settings, refuse, files=('waypoints', 'world'))
        self.finished: Future[int] = Future()
        self._check_route = check_route
        self._drive = choose_drive(self.settings, self.get_logger().warning)
        self._display = DriveDisplay(self, self._drive)
        self._progress = make_progress(self.settings.progress, self.get_logger().info)
        self._pending: OdometryMsg | None = None  # to be answered when a subscriber takes commands
        self._last_stamp = NO_STAMP
        self._has_listener = False  # a subscriber takes the commands
        self._exit_code: int | None = None  # to leave with once the robot stands
        self._stop_deadline_sec = 0.0
        self._hint = ''
        self._paused = False
        self._obstacles: ObstacleStop | None = None
        if self.settings.scan:
            laser_x_m = self.settings.laser_ahead_m
            self._obstacles = ObstacleStop(self.settings.topics.scan, laser_x_m)
        self._silent_ticks = 0  # of the timer: while this process sleeps too, nothing is late
        self._imu: Subscription | None = None
        self._imu_wait = ImuWait(TICK_SEC)
        self._commands = Commands(self, self.settings.topics)
        self._odometry = self._subscribe()
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(TICK_SEC, self._on_tick, clock=steady)
        self.create_service(SetBool, '~/pause', self._on_pause)
        self.add_on_set_parameters_callback(self._on_parameters)

    def _subscribe(self) -> Subscription:
        """Return the subscription to the odometry that is followed."""
        topics = self.settings.topics
        if self.settings.odometry != 'filtered':
            # A simulator in lockstep waits for a subscriber of this topic.
            self.create_subscription(
                OdometryMsg, topics.odometry['filtered'], lambda _: None, 10, raw=True
            )
        if self.settings.imu:
            qos = RELIABLE if topics.has_reliable_imu else SENSOR
            self._imu = self.create_subscription(Imu, topics.imu, self._on_imu, qos)
        if self._obstacles is not None:
            watch = partial(self._on_scan, self._obstacles)
            self.create_subscription(LaserScan, topics.scan, watch, SENSOR)
        topic = self.settings.odometry_topic
        # No more: what is old is answered without seeing what the answers do.
        return self.create_subscription(OdometryMsg, topic, self._on_odometry, 10)

    def stop(self, exit_code: int, why: str) -> None:
        """Break the drive off: stop the robot, then finish with this exit code."""
        if self._exit_code is not None or self.finished.done():
            return
        self._exit_code = exit_code  # first: another signal may come while this is said
        self._stop_deadline_sec = time.monotonic() + STOP_WITHIN_SEC
        self._say(why, failed=True)
        self._drive.give_up(why)
        self._publish(0.0, 0.0)

    def _on_odometry(self, msg: OdometryMsg) -> None:
        stamp = (msg.header.stamp.sec, msg.header.stamp.nanosec)
        if stamp == self._last_stamp or self.finished.done():
            return
        if not self._has_listener:
            self._has_listener = self._commands.publisher.get_subscription_count() > 0
            if not self._has_listener:
                self._pending = msg
                return
        first = self._last_stamp == NO_STAMP
        if self._waits_for_imu(time_of(msg), first=first):
            self._pending = msg
            return
        self._pending = None
        self._last_stamp = stamp
        self._silent_ticks = 0
        odometry = self._relative(read_odometry(msg))
        if what := no_rotation(msg.pose.pose.orientation):
            self._drive.refuse_odometry(what)
        self._hold_for_obstacles(odometry.time_sec)
        command = self._drive.step(odometry)
        if self._drive.implausible and self._exit_code is None:
            self._stop_for_implausible(self.settings.odometry_topic)
        elif command is not None:
            self._publish(command.speed_m_s, command.yaw_rate_rad_s)
            if first:  # the publisher may have matched before the subscription has
                self._commands.publisher.wait_for_all_acked(Duration(seconds=DELIVERY_SEC))
        elif self._exit_code is not None:
            self._finish(self._exit_code)
        else:
            self._conclude()

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._paused = request.data
        self._hold()
        response.success = True
        response.message = 'paused' if self._paused else 'going on'
        self._say(f'{response.message}, {self._drive.remaining_m:.2f} m left')
        return response

    def _on_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        """Change to another waypoint file at once, or refuse it."""
        for parameter in parameters:
            if parameter.name == 'waypoints':
                if not parameter.value:  # else it would be the current folder
                    reason = "waypoints='': no file; give the path of one .yaml file"
                    return SetParametersResult(successful=False, reason=reason)
                try:
                    route = plan_route(load_course(str(parameter.value)))
                    self._progress.close()  # a warning has a line of its own
                    self._check_route(route, self.settings, self.get_logger().warning)
                except ValueError as error:
                    return SetParametersResult(successful=False, reason=str(error))
                self._drive = Drive(
                    route,
                    slip=self.settings.has_slip,
                    limits=self.settings.drive_limits,
                    before=self._drive,
                )
                self._display.show(self._drive)
                self._hold()
                self._say(f'going over to {parameter.value}')
        return SetParametersResult(successful=True)

    def _on_imu(self, msg: Imu) -> None:
        if not has_orientation(msg):
            return
        if what := wrong_imu(msg):
            self._refuse(self.settings.topics.imu, what)
        else:
            self._drive.add_imu(read_imu_message(msg, self.settings.imu_ahead_m))
            self._imu_wait.saw(time_of(msg))
            if self._pending is not None:
                self._on_odometry(self._pending)

    def _waits_for_imu(self, time_sec: float, *, first: bool) -> bool:
        if self._imu is None:
            return False
        publishers = self._imu.get_publisher_count() if first else 0
        waits = self._imu_wait.has_to_wait(time_sec, first=first, publishers=publishers)
        if first and self._imu_wait.is_missing:
            self._say(f'{self._imu.topic_name} is silent: how the robot slips is not learned')
        return waits

    def _refuse(self, topic: str, what: str) -> None:
        """Break the drive off, because a message of this topic cannot be true."""
        self._drive.refuse_odometry(what)
        if self._exit_code is None:
            self._stop_for_implausible(topic)

    def _stop_for_implausible(self, relative_topic: str) -> None:
        topic = self.resolve_topic_name(relative_topic)
        count = self.count_publishers(topic)
        whose = f'{count} nodes publish it' if count > 1 else 'who publishes it?'
        self.stop(
            GAVE_UP,
            f'gave up: {topic} cannot be true: {self._drive.implausible}; {whose}, '
            f'`ros2 topic info -v {topic}` names them',
        )

    def _on_scan(self, obstacles: ObstacleStop, msg: LaserScan) -> None:
        if what := wrong_scan(msg):
            self._refuse(self.settings.topics.scan, what)
        else:
            obstacles.add_scan(read_scan(msg), self._drive)

    def _hold_for_obstacles(self, now_sec: float) -> None:
        if self._obstacles is None or self._drive.implausible:
            return
        if news := self._obstacles.update(now_sec):
            self._say(news)
        if complaint := self._obstacles.complaint:
            self._drive.give_up(complaint)
        self._hold()

    def _hold(self) -> None:
        blocked = self._obstacles is not None and self._obstacles.holds
        self._drive.held = self._paused or blocked

    def _relative(self, odometry: Odometry) -> Odometry:
        """Return ground truth in the frame odom, which begins where the robot starts."""
        if self.settings.odometry != 'ground_truth':
            return odometry
        return relative_odometry(odometry, self.settings.start_pose)

    def _publish(self, speed_m_s: float, yaw_rate_rad_s: float) -> None:
        self._commands.publish(speed_m_s, yaw_rate_rad_s, self._last_stamp)

    def _conclude(self) -> None:
        drive = self._drive
        summary = drive.summary()
        if not drive.failure and drive.reached == drive.total:
            self._say(f'done: {summary}')
            self._finish(DONE)
            return
        tolerance = drive.course.tolerance_m
        missed = f'missed waypoints by more than {tolerance:g} m: {summary}'
        why = f'gave up: {drive.failure}' if drive.failure else missed
        others = others_that_command(self, self._commands.publisher)
        self._say('; '.join(filter(None, (why, others))), failed=True)
        self._finish(GAVE_UP)

    def _finish(self, exit_code: int) -> None:
        self._progress.close()
        self._display.update()
        if not self.finished.done():
            self.finished.set_result(exit_code)

    def _say(self, text: str, *, failed: bool = False) -> None:
        self._progress.close()
        if failed:  # on two lines: rclpy refuses two severities from one
            self.get_logger().error(text)
        else:
            self.get_logger().info(text)

    def _on_tick(self) -> None:
        """Show progress, wait, and give up when no odometry comes."""
        if self.finished.done():
            return
        self._silent_ticks += 1
        self._imu_wait.tick()
        if self._pending is not None and self._exit_code is None:
            self._on_odometry(self._pending)
        silent_sec = self._silent_ticks * TICK_SEC
        if self._exit_code is not None:
            gone = self._commands.publisher.get_subscription_count() == 0
            if gone or time.monotonic() > self._stop_deadline_sec:
                self._finish(self._exit_code)
            elif self._silent_ticks > 1:
                self._publish(0.0, 0.0)
        elif self._last_stamp == NO_STAMP:
            self._wait(silent_sec)
        elif silent_sec > self.settings.odometry_timeout_sec:
            self.stop(GAVE_UP, f'gave up: {self._silence(silent_sec)}')
        else:
            drive = self._drive
            self._display.update()
            note = f'waypoint {min(drive.reached + 1, drive.total)} of {drive.total}'
            self._progress.update(drive.length_m, drive.remaining_m, drive.elapsed_sec, note)

    def _wait(self, waited_sec: float) -> None:
        """Before the first answer: say what is missing, and give up in the end."""
        if self._pending is not None and self._has_listener:
            return  # for the IMU, not for long
        if waited_sec > self.settings.startup_timeout_sec:
            self.stop(GAVE_UP, f'gave up: {self._silence(waited_sec)}')
        elif waited_sec > HINT_AFTER_SEC and (missing := self._missing()) != self._hint:
            self._hint = missing
            self._say(f'waiting: {missing}')

    def _silence(self, waited_sec: float) -> str:
        return f'no odometry for {waited_sec:.0f} s; {self._missing()}'

    def _missing(self) -> str:
        return what_is_missing(self, self._odometry, self._commands.publisher)
