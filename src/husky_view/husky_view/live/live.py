# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Shows a running simulator in the browser, and whatever runs there after it."""

from __future__ import annotations

import sys

from husky_runtime.executor import future_of_signal, spin
from husky_sim.errors import SimulatorError
import rclpy
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
import viser

from husky_view.ending import end_soon
from husky_view.live.node import ViewNode
from husky_view.server import AddressError


def main(args: list[str] | None = None) -> int:
    """Show the simulation until interrupted."""
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    interrupted = future_of_signal()
    interrupted.add_done_callback(lambda _: end_soon())
    try:
        server: viser.ViserServer | None = None
        while True:
            node = ViewNode(server)
            _show_until(interrupted, node)
            if not node.another_runs:
                return 0
            server = node.server
    except (AddressError, SimulatorError) as error:
        print(f'view: {error}', file=sys.stderr)
        return 2
    finally:
        rclpy.try_shutdown()


def _show_until(interrupted: Future[None], node: ViewNode) -> None:
    interrupted.add_done_callback(lambda _: node.over.done() or node.over.set_result(None))
    try:
        spin(node, until=node.over)
    finally:
        node.destroy_node()


if __name__ == '__main__':
    sys.exit(main())
