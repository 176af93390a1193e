# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
# PYTHON_ARGCOMPLETE_OK
"""The `ros2` command line: find the command and the verb, import only these, run them."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
import contextlib
import os
import signal
import sys
import threading
from types import ModuleType

from interrupt_while_loading import leave

from ros2cli import nearest, verbs
from ros2cli.errors import CommandError

_COMMANDS = 'ros2cli.command'
_BROKEN_PIPE_STATUS = 128 + signal.SIGPIPE


def main(argv: Sequence[str] | None = None) -> int:
    """Run `ros2` with the given words (default: those of the process); return its exit status."""
    words = list(sys.argv[1:] if argv is None else argv)
    with _interrupt_ends():
        args = _read_line(words)
    run: Callable[[argparse.Namespace], int | str | None] | None = getattr(args, '_run', None)
    if run is None:
        args.parser_of_level.print_help()
        return 0
    try:
        return _run(run, args)
    except KeyboardInterrupt:
        return int(signal.SIGINT)


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


def _read_line(words: Sequence[str]) -> argparse.Namespace:
    parser = build_parser(_completed_words() if '_ARGCOMPLETE' in os.environ else words)
    if '_ARGCOMPLETE' in os.environ:
        import argcomplete

        argcomplete.autocomplete(parser, exclude=['-h', '--help'])
    args = parser.parse_args(words)
    if not args.use_python_default_buffering:
        # Whoever reads the output through a pipe wants each line when it is printed.
        sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    return args


def _run(run: Callable[[argparse.Namespace], int | str | None], args: argparse.Namespace) -> int:
    try:
        answer = run(args)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader (`head`, `less`) has seen enough; Python must not complain when it flushes.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _BROKEN_PIPE_STATUS
    except CommandError as error:
        print(error, file=sys.stderr)
        return error.exit_status
    except Exception as error:
        # A defect of a verb or of what it runs on: the person still gets one line.
        if os.environ.get('ROS2CLI_TRACEBACK'):
            raise
        text = ' '.join(str(error).split()) or 'no further explanation'
        print(f'{type(error).__name__}: {text} (ROS2CLI_TRACEBACK=1 shows where)', file=sys.stderr)
        return 1
    if isinstance(answer, str):
        print(answer, file=sys.stderr)
        return 1
    return answer or 0


def _completed_words() -> list[str]:
    """Return the words of the line that is being completed, without the last, unfinished one."""
    line = os.environ.get('COMP_LINE', '')[: int(os.environ.get('COMP_POINT', '0') or 0)]
    words = line.split(' ')
    return [word for word in words[1:-1] if word]


def build_parser(words: Sequence[str]) -> argparse.ArgumentParser:
    """Build the parser of a line; only what its words name is imported."""
    parser = argparse.ArgumentParser(
        prog='ros2',
        description='ros2 is an extensible command-line tool for ROS 2.',
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        '--use-python-default-buffering',
        action='store_true',
        help='Do not force line buffering in stdout and instead use the python default buffering',
    )
    parser.set_defaults(parser_of_level=parser)
    plain = [word for word in words if not word.startswith('-')]
    chosen = _add_level(parser, _COMMANDS, 'ros2', 'command', plain[0] if plain else None)
    if chosen is None:
        return parser
    name, command, command_parser = chosen
    _add_own_arguments(command, command_parser)
    if hasattr(command, '__path__'):
        command_parser.set_defaults(parser_of_level=command_parser)
        below = [word for word in words[words.index(name) + 1 :] if not word.startswith('-')]
        inner = _add_level(
            command_parser, command.__name__, f'ros2 {name}', 'verb', below[0] if below else None
        )
        if inner is not None:
            _add_own_arguments(inner[1], inner[2])
    return parser


def _add_own_arguments(module: ModuleType, parser: argparse.ArgumentParser) -> None:
    if hasattr(module, 'add_arguments'):
        module.add_arguments(parser)
    if hasattr(module, 'main'):
        parser.set_defaults(_run=module.main)


def _add_level(
    parser: argparse.ArgumentParser, package: str, cli_name: str, what: str, chosen: str | None
) -> tuple[str, ModuleType, argparse.ArgumentParser] | None:
    """Add one subparser a module of `package`; import only the module that was chosen."""
    names = verbs.names(package)
    modules = verbs.with_aliases(package)
    if chosen is not None and verbs.is_left_out(package, chosen):
        parser.exit(2, f'{cli_name} {chosen} is part of a full ROS 2 and left out here\n')
    if chosen is not None and chosen not in modules:
        parser.error(f"'{chosen}' is no {what} of {cli_name}{nearest.hint(chosen, modules)}")
    subparsers = parser.add_subparsers(
        title='Commands',
        description='\n'.join(
            f'{name:<{max(map(len, names))}}  {verbs.first_line(package, name)}' for name in names
        ),
        metavar=f'Call `{cli_name} <{what}> -h` for more detailed usage.',
    )
    found = None
    for name, module_name in modules.items():
        subparser = subparsers.add_parser(
            name,
            description=verbs.help_text(package, module_name) if name == chosen else None,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        if name == chosen:
            found = name, verbs.load(package, module_name), subparser
    return found


if __name__ == '__main__':
    sys.exit(main())
