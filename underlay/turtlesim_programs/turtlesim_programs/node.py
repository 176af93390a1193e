# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node of the turtles: a doorway to the frame that they live in."""

from __future__ import annotations

from collections.abc import Callable
import math
from typing import Any

from rcl_interfaces.msg import IntegerRange, ParameterDescriptor, ParameterEvent
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_topic_name import validate_topic_name
from std_srvs.srv import Empty
from turtlesim.srv import Kill, Spawn

from turtlesim_programs.canvas import to_pixels
from turtlesim_programs.feed import Look, Picture, PictureFeed
from turtlesim_programs.frame import MIDDLE, TurtleError, TurtleFrame
from turtlesim_programs.motion import PERIOD_SEC
from turtlesim_programs.turtle_topics import TurtleTopics

STEPS_PER_PICTURE = 2
BACKGROUND = {'r': ('Red', 0x45), 'g': ('Green', 0x56), 'b': ('Blue', 0xFF)}
_LONGEST_TOPIC = 'rotate_absolute/_action/cancel_goal'


class TurtlesimNode(Node):
    """Turtles that move, draw and are asked and told over ROS; `feed` has their picture."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__('turtlesim', **arguments)
        self.feed = PictureFeed()
        self.frame = TurtleFrame()
        self._topics: dict[str, TurtleTopics] = {}
        self._is_new = True  # the picture has changed since it was shown
        self._steps = 0
        self._declare_parameters()
        for kind, name, answer in (
            (Empty, 'clear', self._on_clear),
            (Empty, 'reset', self._on_reset),
            (Spawn, 'spawn', self._on_spawn),
            (Kill, 'kill', self._on_kill),
        ):
            self.create_service(kind, name, answer)
        self.create_subscription(
            ParameterEvent, '/parameter_events', self._on_parameter_event, qos_profile_sensor_data
        )
        self.get_logger().info(
            f'Starting turtlesim with node name {self.get_fully_qualified_name()}'
        )
        self._spawn('', MIDDLE, MIDDLE, 0.0)
        self._show()
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(PERIOD_SEC, self._on_step, clock=steady)

    def _declare_parameters(self) -> None:
        channel = IntegerRange(from_value=0, to_value=255, step=1)
        for letter, (colour, default) in BACKGROUND.items():
            described = ParameterDescriptor(
                description=f'{colour} channel of the background color', integer_range=[channel]
            )
            self.declare_parameter(f'background_{letter}', default, described)
        described = ParameterDescriptor(description='If true, then turtles will be holonomic')
        self.declare_parameter('holonomic', False, described)

    def _now_sec(self) -> float:
        return float(self.get_clock().now().nanoseconds) * 1e-9

    def _on_step(self) -> None:
        for topics in self._topics.values():
            topics.before_step()
        for name, seen in self.frame.step(self._now_sec()).items():
            self._topics[name].after_step(seen)
            self._is_new |= seen.step.moved
        self._steps += 1
        if self._is_new and self._steps % STEPS_PER_PICTURE == 0:
            self._show()

    def _show(self) -> None:
        self._is_new = False
        red, green, blue = (self.get_parameter(f'background_{c}').value for c in BACKGROUND)
        looks = (
            Look(name, *to_pixels((turtle.x, turtle.y)), turtle.theta, self.frame.kinds[name])
            for name, turtle in sorted(self.frame.turtles.items())
        )
        self.feed.show(Picture((red, green, blue), tuple(looks)))

    def _on_parameter_event(self, event: ParameterEvent) -> None:
        self._is_new |= event.node == self.get_fully_qualified_name()

    def _on_clear(self, _: Empty.Request, response: Empty.Response) -> Empty.Response:
        self.get_logger().info('Clearing turtlesim.')
        self.frame.canvas.clear()
        self._is_new = True
        return response

    def _on_reset(self, _: Empty.Request, response: Empty.Response) -> Empty.Response:
        self.get_logger().info('Resetting turtlesim.')
        for topics in self._topics.values():
            topics.destroy()
        self._topics.clear()
        self.frame.reset()
        self._spawn('', MIDDLE, MIDDLE, 0.0)
        return response

    def _on_spawn(self, request: Spawn.Request, response: Spawn.Response) -> Spawn.Response:
        self._answer(lambda: setattr(response, 'name', self._spawn_asked(request)))
        return response

    def _on_kill(self, request: Kill.Request, response: Kill.Response) -> Kill.Response:
        self._answer(lambda: self._kill(request.name))
        return response

    def _answer(self, act: Callable[[], None]) -> None:
        """Do what was asked; of what is refused only the log tells, as upstream has it."""
        try:
            act()
        except TurtleError as error:
            self.get_logger().error(str(error))

    def _kill(self, name: str) -> None:
        self.frame.kill(name)
        self._topics.pop(name).destroy()
        self._is_new = True

    def _spawn_asked(self, request: Spawn.Request) -> str:
        self._check_name(request.name)
        if not all(map(math.isfinite, (request.x, request.y, request.theta))):
            raise TurtleError(
                f'A turtle cannot be put at x={request.x}, y={request.y}, '
                f'theta={request.theta}: it needs finite numbers'
            )
        return self._spawn(request.name, request.x, request.y, request.theta)

    def _check_name(self, name: str) -> None:
        """Refuse a name that cannot stand in those of topics; upstream ends there."""
        topic = f'{name or "turtle"}/{_LONGEST_TOPIC}'
        try:
            validate_topic_name(topic)
            full = expand_topic_name(topic, self.get_name(), self.get_namespace())
            validate_full_topic_name(full)
        except (InvalidTopicNameException, ValueError) as error:  # ValueError: an unknown {word}
            reason = str(error).splitlines()[0].partition(', at ')[0].rstrip(':')
            raise TurtleError(f'A turtle cannot be named [{name}]: {reason}') from None

    def _spawn(self, name: str, x: float, y: float, theta: float) -> str:
        name = self.frame.spawn(name, x, y, theta)
        self._topics[name] = TurtleTopics(self, name, self.frame.turtles[name], self._now_sec)
        self.get_logger().info(
            f'Spawning turtle [{name}] at x=[{x:f}], y=[{y:f}], theta=[{theta:f}]'
        )
        self._is_new = True
        return name
