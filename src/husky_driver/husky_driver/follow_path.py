# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Drive the Husky along a waypoint file, or as asked at the terminal."""

from __future__ import annotations

from collections.abc import Sequence
import signal
import sys
from types import FrameType

from husky_course.route import plan_route, Route
from husky_course.waypoints import load_course
from husky_runtime.command_line import BAD_INPUT, Parser
from husky_runtime.executor import make_executor
from husky_runtime.start import signals_held_back
import rclpy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from husky_driver.drive.distance_drive import DistanceDrive
from husky_driver.drive.drive import Drive
from husky_driver.prompt import ask_move
from husky_driver.ros.node import FollowPath, INTERRUPTED, TERMINATED


def main(args: Sequence[str] | None = None) -> int:
    argv = list(sys.argv if args is None else args)
    parser = Parser(prog='follow_path', allow_abbrev=False, description=__doc__)
    parser.add_argument('--waypoints', metavar='FILE', help='waypoint file (YAML) to follow')
    try:
        options = parser.parse_args(remove_ros_args(argv)[1:])
        with signals_held_back():
            # Our own handlers: rclpy's would take the publisher away before the robot has stopped.
            rclpy.init(args=argv, signal_handler_options=SignalHandlerOptions.NO)
            node = FollowPath()
    except KeyboardInterrupt:
        rclpy.try_shutdown()
        return INTERRUPTED
    except Exception as error:  # rcl raises many types for what a person can mistype
        return _refuse(' '.join(str(error).split()))
    try:
        return _run(node, options.waypoints or node.settings.waypoints)
    except KeyboardInterrupt:
        return INTERRUPTED
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def _refuse(message: str) -> int:
    print(f'follow_path: {message}', file=sys.stderr)
    return BAD_INPUT


def _run(node: FollowPath, waypoints: str) -> int:
    try:
        drive = _checked(node, plan_route(load_course(waypoints))) if waypoints else _ask()
    except EOFError:
        print(flush=True)
        return _refuse('nobody answers; give a file: --waypoints FILE')
    except ValueError as error:
        print(error, file=sys.stderr)
        return BAD_INPUT
    executor = make_executor()
    executor.add_node(node)
    node.start(drive)
    _stop_on_signals(node)
    while not node.finished.done():
        # Always with a timeout: without one rclpy 7.1.6's EventsExecutor never wakes up. A short
        # one, for it sees signals only between two spins.
        executor.spin_until_future_complete(node.finished, timeout_sec=0.2)
    executor.remove_node(node)
    return int(node.finished.result())


def _checked(node: FollowPath, route: Route) -> Drive:
    """
    Look for obstacles beside the route before anything moves.

    :raises ValueError: when the settings say that it must not be driven.
    """
    settings, log = node.settings, node.get_logger()
    if settings.check != 'off':
        with signals_held_back():
            from husky_driver.route_check import near_passes
        x, y, yaw = settings.start
        near = near_passes(route, world=settings.world, start=(x, y, yaw))
        for place in near:
            log.warning(f'{route.course.file}: {place}')
        if near and settings.check == 'refuse':
            raise ValueError(f'{route.course.file}: not driven, it passes too near to obstacles')
    return node.new_drive(route)


def _ask() -> Drive:
    move = ask_move()
    return DistanceDrive(move.speed_m_s, move.distance_m, forward=move.forward)


def _stop_on_signals(node: FollowPath) -> None:
    def on_signal(number: int, _frame: FrameType | None) -> None:
        code = INTERRUPTED if number == signal.SIGINT else TERMINATED
        node.stop(code, f'stopped by {signal.Signals(number).name}')

    signal.signal(signal.SIGINT, on_signal)
    signal.signal(signal.SIGTERM, on_signal)


if __name__ == '__main__':
    sys.exit(main())
