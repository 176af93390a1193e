# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Show which nodes talk to which over which topics."""

from __future__ import annotations

import argparse
from pathlib import Path
import sys

from live_page import read_port
from ros2cli.discovery import read_graph
from ros2cli.errors import CommandError

from rqt_graph.picture import draw_png, draw_svg, load_graphviz
from rqt_graph.selection import select, View

PICTURES = {'.svg': draw_svg, '.png': draw_png}


def parse_arguments(argv: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog='rqt_graph',
        description=f'{__doc__} Without --output it is shown live in the browser, on this '
        'computer only.',
    )
    parser.add_argument(
        '-o',
        '--output',
        type=_output_file,
        metavar='FILE',
        help='write the picture to this .svg or .png file and end',
    )
    parser.add_argument(
        '--view',
        choices=[view.value for view in View],
        default=View.ACTIVE.value,
        help='active: topics with a publisher and a subscriber; all: every topic (%(default)s)',
    )
    parser.add_argument(
        '--debug', action='store_true', help='show /rosout, /parameter_events, /clock and so on'
    )
    parser.add_argument('--port', type=read_port, help='port of the page; default: a free one')
    for ignored in ('--force-discover', '--clear-config', '--standalone', '-t'):
        parser.add_argument(ignored, action='store_true', help=argparse.SUPPRESS)
    return parser.parse_args(_without_ros_arguments(argv))


def main(argv: list[str] | None = None) -> int:
    """Write the picture, or show it until Ctrl-C."""
    args = parse_arguments(sys.argv[1:] if argv is None else argv)
    try:
        load_graphviz()
        if args.output is not None:
            return _write(args)
        return _show(args)
    except KeyboardInterrupt:
        return 0  # Ctrl-C is how the page ends
    except CommandError as error:
        print(f'rqt_graph: {error}', file=sys.stderr)
        return error.exit_status
    except OSError as error:
        print(f'rqt_graph: {error.strerror}: {error.filename or "the port"}', file=sys.stderr)
        return 2


def _write(args: argparse.Namespace) -> int:
    drawing = select(read_graph(), View(args.view), debug=args.debug)
    draw = PICTURES[args.output.suffix.lower()]
    args.output.write_bytes(draw(drawing))
    print(f'wrote {args.output}')
    return 0


def _show(args: argparse.Namespace) -> int:
    from rqt_graph.graph_page import GraphPage
    from rqt_graph.server import show

    query = ''.join((f'?view={args.view}', '&debug=shown' if args.debug else ''))
    show(
        GraphPage(),
        args.port,
        'rqt_graph: the live graph is at {} (Ctrl-C ends it)',
        query if query != '?view=active' else '',
    )
    return 0


def _output_file(text: str) -> Path:
    path = Path(text)
    if path.suffix.lower() not in PICTURES:
        raise argparse.ArgumentTypeError(
            f"'{text}' is refused: the name must end in .svg or .png, for example graph.svg"
        )
    if not path.parent.is_dir():
        raise argparse.ArgumentTypeError(
            f"'{text}' is refused: there is no folder '{path.parent}'; make it first"
        )
    return path


def _without_ros_arguments(argv: list[str]) -> list[str]:
    """Drop what is for a node: there is none here that could be renamed."""
    if '--ros-args' not in argv:
        return argv
    start = argv.index('--ros-args')
    rest = argv[start:]
    return argv[:start] + (rest[rest.index('--') + 1 :] if '--' in rest else [])


if __name__ == '__main__':
    sys.exit(main())
