# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Options of upstream's that tune what only C++ has: what was typed for it works here as well."""

from __future__ import annotations

import argparse
from pathlib import Path

from ros2cli import arguments

_HELP = 'Accepted, and without effect here.'


def add_numbers(parser: argparse.ArgumentParser, *options: str) -> None:
    for option in options:
        parser.add_argument(option, type=int, metavar='N', help=_HELP)


def add_files(parser: argparse.ArgumentParser, *options: str) -> None:
    for option in options:
        parser.add_argument(option, type=_readable, metavar='FILE', help=_HELP)


def add_flags(parser: argparse.ArgumentParser, *options: str) -> None:
    arguments.add_flags(parser, dict.fromkeys(options, _HELP))


def _readable(text: str) -> Path:
    path = Path(text)
    try:
        path.open('rb').close()
    except OSError as error:
        raise argparse.ArgumentTypeError(f"cannot open '{text}': {error.strerror}") from None
    return path
