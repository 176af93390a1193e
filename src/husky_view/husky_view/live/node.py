# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Show a running simulator in the browser, and those after it, as a ROS 2 node.

It asks the simulator for its world, so it can be started at any time, before or after it.
"""

from __future__ import annotations

from dataclasses import dataclass
import os
from pathlib import Path
import sys
from threading import Timer
import time
from typing import Any

from husky_runtime.executor import future_of_signal, spin
from husky_runtime.node_parser import NodeParser
from husky_runtime.parameters import declare_settings
from husky_runtime.settings import names_of, refuse_unknown, setting, settings_of
from husky_runtime.web_address import AddressError
from husky_sim.errors import refused, SettingError, SimulatorError
from husky_sim.world import load_world, World
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import NameValidationException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.utilities import remove_ros_args

from husky_view.editor.course import waypoint_folder
from husky_view.live.panel import warning_html
from husky_view.live.simulator import SimulatorQuery
from husky_view.live.view import LiveView
from husky_view.server import close_server, PageServer

TITLE = 'Husky playpen'
FIRST_TAB = 'the page is open'
"""drive.launch.py may wait for this line."""

_ASK_SEC = 0.05
_HINT_AFTER_SEC = 3.0
_EXIT_SEC = 0.7
"""Less than the second that a drive gives all that it has started."""


@dataclass(frozen=True, kw_only=True)
class ViewSettings:
    """What the view is told."""

    simulator: str = setting('husky_sim', 'Name of the simulator node to show.')
    viewer_host: str = setting(
        '127.0.0.1', 'Address to serve the page at; 0.0.0.0 lets others look.'
    )
    viewer_port: int = setting(8080, 'Port of the page; the next free one if it is taken.')
    viewer_names: str = setting(
        '', 'More names under which the page may be asked for, as of a proxy.'
    )
    waypoints_folder: str = setting(
        '', "Where the editor saves; empty: the workspace's config/waypoints."
    )


class ViewNode(Node):
    """Serves the page; `show_all` fills it with one simulation after the other."""

    def __init__(self) -> None:
        """
        Open the page.

        :raises AddressError: if the page cannot be served there.
        :raises SettingError: for a parameter that does not exist or a value that is not allowed.
        """
        super().__init__('husky_view', automatically_declare_parameters_from_overrides=True)
        try:
            refuse_unknown(self.get_parameters_by_prefix(''), names_of(ViewSettings))
        except ValueError as error:
            raise SettingError(str(error)) from None
        settings = declare_settings(self, ViewSettings, refused, files=('waypoints_folder',))
        self._looked_at = False
        self._query = SimulatorQuery(self, settings.simulator)
        self._folder = Path(settings.waypoints_folder or waypoint_folder())
        self._server = PageServer(
            settings.viewer_host,
            settings.viewer_port,
            title=TITLE,
            names=settings.viewer_names.split(),
        )
        self._server.on_client_connect(self._on_tab)

    def _on_tab(self, _: object) -> None:
        if not self._looked_at:
            self._looked_at = True
            print(FIRST_TAB, flush=True)

    def show_all(self, interrupted: Future[None]) -> None:
        """
        Show whatever the simulator runs, until interrupted.

        :raises SimulatorError: if the first world cannot be loaded, or is no simulator's.
        """
        world = self._wait_for_world(interrupted)
        is_stopped = False
        while world is not None:
            view = LiveView(
                *(self, self._server, self._query, world, self._folder), is_stopped=is_stopped
            )
            # Not to the log, which is a topic, too: the address has the token.
            print(f'look at {self._server.address}', flush=True)
            try:
                world = self._result_of(view.next_world, interrupted)
            finally:
                view.close()
            if world is not None:
                self._server.clear()  # from here on nobody can click
                view.hear_last_stop()
                is_stopped = view.is_stopped

    def _wait_for_world(self, interrupted: Future[None]) -> World | None:
        name = self._query.name
        waiting = self._server.gui.add_html(
            warning_html(f'Waiting for the simulator {name}: is it running?')
        )
        answered: Future[Any] = Future()
        hint_due_sec = time.monotonic() + _HINT_AFTER_SEC

        def on_ask() -> None:
            nonlocal hint_due_sec
            try:
                answer = self._query.poll()
            except SimulatorError as error:
                answered.set_exception(error)
                return
            if answer is not None and not answered.done():
                answered.set_result(answer)
            elif time.monotonic() > hint_due_sec:
                hint_due_sec = float('inf')
                self.get_logger().warning(
                    f'{name} does not answer yet: is the simulator running, with '
                    f'ROS_DOMAIN_ID={self.context.get_domain_id()} and '
                    f'RMW_IMPLEMENTATION={rclpy.get_rmw_implementation_identifier()} as here?'
                )

        timer = self.create_timer(_ASK_SEC, on_ask, clock=Clock(clock_type=ClockType.STEADY_TIME))
        answer = self._result_of(answered, interrupted)
        self.destroy_timer(timer)
        if answer is None:
            return None
        world = load_world(*answer)
        waiting.remove()
        return world

    def _result_of(self, future: Future[Any], interrupted: Future[None]) -> Any:
        """Spin until a future is done and return its result; None if interrupted before."""
        spin(self, until=future, or_until=interrupted)
        return future.result() if future.done() else None

    def destroy_node(self) -> None:
        """Close the page; may be called twice."""
        close_server(self._server)
        super().destroy_node()


def main(args: list[str] | None = None) -> int:
    """Show the simulation until interrupted."""
    words = remove_ros_args(sys.argv if args is None else args)[1:]
    NodeParser('view', __doc__, settings_of(ViewSettings)).parse_args(words)
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    interrupted = future_of_signal()
    interrupted.add_done_callback(lambda _: _exit_soon())
    try:
        node = ViewNode()
        try:
            node.show_all(interrupted)
        finally:
            node.destroy_node()
        return 0
    except (AddressError, SimulatorError, NameValidationException) as error:
        print(f'view: {" ".join(str(error).split())}', file=sys.stderr)
        return 2
    finally:
        rclpy.try_shutdown()


def _exit_soon() -> None:
    """End this process in time, even while it builds a page."""
    timer = Timer(_EXIT_SEC, os._exit, (0,))
    timer.daemon = True
    timer.start()


if __name__ == '__main__':
    sys.exit(main())
