# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node: it answers every odometry message with one command, which a `Drive` decides."""

from __future__ import annotations

import os
import sys
import time
from typing import Any

from geometry_msgs.msg import Twist
from husky_course.route import plan_route, Route
from husky_course.waypoints import load_course
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

from husky_driver.checks.lookout import BLIND_SEC, Lookout
from husky_driver.checks.plausibility import no_rotation
from husky_driver.drive.drive import Drive
from husky_driver.drive.slip import NO_SLIP
from husky_driver.motion import Odometry, relative_odometry
from husky_driver.ros.display import DriveDisplay
from husky_driver.ros.parameters import declare_settings
from husky_driver.ros.progress import Progress
from husky_driver.ros.readings import (
    has_orientation,
    read_acceleration,
    read_odometry,
    read_scan,
    time_of,
    wrong_imu,
    wrong_scan,
)
from husky_driver.ros.settings import ODOMETRY_TOPICS

TICK_SEC = 0.05  # wall time: progress, waiting and giving up
HINT_AFTER_SEC = 2.0
DELIVERY_SEC = 1.0  # how long the first command may take to whom it was sent
STOP_WITHIN_SEC = (
    1.0  # how long a robot is waited for when the drive is broken off: it takes a third
)

DONE, GAVE_UP, INTERRUPTED, TERMINATED = 0, 1, 130, 143
NO_STAMP = (-1, -1)
SENSOR = QoSProfile(depth=50, reliability=ReliabilityPolicy.BEST_EFFORT)


class FollowPath(Node):
    """Drives the Husky; `finished` becomes done with the exit code of the process."""

    def __init__(self, **arguments: Any) -> None:
        arguments.setdefault('automatically_declare_parameters_from_overrides', True)
        super().__init__('follow_path', **arguments)
        self.settings = declare_settings(self)
        self.finished: Future[int] = Future()
        self._pending: OdometryMsg | None = None
        self._last_stamp = NO_STAMP
        self._listened = False  # somebody takes our commands
        self._stopping: int | None = None  # the exit code to leave with, once it stands
        self._stop_deadline_sec = 0.0
        self._hint = ''
        self._origin: Odometry | None = None
        self._paused = False
        self._lookout = Lookout() if self.settings.scan else None
        self._command = Twist()
        topic = 'husky_velocity_controller/cmd_vel'
        self._commands = self.create_publisher(Twist, topic, 10)

    def new_drive(self, route: Route) -> Drive:
        """Return a drive of a route as the settings want it."""
        slips = self.settings.slip and self.settings.odometry != 'ground_truth'
        return Drive(route, slip=None if slips else NO_SLIP)

    def start(self, drive: Drive) -> None:
        """Begin to listen to odometry and to drive."""
        self._drive = drive
        self._display = DriveDisplay(self, drive)
        mode = self.settings.progress
        bar = mode == 'bar' or (mode == 'auto' and sys.stdout.isatty())
        line = (lambda _: None) if mode == 'off' else self.get_logger().info
        self._progress = Progress(sys.stdout, line, bar=bar)
        self._begun_sec = self._heard_sec = time.monotonic()
        topic = self.settings.odometry_topic
        self._odometry = self.create_subscription(OdometryMsg, topic, self._on_odometry, 10)
        if self.settings.odometry != 'filtered':
            # A simulator in lockstep waits until somebody reads this one.
            self.create_subscription(
                OdometryMsg, ODOMETRY_TOPICS['filtered'], lambda _: None, 10, raw=True
            )
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = self.create_timer(TICK_SEC, self._on_tick, clock=steady)
        self.create_service(SetBool, '~/pause', self._on_pause)
        self.add_on_set_parameters_callback(self._on_parameters)
        if self.settings.imu:
            self._imu = self.create_subscription(Imu, 'imu/data', self._on_imu, SENSOR)
        if self._lookout is not None:
            self._scans = self.create_subscription(LaserScan, 'front/scan', self._on_scan, SENSOR)

    def stop(self, exit_code: int, why: str) -> None:
        """Break the drive off: stop the robot, then finish with this exit code."""
        if self._stopping is not None or self.finished.done():
            return
        self._say(why, failed=True)
        self._stopping = exit_code
        self._stop_deadline_sec = time.monotonic() + STOP_WITHIN_SEC
        self._drive.give_up(why)
        self._publish(0.0, 0.0)

    def _on_odometry(self, msg: OdometryMsg) -> None:
        stamp = (msg.header.stamp.sec, msg.header.stamp.nanosec)
        if stamp == self._last_stamp or self.finished.done():
            return
        if not self._listened:
            self._listened = self._commands.get_subscription_count() > 0
            if not self._listened:
                self._pending = msg  # answered as soon as somebody listens
                return
        first = self._last_stamp == NO_STAMP
        self._pending = None
        self._last_stamp = stamp
        self._heard_sec = time.monotonic()
        odometry = self._relative(read_odometry(msg))
        if what := no_rotation(msg.pose.pose.orientation):
            self._drive.disbelieve(what)
        self._look_out(odometry.time_sec)
        command = self._drive.step(odometry)
        if self._drive.nonsense and self._stopping is None:
            self._stop_for_nonsense(self._odometry)
        elif command is not None:
            self._publish(command.speed_m_s, command.yaw_rate_rad_s)
            if first:  # DDS may know a listener before the listener knows us
                self._commands.wait_for_all_acked(Duration(seconds=DELIVERY_SEC))
        elif self._stopping is not None:
            self._finish(self._stopping)
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
        """Go over to another waypoint file at once, unless there is something wrong with it."""
        for parameter in parameters:
            if parameter.name == 'waypoints':
                try:
                    route = plan_route(load_course(str(parameter.value)))
                except ValueError as error:
                    return SetParametersResult(successful=False, reason=str(error))
                self._drive = self.new_drive(route)
                self._display.show(self._drive)
                self._hold()
                self._say(f'going over to {parameter.value}')
        return SetParametersResult(successful=True)

    def _stop_for_nonsense(self, heard: Subscription) -> None:
        """Stop at once, for what was heard cannot be true."""
        topic = heard.topic_name
        count = self.count_publishers(topic)
        whose = f'{count} nodes publish it' if count > 1 else 'who publishes it?'
        self.stop(
            GAVE_UP,
            f'gave up: {topic} cannot be true: {self._drive.nonsense}; {whose}, '
            f'`ros2 topic info -v {topic}` names them',
        )

    def _on_imu(self, msg: Imu) -> None:
        if not has_orientation(msg):
            return
        if what := wrong_imu(msg):
            self._disbelieve(self._imu, what)
        else:
            self._drive.feel(time_of(msg), read_acceleration(msg))

    def _disbelieve(self, heard: Subscription, what: str) -> None:
        self._drive.disbelieve(what)
        if self._stopping is None:
            self._stop_for_nonsense(heard)

    def _on_scan(self, msg: LaserScan) -> None:
        if self._lookout is None:
            return
        drive = self._drive
        if what := wrong_scan(msg):
            self._disbelieve(self._scans, what)
            return
        scan = read_scan(msg)
        now, tracker = drive.odometry, drive.tracker
        if now is not None and scan.time_sec > now.time_sec + BLIND_SEC:
            return  # from before a reset; it would hide that no scan comes any more
        if now is None or tracker is None or tracker.reverse:
            self._lookout.pass_over(scan)
            return
        pose = (now.x_m, now.y_m, now.yaw_rad)
        # One that stands looks further than one that drives: else it would creep on.
        going_on = drive.course.speed_m_s + 0.1 if self._lookout.holds else 0.0
        speed = max(drive.speed_m_s, going_on)
        self._lookout.look(scan, pose, tracker.curve, tracker.s, speed)

    def _look_out(self, now_sec: float) -> None:
        if self._lookout is None or self._drive.nonsense:
            return
        if news := self._lookout.news(now_sec):
            self._say(news)
        if complaint := self._lookout.complaint:
            self._drive.give_up(complaint)
        self._hold()

    def _hold(self) -> None:
        blocked = self._lookout is not None and self._lookout.holds
        self._drive.held = self._paused or blocked

    def _relative(self, odometry: Odometry) -> Odometry:
        """Let the frame begin where the robot starts, as that of odometry does by itself."""
        if self.settings.odometry != 'ground_truth':
            return odometry
        if self._origin is None:
            self._origin = odometry
        return relative_odometry(odometry, self._origin)

    def _publish(self, speed_m_s: float, yaw_rate_rad_s: float) -> None:
        self._command.linear.x = speed_m_s
        self._command.angular.z = yaw_rate_rad_s
        self._commands.publish(self._command)

    def _conclude(self) -> None:
        drive = self._drive
        summary = drive.summary()
        if drive.failure:
            self._say(f'gave up: {drive.failure}', failed=True)
            self._finish(GAVE_UP)
        elif drive.reached == drive.total:
            self._say(f'done: {summary}')
            self._finish(DONE)
        else:
            tolerance = drive.course.tolerance_m
            self._say(f'missed waypoints by more than {tolerance:g} m: {summary}', failed=True)
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
        """Look after what no odometry message will tell."""
        now = time.monotonic()
        if self.finished.done():
            return
        if self._stopping is not None:
            gone = self._commands.get_subscription_count() == 0
            if gone or now > self._stop_deadline_sec:
                self._finish(self._stopping)
            elif now - self._heard_sec > TICK_SEC:
                self._publish(0.0, 0.0)
        elif self._last_stamp == NO_STAMP:
            self._wait(now - self._begun_sec)
        elif now - self._heard_sec > self.settings.odometry_timeout_sec:
            self.stop(GAVE_UP, f'gave up: {self._silence(now - self._heard_sec)}')
        else:
            drive = self._drive
            self._display.update()
            note = f'waypoint {min(drive.reached + 1, drive.total)} of {drive.total}'
            self._progress.update(drive.length_m, drive.remaining_m, drive.elapsed_sec, note)

    def _wait(self, waited_sec: float) -> None:
        """Before the first answer: say what is missing, and give up in the end."""
        if self._pending is not None:
            self._on_odometry(self._pending)
        elif waited_sec > self.settings.startup_timeout_sec:
            self.stop(GAVE_UP, f'gave up: {self._silence(waited_sec)}')
        elif waited_sec > HINT_AFTER_SEC and (missing := self._missing()) != self._hint:
            self._hint = missing
            self._say(f'waiting: {missing}')

    def _silence(self, waited_sec: float) -> str:
        return f'no odometry for {waited_sec:.0f} s; {self._missing()}'

    def _missing(self) -> str:
        domain = os.environ.get('ROS_DOMAIN_ID', '0')
        where = f'is the simulator running, with ROS_DOMAIN_ID={domain} as here?'
        if self._odometry.get_publisher_count() == 0:
            return f'nobody publishes {self._odometry.topic_name}; {where}'
        if self._commands.get_subscription_count() == 0:
            return f'nobody listens to {self._commands.topic_name}; {where}'
        return f'{self._odometry.topic_name} is silent; is the simulation paused?'
