# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate turtles and show them in the browser, on this computer only."""

from __future__ import annotations

import argparse
import os
import sys
import threading

from live_page import open_on_a_desktop, read_port, serve_somewhere
from node_program import own_words, refuse, run_node, spin
from rclpy.experimental import EventsExecutor

from turtlesim_programs.node import TurtlesimNode

WITHOUT_PAGE = ('offscreen', 'minimal')
"""Names of Qt's platforms that have no window; with upstream's turtlesim they do the same."""


def main(argv: list[str] | None = None) -> int:
    argv = sys.argv if argv is None else argv
    parser = argparse.ArgumentParser(
        prog='turtlesim_node', description=__doc__, allow_abbrev=False
    )
    parser.add_argument('--port', type=read_port, help='port of the page; default: a free one')
    parser.add_argument(
        *('-platform', '--platform'),
        default=os.environ.get('QT_QPA_PLATFORM', ''),
        metavar='NAME',
        help=f'{" or ".join(WITHOUT_PAGE)}: without the page; default: $QT_QPA_PLATFORM',
    )
    arguments = parser.parse_args(own_words(argv))

    def use(node: TurtlesimNode, stop: threading.Event) -> int:
        if arguments.platform not in WITHOUT_PAGE and not _serve(node, arguments.port):
            return refuse(
                f'turtlesim_node: --port {arguments.port} is taken: leave it out to get a free one'
            )
        return spin(node, stop, EventsExecutor())  # with many turtles half of the time

    return run_node(lambda _: TurtlesimNode(), argv, use)


def _serve(node: TurtlesimNode, port: int | None) -> bool:
    """Serve the page in threads that end with the process; tell whether the port was free."""
    # A server of HTTP takes a fifth of the time in which all the rest is loaded.
    from turtlesim_programs.page import FIRST_PORT, TurtlePage

    try:
        page = serve_somewhere(
            lambda number: TurtlePage(number, node.feed, node.frame.canvas.pixels),
            port,
            first=FIRST_PORT,
        )
    except OSError:
        return False
    threading.Thread(target=page.serve_forever, daemon=True, name='page').start()
    node.get_logger().info(f'The turtles are at {page.address} in the browser')
    open_on_a_desktop(page.address)
    return True


if __name__ == '__main__':
    sys.exit(main())
