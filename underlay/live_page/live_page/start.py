# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a program reads and opens for its page; the server itself takes long to load."""

from __future__ import annotations

import argparse
from collections.abc import Callable
import os
import subprocess
import sys
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from live_page.server import LivePage

_LIBRARIES = 'LD_LIBRARY_PATH'
_PORTS_TRIED = 20

Page = TypeVar('Page', bound='LivePage')


def serve_somewhere(make: Callable[[int], Page], port: int | None, *, first: int) -> Page:
    """
    Make a page at this port; None: at the first free one from `first` on.

    :raises OSError: the port is taken.
    """
    if port is not None:
        return make(port)
    for candidate in range(first, first + _PORTS_TRIED):
        try:
            return make(candidate)
        except OSError:
            continue
    return make(0)


def read_port(text: str) -> int:
    """
    Read the value of an option `--port`.

    :raises argparse.ArgumentTypeError: if it is no port.
    """
    if not (text.isascii() and text.isdecimal() and 1 <= int(text) <= 65535):
        raise argparse.ArgumentTypeError(f"'{text}' is refused: a port is from 1 to 65535")
    return int(text)


def open_on_a_desktop(address: str) -> None:
    """Open the browser where there is a desktop; returns at once."""
    if not (os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')):
        return
    # A browser must not get the libraries that the wheels of ROS bring.
    paths = os.environ.get(_LIBRARIES, '').split(':')
    others = ':'.join(path for path in paths if not path.startswith(sys.prefix))
    subprocess.Popen(
        [sys.executable, '-m', 'webbrowser', '-t', address],
        cwd='/',  # Python looks first where it starts, where a student may have a shlex.py
        env={**os.environ, _LIBRARIES: others},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,  # browsers say much
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # Ctrl-C ends the program, not the browser
    )
