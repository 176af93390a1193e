# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A node that publishes messages, answers a service and carries out an action."""

from every_kind_msgs.msg import Nested, Texts
import rclpy
from rclpy.action import ActionServer
from rclpy.action.server import ServerGoalHandle
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState
from tutorial_interfaces.action import Fibonacci
from tutorial_interfaces.msg import Sphere
from tutorial_interfaces.srv import AddThreeInts


class Shapes(Node):
    def __init__(self) -> None:
        super().__init__('shapes')
        self._nested = Nested(texts=[Texts(text='ä€')], spheres=[Sphere(radius=2.5)], last=9)
        self._spheres = self.create_publisher(Sphere, 'sphere', 10)
        self._everything = self.create_publisher(Nested, 'everything', 10)
        self.create_timer(0.1, self._on_timer)
        service = self.create_service(AddThreeInts, 'add_three_ints', self._on_add)
        service.configure_introspection(
            self.get_clock(), qos_profile_system_default, ServiceIntrospectionState.CONTENTS
        )
        self._server = ActionServer(self, Fibonacci, 'fibonacci', self._on_goal)

    def _on_timer(self) -> None:
        self._spheres.publish(self._nested.spheres[0])
        self._everything.publish(self._nested)

    def _on_add(
        self, request: AddThreeInts.Request, response: AddThreeInts.Response
    ) -> AddThreeInts.Response:
        response.sum = request.a + request.b + request.c
        return response

    def _on_goal(self, goal_handle: ServerGoalHandle) -> Fibonacci.Result:
        numbers = [0, 1]
        for _ in range(goal_handle.request.order):
            numbers.append(numbers[-1] + numbers[-2])
            goal_handle.publish_feedback(Fibonacci.Feedback(partial_sequence=numbers))
        goal_handle.succeed()
        return Fibonacci.Result(sequence=numbers)


def main() -> None:
    rclpy.init()
    try:
        node = Shapes()
        print('ready', flush=True)
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
