# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
# PYTHON_ARGCOMPLETE_OK
"""The `ros2` command line: find the command and the verb, import only these, run them."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
import contextlib
import functools
import gc
import os
import signal
import sys
import threading

from interrupt_while_loading import leave
from ros2_diagnosis import PackageError

from ros2cli.command import add_subparsers_on_demand, CommandExtension, CommandLineParser
from ros2cli.errors import CommandError

_Build = Callable[[Sequence[str]], argparse.ArgumentParser]
_BROKEN_PIPE_STATUS = 128 + signal.SIGPIPE
# Between two collections of garbage: more than any verb loads, and 700 is Python's own.
_OBJECTS = 100_000


def main(
    argv: Sequence[str] | None = None,
    *,
    script_name: str = 'ros2',
    description: str | None = None,
    extension: CommandExtension | None = None,
) -> int:
    """Run `ros2` with the given words (default: those of the process); return its exit status.

    :param extension: the only command, of a program `script_name` of its own.
    """
    build = functools.partial(
        build_parser, script_name=script_name, description=description, extension=extension
    )
    gc.set_threshold(_OBJECTS)
    _open_closed_streams()
    try:
        return _run(build, list(sys.argv[1:] if argv is None else argv))
    except KeyboardInterrupt:
        return int(signal.SIGINT)
    finally:
        gc.freeze()  # the last collection, of a process that ends, would look at all there is


def _open_closed_streams() -> None:
    """Open what is closed (`>&-`): what is printed would go into the next file that is opened."""
    for number, name in enumerate(('stdin', 'stdout', 'stderr')):
        if getattr(sys, name) is None and os.open(os.devnull, os.O_RDWR) == number:
            os.set_inheritable(number, True)
            setattr(sys, name, os.fdopen(number, 'w' if number else 'r', encoding='utf-8'))


@contextlib.contextmanager
def _interrupt_ends() -> Iterator[None]:
    """While a verb is loaded nothing is open yet: let an interrupt end the process at once."""
    before = signal.getsignal(signal.SIGINT)
    if before is not signal.SIG_IGN and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, leave)
    try:
        yield
    finally:
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGINT, before)


def _read_line(build: _Build, words: Sequence[str]) -> argparse.Namespace:
    parser = build(_completed_words() if '_ARGCOMPLETE' in os.environ else words)
    if '_ARGCOMPLETE' in os.environ:
        import argcomplete

        argcomplete.autocomplete(parser, exclude=['-h', '--help'])
    args = parser.parse_args(words)
    if not args.use_python_default_buffering:
        # Whoever reads the output through a pipe wants each line when it is printed.
        sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    return args


def _run(build: _Build, words: Sequence[str]) -> int:
    try:
        with _interrupt_ends():
            args = _read_line(build, words)
        command: CommandExtension | None = getattr(args, '_command', None)
        if command is None:
            args.parser.print_help()
            return 0
        answer = command.main(parser=args._command_parser, args=args)
        sys.stdout.flush()
    except BrokenPipeError:
        _discard_output()  # the reader (`head`, `less`) has closed the pipe
        return _BROKEN_PIPE_STATUS
    except CommandError as error:
        print(error, file=sys.stderr)
        return error.exit_status
    except PackageError as error:
        print(error, file=sys.stderr)
        return 1
    except Exception as error:
        # A defect of a verb or of what it runs on: the person still gets one line.
        if os.environ.get('ROS2CLI_TRACEBACK'):
            raise
        if isinstance(error, OSError):
            _flush_or_discard()
        text = ' '.join(str(error).split()) or 'no further explanation'
        print(f'{type(error).__name__}: {text} (ROS2CLI_TRACEBACK=1 shows where)', file=sys.stderr)
        return 1
    if isinstance(answer, str):
        print(answer, file=sys.stderr)
        return 1
    return answer or 0


def _flush_or_discard() -> None:
    try:
        sys.stdout.flush()
    except OSError:  # the disk is full
        _discard_output()


def _discard_output() -> None:
    """Let Python not try again at its end, and complain, to write what cannot be written."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _completed_words() -> list[str]:
    """Return the words of the line that is being completed, without the last, unfinished one."""
    line = os.environ.get('COMP_LINE', '')[: int(os.environ.get('COMP_POINT', '0') or 0)]
    words = line.split(' ')
    return [word for word in words[1:-1] if word]


def build_parser(
    words: Sequence[str],
    *,
    script_name: str = 'ros2',
    description: str | None = None,
    extension: CommandExtension | None = None,
) -> argparse.ArgumentParser:
    """Build the parser of a line; only what its words name is imported."""
    parser = CommandLineParser(
        prog=script_name,
        description=description or f'{script_name} is an extensible command-line tool for ROS 2.',
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        '--use-python-default-buffering',
        action='store_true',
        help='Do not force line buffering in stdout and instead use the python default buffering',
    )
    parser.words = words
    parser.set_defaults(parser=parser)
    if extension is not None:
        parser.set_defaults(_command=extension, _command_parser=parser)
        extension.add_arguments(parser, script_name)
        return parser
    add_subparsers_on_demand(
        parser,
        script_name,
        '_command',
        'ros2cli.command',
        hide_extensions=['extension_points', 'extensions'],
        required=False,
    )
    return parser


if __name__ == '__main__':
    sys.exit(main())
