# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Small nodes that the tests of the `ros2` command start as processes: nodes.py KIND NAME ..."""

from __future__ import annotations

from collections.abc import Generator
import itertools
import os
import signal
import struct
import sys
import time
from typing import Any

from example_interfaces.action import Fibonacci
from geometry_msgs.msg import TransformStamped, Twist, TwistStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
import rclpy
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.service import Service
from rclpy.service_introspection import ServiceIntrospectionState
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32, String
from std_srvs.srv import SetBool
from tf2_msgs.msg import TFMessage

BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def talker(node: Node) -> None:
    publisher = node.create_publisher(String, 'chatter', 10)
    count = 0

    def publish() -> None:
        nonlocal count
        count += 1
        publisher.publish(String(data=f'hello {count}'))

    node.create_timer(0.05, publish)


def listener(node: Node) -> None:
    # Deep enough for all that comes while a busy machine leaves this process waiting.
    node.create_subscription(String, 'chatter', lambda msg: print(f'heard {msg.data}'), 1000)


def listener_that_stops(node: Node) -> None:
    node.create_subscription(
        String, 'chatter', lambda _: os.kill(os.getpid(), signal.SIGSTOP), 1000
    )


def latched(node: Node) -> None:
    node.create_publisher(String, 'latched', LATCHED).publish(String(data='once'))


def hears_later(node: Node) -> None:
    node.create_subscription(String, 'latched', lambda msg: print(f'heard {msg.data}'), 10)


def widest(node: Node) -> None:
    largest = b'\x00\x01\x00\x00' + struct.pack('<f', float.fromhex('0x1.fffffep+127'))
    node.create_publisher(Float32, 'widest', LATCHED).publish(largest)


def best_effort(node: Node) -> None:
    publisher = node.create_publisher(String, 'chatter', BEST_EFFORT)
    node.create_timer(0.05, lambda: publisher.publish(String(data='maybe')))


def stamped(node: Node) -> None:
    publisher = node.create_publisher(TwistStamped, 'stamped', 10)

    def publish() -> None:
        msg = TwistStamped()
        msg.header.stamp = node.get_clock().now().to_msg()
        msg.twist.linear.x = 1.5
        publisher.publish(msg)

    node.create_timer(0.05, publish)


def unstamped(node: Node) -> None:
    publisher = node.create_publisher(TwistStamped, 'unstamped', 10)
    node.create_timer(0.05, lambda: publisher.publish(TwistStamped()))


def robot(node: Node) -> None:
    node.declare_parameter('command_timeout_sec', 0.25)
    node.create_subscription(Twist, 'cmd_vel', lambda _: None, 10)


def simulator(node: Node) -> None:
    publisher = node.create_publisher(Clock, '/clock', 10)
    node.create_publisher(Odometry, 'odometry/filtered', 10)
    node.create_timer(
        0.05, lambda: publisher.publish(Clock(clock=node.get_clock().now().to_msg()))
    )


def waiting_simulator(node: Node) -> None:
    node.declare_parameter('lockstep', False)
    node.create_publisher(Clock, '/clock', 10)


def slow_driver(node: Node) -> None:
    publisher = node.create_publisher(Twist, 'cmd_vel', 10)
    node.create_timer(0.5, lambda: publisher.publish(Twist()))


def wasteful_driver(node: Node) -> None:
    """Make again and again, as in a callback, what is to be made once."""
    for _ in range(12):
        node.create_publisher(Twist, 'cmd_vel', 10)
        ActionClient(node, Fibonacci, 'count')


def stamped_driver(node: Node) -> None:
    node.create_publisher(TwistStamped, 'cmd_vel', 10)


def service(node: Node) -> None:
    def on_flip(request: Any, response: Any) -> Any:
        response.success = request.data
        response.message = 'flipped'
        return response

    server = node.create_service(SetBool, 'flip', on_flip)
    server.configure_introspection(node.get_clock(), LATCHED, ServiceIntrospectionState.CONTENTS)


def forgetful(node: Node) -> None:
    """Return no response, at which rclpy ends the node."""
    node.create_service(SetBool, 'forget', lambda *_: None)


def waiting(node: Node) -> None:
    """Call a service of its own in a callback, while its only thread is in that callback."""
    service(node)
    client = node.create_client(SetBool, 'flip')
    node.create_timer(0.01, lambda: client.call(SetBool.Request()))


def sleeping(node: Node) -> None:
    """Sleep in a callback, as who takes it for a loop."""
    node.create_timer(0.1, lambda: time.sleep(1.0))


def parameters(node: Node) -> None:
    speed = FloatingPointRange(from_value=0.0, to_value=1.0)
    node.declare_parameter(
        'speed', 0.5, ParameterDescriptor(description='how fast', floating_point_range=[speed])
    )
    node.declare_parameter('wheel.radius', 3)
    node.declare_parameter('names', ['x', 'y'])
    node.declare_parameter('fixed', 'z', ParameterDescriptor(read_only=True))
    node.declare_parameter('loose', 1, ParameterDescriptor(dynamic_typing=True))


class _NextSpin:
    def __await__(self) -> Generator[None, None, None]:
        yield


def count(
    node: Node,
    *,
    stops_at: str = '',
    goal: GoalResponse = GoalResponse.ACCEPT,
    cancel: CancelResponse = CancelResponse.ACCEPT,
) -> None:
    """Offer an action that lasts until it is cancelled; the process stops when it is asked."""

    def reached(what: str) -> None:
        print(what, flush=True)
        if what == stops_at:
            os.kill(os.getpid(), signal.SIGSTOP)

    def on_goal(_: Any) -> GoalResponse:
        reached('goal')
        return goal

    def on_cancel(_: Any) -> CancelResponse:
        reached('cancel')
        return cancel

    async def execute(handle: Any) -> Any:
        while not handle.is_cancel_requested:
            await _NextSpin()
        handle.canceled()
        return Fibonacci.Result(sequence=[7])

    ActionServer(
        node, Fibonacci, 'count', execute, goal_callback=on_goal, cancel_callback=on_cancel
    )


def count_that_stops_at_goal(node: Node) -> None:
    count(node, stops_at='goal')


def count_that_stops_at_cancel(node: Node) -> None:
    count(node, stops_at='cancel')


def count_that_rejects(node: Node) -> None:
    count(node, stops_at='goal', goal=GoalResponse.REJECT)


def count_that_goes_on(node: Node) -> None:
    count(node, cancel=CancelResponse.REJECT)


def transforms(node: Node) -> None:
    node.create_subscription(TFMessage, '/tf', lambda _: None, 10)


def broadcaster(node: Node) -> None:
    """Stamp one frame by its own clock, one not at all, and give a third two parents."""
    publisher = node.create_publisher(TFMessage, '/tf', 10)
    parents = itertools.cycle(['odom', 'map'])

    def publish() -> None:
        frames = {
            name: TransformStamped(child_frame_id=name) for name in ('camera', 'lamp', 'base_link')
        }
        for name in ('camera', 'base_link'):
            frames[name].header.stamp = node.get_clock().now().to_msg()
        for name, parent in (('camera', 'base_link'), ('lamp', 'base_link')):
            frames[name].header.frame_id = parent
        frames['base_link'].header.frame_id = next(parents)
        publisher.publish(TFMessage(transforms=list(frames.values())))

    node.create_timer(0.05, publish)


def mover(node: Node) -> None:
    """Send base_link on /tf, each process another one."""
    publisher = node.create_publisher(TFMessage, '/tf', 10)
    base = TransformStamped(child_frame_id='base_link')
    base.header.frame_id = 'odom'
    base.transform.translation.x = float(os.getpid())

    def publish() -> None:
        base.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(TFMessage(transforms=[base]))

    node.create_timer(0.05, publish)


def lost_laser(node: Node) -> None:
    """Send scans of no frame, and read them."""
    publisher = node.create_publisher(LaserScan, 'scan', 10)
    node.create_subscription(LaserScan, 'scan', lambda _: None, 10)

    def publish() -> None:
        scan = LaserScan()
        scan.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(scan)

    node.create_timer(0.05, publish)


def torn(node: Node) -> None:
    """Send a frame that no listener takes."""
    arm = TransformStamped(child_frame_id='arm')
    arm.header.frame_id = 'base_link'
    arm.transform.translation.z = float('nan')
    publisher = node.create_publisher(TFMessage, '/tf', 10)
    node.create_timer(0.05, lambda: publisher.publish(TFMessage(transforms=[arm])))


def fixer(node: Node) -> None:
    """Send base_link on /tf_static, below a frame that is named as the node."""
    base = TransformStamped(child_frame_id='base_link')
    base.header.frame_id = node.get_name()
    node.create_publisher(TFMessage, '/tf_static', LATCHED).publish(TFMessage(transforms=[base]))


def odd_laser(node: Node) -> None:
    """Stamp scans by its own clock and with a frame that nobody has, and read them."""
    publisher = node.create_publisher(LaserScan, 'scan', 10)
    node.create_subscription(LaserScan, 'scan', lambda _: None, 10)

    def publish() -> None:
        scan = LaserScan()
        scan.header.frame_id = 'laser'
        scan.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(scan)

    node.create_timer(0.05, publish)


def plain(node: Node) -> None:
    del node


def loses_answers(node: Node) -> None:
    """Lose the first answer of each service, as rmw_fastrtps does where a client is found late."""
    node.declare_parameter('gain', 2.0)
    node.create_service(SetBool, 'flip', lambda _, response: response)
    lost: set[Service] = set()

    def send_response(service: Service, response: Any, header: Any) -> None:
        if service in lost:
            really_send(service, response, header)
        lost.add(service)

    really_send, Service.send_response = Service.send_response, send_response


managed = plain  # what is special of it is its class


def main() -> None:
    kind, name, *_ = sys.argv[1:]
    if user := os.environ.get('OF_USER'):  # what only root could read is loaded
        os.setuid(int(user))
    rclpy.init(args=sys.argv)
    node = (LifecycleNode if kind == 'managed' else Node)(name)
    globals()[kind](node)
    print('ready', flush=True)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
