# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Command lines: wrong arguments are refused with one line and exit status 2."""

import argparse
from collections.abc import Callable, Sequence
import errno
from itertools import takewhile
import os
from pathlib import Path
import sys
from typing import NoReturn, TextIO

BAD_INPUT = 2
BROKEN_PIPE = 141  # the exit status of a program that SIGPIPE ends
_NOT_WRITTEN = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EFBIG)


class Parser(argparse.ArgumentParser):
    """Refuses with one line instead of the whole usage."""

    def error(self, message: str) -> NoReturn:
        # A shell that puts in the names of others' files gives what a terminal would obey.
        shown = ''.join(char if char.isprintable() else ascii(char)[1:-1] for char in message)
        self.exit(BAD_INPUT, f'{self.prog}: {shown}; see {self.prog} --help\n')

    def parse_in_any_order(self, args: Sequence[str] | None, words: str) -> argparse.Namespace:
        """
        Parse a list of words that may also stand on both sides of an option.

        argparse takes those of one place, and `parse_intermixed_args` none behind `--`.

        :param words: the attribute that they become.
        """
        for word in takewhile('--'.__ne__, sys.argv[1:] if args is None else args):
            # A shell makes it of `*`: who hands in a file --sandbox=none must not choose that.
            if word.startswith('-') and os.path.lexists(word):
                self.error(f"'{word}' is also the name of a file here: write ./{word} for that")
        options, more = self.parse_known_args(args)
        if any(word[:1] in ('', '-') for word in more):
            self.error(f'unrecognized arguments: {" ".join(more)}')
        getattr(options, words).extend(more)
        return options


def given_name(text: str) -> str:
    """
    Return the name of a file or folder, as the type of an argument.

    :raises ArgumentTypeError: if it is empty, which would be the current folder.
    """
    if not text:
        raise argparse.ArgumentTypeError('the name is empty')
    return text


def absolute_path(given: str) -> str:
    """
    Return the path of a file as it is from every folder; nothing stays nothing.

    A leading `~` is the home: behind `:=` and `=` no shell puts it in.
    """
    if not given:
        return ''
    home_put_in = os.path.expanduser(given)  # noqa: PTH111  # the other raises where there is none
    return str(Path(home_put_in).absolute())


def run_printing(prog: str, work: Callable[[], int]) -> int:
    """
    Do what prints; what it cannot print or write ends it with one line.

    :param work: returns the exit status.
    """
    try:
        status = work()
        sys.stdout.flush()
        return status
    except BrokenPipeError:
        return discard_output()
    except OSError as error:
        tell(f'{prog}: {why(error)}')
        discard_output()
        return BAD_INPUT


def tell(line: str) -> None:
    """Print a line on standard error; nothing where that cannot be written, either."""
    try:
        print(line, file=sys.stderr, flush=True)
    except OSError:
        discard(sys.stderr)


def why(error: OSError) -> str:
    """Return what went wrong, without the number of it."""
    place = error.filename
    if error.errno in _NOT_WRITTEN and error.filename2:
        place = error.filename2  # of a copy: who reads it knows where it comes from
    where = f'{place}: ' if place else ''
    return f'{where}{error.strerror or error}'


def discard_output() -> int:
    """Discard further output after its reader (`head`, `less`) has ended; return the status."""
    discard(sys.stdout)
    return BROKEN_PIPE


def discard(stream: TextIO) -> None:
    """Let go nowhere what a stream still holds: Python writes it at the end, and ends with 120."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
