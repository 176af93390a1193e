# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A node that does with a real turtlesim what a student's node does."""

from collections.abc import Callable
import contextlib
import time
from typing import Any

from geometry_msgs.msg import Twist
import rclpy
from rclpy.action import ActionClient
from rclpy.action.client import ClientGoalHandle
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from rclpy.task import Future
from turtlesim.action import RotateAbsolute
from turtlesim.msg import Color, Pose


class TurtleClient:
    """Commands turtles and hears what they tell; waits for each answer."""

    def __init__(self) -> None:
        self._context = Context()
        rclpy.init(context=self._context)
        self.node = rclpy.create_node('student', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._heard: dict[str, Any] = {}  # the newest message, by topic
        self._made: dict[str, Any] = {}  # publishers, clients and subscriptions, by name
        self.feedback: list[float] = []

    def __enter__(self) -> 'TurtleClient':
        return self

    def __exit__(self, *_: object) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()

    def wait_for(
        self,
        fact: Callable[[], bool],
        what: str | Callable[[], str],
        *,
        timeout_sec: float = 20.0,
    ) -> None:
        """Spin until a fact is true; like `wait_until`, but wakes at every message."""
        deadline = time.monotonic() + timeout_sec
        while not fact():
            if time.monotonic() > deadline:
                words = what if isinstance(what, str) else what()
                raise AssertionError(f'not within {timeout_sec} s: {words}')
            self._executor.spin_once(timeout_sec=0.05)

    def result_of(self, future: 'Future[Any]', what: str) -> Any:
        self.wait_for(future.done, what)
        return future.result()

    def call(self, kind: Any, name: str, /, **fields: object) -> Any:
        """
        Call a service and return its response.

        A second time where none comes: a server that has not found within 0.1 s who reads its
        response, on a busy machine, drops it, and rclpy warns of a timeout.
        """
        if name not in self._made:
            self._made[name] = self.node.create_client(kind, name)
        client = self._made[name]
        self.wait_for(client.service_is_ready, f'the service {name}')
        calls = [client.call_async(kind.Request(**fields))]
        with contextlib.suppress(AssertionError):
            self.wait_for(calls[0].done, f'an answer of {name}', timeout_sec=5.0)
        if not calls[0].done():
            calls.append(client.call_async(kind.Request(**fields)))
        self.wait_for(lambda: any(call.done() for call in calls), f'an answer of {name}')
        return next(call.result() for call in calls if call.done())

    def command(self, turtle: str, x: float = 0.0, turn: float = 0.0, *, y: float = 0.0) -> None:
        """Publish a velocity, once the turtle listens."""
        topic = f'{turtle}/cmd_vel'
        if topic not in self._made:
            self._made[topic] = self.node.create_publisher(Twist, topic, 7)
        publisher = self._made[topic]
        self.wait_for(publisher.get_subscription_count, f'a subscription of {topic}')
        twist = Twist()
        twist.linear.x, twist.linear.y, twist.angular.z = x, y, turn
        publisher.publish(twist)

    def hears(self, kind: Any, topic: str) -> Any:
        """Return the next message of a topic."""
        if topic not in self._made:
            self._made[topic] = self.node.create_subscription(
                kind, topic, lambda message: self._heard.update({topic: message}), 7
            )
        self._heard.pop(topic, None)
        self.wait_for(lambda: topic in self._heard, f'a message of {topic}')
        return self._heard[topic]

    def pose(self, turtle: str = 'turtle1') -> Any:
        return self.hears(Pose, f'{turtle}/pose')

    def colour(self, turtle: str = 'turtle1') -> tuple[int, int, int]:
        seen = self.hears(Color, f'{turtle}/color_sensor')
        return seen.r, seen.g, seen.b

    def wait_for_pose(
        self, fact: Callable[[Any], bool], what: str, turtle: str = 'turtle1'
    ) -> Any:
        """Return the first pose of which a fact is true."""
        newest = self.pose(turtle)

        def comes() -> bool:
            nonlocal newest
            newest = self._heard[f'{turtle}/pose']
            return fact(newest)

        self.wait_for(comes, lambda: f'{what}; the last was {newest}')
        return newest

    def rotate(self, theta: float, turtle: str = 'turtle1') -> ClientGoalHandle:
        """Send a goal and return its handle; what is fed back is in `feedback`."""
        name = f'{turtle}/rotate_absolute'
        if name not in self._made:
            self._made[name] = ActionClient(
                *(self.node, RotateAbsolute, name), feedback_sub_qos_profile=QoSProfile(depth=1000)
            )
        client = self._made[name]
        self.wait_for(client.server_is_ready, f'the action {name}')
        self.feedback.clear()
        goal = client.send_goal_async(
            RotateAbsolute.Goal(theta=theta),
            feedback_callback=lambda told: self.feedback.append(told.feedback.remaining),
        )
        return self.result_of(goal, 'an answer to the goal')

    def end_of(self, goal: ClientGoalHandle) -> tuple[int, float]:
        """Return the status of a goal that has ended, and its result."""
        ended = self.result_of(goal.get_result_async(), 'the result of the goal')
        return ended.status, ended.result.delta
