# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Draw the tree of frames that is being sent."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
import signal
import sys
import threading
import time

from live_page import read_port
from node_program import own_words
import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from ros2cli.errors import CommandError
from rqt_graph.picture import draw_text, load_graphviz
from tf2_msgs.srv import FrameGraph
from tf2_ros import Buffer, TransformListener

from tf2_tools.frames import generate_dot, read_frames

_INTERRUPTED = 130


def main() -> int:
    """Listen, write the picture and end; or show it live until Ctrl-C."""
    args = _parse(own_words(sys.argv))
    # Interrupts are Python's: the wait of an executor is short, and the page has no other.
    rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    node = Node('view_frames')
    try:
        load_graphviz()
        return _show(node, args.port) if args.live else _write(node, args)
    except KeyboardInterrupt:
        return 0 if args.live else _INTERRUPTED
    except CommandError as error:
        print(f'view_frames: {error}', file=sys.stderr)
        return error.exit_status
    except OSError as error:
        print(f'view_frames: {error.strerror}: {error.filename}', file=sys.stderr)
        return 2
    finally:
        rclpy.try_shutdown()


def _parse(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog='view_frames',
        description='Draw which frame hangs at which, as /tf and /tf_static say it.',
    )
    parser.add_argument(
        '--wait-time',
        '-t',
        type=_wait_time,
        default=5.0,
        help='seconds to listen before it is drawn (%(default)s)',
    )
    parser.add_argument(
        '-o',
        '--output',
        type=_output,
        help='name of the files, without .gv and .pdf; default: the time',
    )
    parser.add_argument(
        '--live', action='store_true', help='show the frames in the browser instead of in files'
    )
    parser.add_argument('--port', type=read_port, help='port of the page; default: a free one')
    return parser.parse_args(words)


def _write(node: Node, args: argparse.Namespace) -> int:
    logger = node.get_logger()
    buffer = Buffer(node=node)
    listener = TransformListener(buffer, node)
    logger.info(f'Listening to tf data for {args.wait_time} seconds...')
    interrupted = threading.Event()  # raised in a callback, an interrupt might be printed and lost
    before = signal.signal(signal.SIGINT, lambda *_: interrupted.set())
    end = time.monotonic() + args.wait_time
    while not interrupted.is_set() and (left_sec := end - time.monotonic()) > 0.0:
        rclpy.spin_once(node, timeout_sec=min(0.1, left_sec))
    signal.signal(signal.SIGINT, before)
    if interrupted.is_set():
        return _INTERRUPTED
    logger.info('Generating graph...')
    result = FrameGraph.Response(frame_yaml=buffer.all_frames_as_yaml())
    listener.unregister()
    logger.info(f'Result:{result}')
    name = args.output or time.strftime('frames_%Y-%m-%d_%H.%M.%S')
    logger.info(f'Exporting graph in {name}.pdf file...')
    now_sec = node.get_clock().now().nanoseconds * 1e-9
    text = generate_dot(read_frames(result.frame_yaml), now_sec)
    Path(f'{name}.gv').write_text(text)
    Path(f'{name}.pdf').write_bytes(draw_text(text, 'pdf'))
    logger.info('With --live the frames are shown in the browser instead.')
    return 0


def _show(node: Node, port: int | None) -> int:
    from rqt_graph.server import show

    from tf2_tools.frames_page import FramesPage

    buffer = Buffer()
    TransformListener(buffer, node, spin_thread=True)  # the node keeps it by its callbacks
    page = FramesPage(buffer.all_frames_as_yaml, node.context.get_domain_id())
    show(page, port, 'view_frames: the live frames are at {} (Ctrl-C ends it)')
    return 0


def _wait_time(text: str) -> float:
    try:
        wait_sec = float(text)
    except ValueError:
        wait_sec = math.nan
    if not 0.0 <= wait_sec < math.inf:
        raise argparse.ArgumentTypeError(f"'{text}' is refused: it must be seconds, 0 or more")
    return wait_sec


def _output(text: str) -> str:
    folder = Path(text).parent
    if not folder.is_dir():
        raise argparse.ArgumentTypeError(
            f"'{text}' is refused: there is no folder '{folder}'; make it first"
        )
    return text


if __name__ == '__main__':
    sys.exit(main())
