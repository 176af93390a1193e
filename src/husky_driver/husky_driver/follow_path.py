# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Drive the Husky along a waypoint file, or as asked at the terminal."""

from collections.abc import Callable, Sequence
from functools import partial
import signal
import sys
from types import FrameType

from husky_course.route import plan_route, Route
from husky_course.waypoints import load_course
from husky_runtime.command_line import BAD_INPUT
from husky_runtime.executor import spin
from husky_runtime.node_parser import NodeParser
from husky_runtime.settings import settings_of
from husky_runtime.start import SignalsHeldBack
import rclpy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from husky_driver.drive.drive import DistanceDrive, Drive
from husky_driver.prompt import ask_move
from husky_driver.ros.node import FollowPath, INTERRUPTED, TERMINATED
from husky_driver.ros.settings import Settings


class _Refused(Exception):
    """The node cannot start; the message is printed as it is."""


def main(args: Sequence[str] | None = None) -> int:
    argv = list(sys.argv if args is None else args)
    parser = NodeParser('follow_path', __doc__, settings_of(Settings))
    parser.add_argument('--waypoints', metavar='FILE', help='waypoint file (YAML) to follow')
    try:
        options = parser.parse_args(remove_ros_args(argv)[1:])
        return _run(_make_node(argv, options.waypoints))
    except KeyboardInterrupt:
        return INTERRUPTED
    except _Refused as error:
        print(error, file=sys.stderr)
        return BAD_INPUT
    finally:
        rclpy.try_shutdown()


def _make_node(argv: list[str], file: str | None) -> FollowPath:
    try:
        with SignalsHeldBack() as signals:
            # Our own handlers: rclpy's would take the publisher away before the robot has stopped.
            rclpy.init(args=argv, signal_handler_options=SignalHandlerOptions.NO)
            return FollowPath(partial(_choose_drive, signals, file), _check)
    except _Refused:
        raise
    except Exception as error:  # rcl raises many types for wrong arguments
        raise _Refused(f'follow_path: {" ".join(str(error).split())}') from None


def _choose_drive(
    signals: SignalsHeldBack, file: str | None, settings: Settings, warn: Callable[[str], object]
) -> Drive:
    """Return the drive of a waypoint file, or of the answers at the terminal."""
    file = file or settings.waypoints
    with signals.let_through():
        try:
            if file:
                return _drive_of(file, settings, warn)
            move = ask_move()
        except EOFError:
            print(flush=True)
            message = 'follow_path: nobody answers; give a file: --waypoints FILE'
            raise _Refused(message) from None
        except ValueError as error:
            raise _Refused(str(error)) from None
    return DistanceDrive(
        *(move.speed_m_s, move.distance_m), forward=move.forward, limits=settings.drive_limits
    )


def _drive_of(file: str, settings: Settings, warn: Callable[[str], object]) -> Drive:
    route = plan_route(load_course(file))
    _check(route, settings, warn)
    return Drive(route, slip=settings.has_slip, limits=settings.drive_limits)


def _check(route: Route, settings: Settings, warn: Callable[[str], object]) -> None:
    """
    Look for obstacles beside the route before anything moves.

    :raises ValueError: when the settings say that it must not be driven.
    """
    if settings.check == 'off':
        return
    with SignalsHeldBack():
        from husky_driver.route_check import near_passes
    near = near_passes(route, world=settings.world, start=settings.start_pose)
    for place in near:
        warn(f'{route.course.file}: {place}')
    if near and settings.check == 'refuse':
        raise ValueError(f'{route.course.file}: not driven, it passes too near to obstacles')


def _run(node: FollowPath) -> int:
    """Spin the node until it has finished; return its exit status."""

    def on_signal(number: int, _: FrameType | None) -> None:
        code = INTERRUPTED if number == signal.SIGINT else TERMINATED
        node.stop(code, f'stopped by {signal.Signals(number).name}')

    signal.signal(signal.SIGINT, on_signal)
    signal.signal(signal.SIGTERM, on_signal)
    try:
        spin(node, until=node.finished)
        return int(node.finished.result())
    finally:
        node.destroy_node()


if __name__ == '__main__':
    sys.exit(main())
