# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Spawns a second turtle, which goes to where a frame is."""

from contextlib import suppress
import math
from typing import Any

from geometry_msgs.msg import Twist
import rclpy
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from tf2_ros import TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener
from turtlesim.srv import Spawn


class Follower(Node):
    """Looks up the frame as turtle2 sees it, and goes there."""

    def __init__(self) -> None:
        super().__init__('follower')
        target = self.declare_parameter('target', 'turtle1')
        self.target = target.get_parameter_value().string_value
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.spawner = self.create_client(Spawn, 'spawn')
        self.spawned: Future[Any] | None = None
        self.publisher = self.create_publisher(Twist, 'turtle2/cmd_vel', 1)
        self.timer = self.create_timer(0.2, self.on_timer)

    def on_timer(self) -> None:
        if self.spawned is None:
            if self.spawner.service_is_ready():
                request = Spawn.Request(name='turtle2', x=4.0, y=2.0, theta=0.0)
                self.spawned = self.spawner.call_async(request)
        elif self.spawned.done():
            self.follow()

    def follow(self) -> None:
        try:
            seen = self.buffer.lookup_transform('turtle2', self.target, Time())
        except TransformException as error:
            self.get_logger().info(f'no way from turtle2 to {self.target}: {error}')
            return
        place = seen.transform.translation
        command = Twist()
        command.angular.z = math.atan2(place.y, place.x)
        command.linear.x = 0.5 * math.hypot(place.x, place.y)
        self.publisher.publish(command)


def main() -> None:
    rclpy.init()
    with suppress(KeyboardInterrupt):
        rclpy.spin(Follower())
    rclpy.try_shutdown()
