# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Serve the picture: each page is told of the pixels that it does not have yet."""

from __future__ import annotations

import base64
from dataclasses import astuple
from pathlib import Path

from live_page.server import KEEP_ALIVE_SEC, LivePage, PageHandler, Query
import numpy as np

from turtlesim_programs.canvas import NOTHING, Pixels
from turtlesim_programs.feed import PictureFeed

FIRST_PORT = 8110
_PAGE = Path(__file__).with_name('page.html')


class TurtlePage(LivePage):
    """The page of a turtlesim."""

    def __init__(self, port: int, feed: PictureFeed, pixels: Pixels) -> None:
        self.feed, self.pixels = feed, pixels
        super().__init__(port, _Handler)


class _Handler(PageHandler):
    server: TurtlePage

    def answer(self, path: str, query: Query) -> None:
        match path:
            case '/':
                self.send('text/html; charset=utf-8', _PAGE.read_bytes())
            case '/events':
                self._send_changes()
            case _:
                super().answer(path, query)

    def _send_changes(self) -> None:
        self.begin_events()
        shown = np.full_like(self.server.pixels, NOTHING)
        seen = 0
        while True:
            version, picture = self.server.feed.wait(seen, KEEP_ALIVE_SEC)
            if version == seen or picture is None:
                self.send_sign_of_life()
                continue
            seen, pixels = version, self.server.pixels.copy()
            self.send_event(
                {
                    'background': picture.background,
                    'turtles': [astuple(turtle) for turtle in picture.turtles],
                    'pixels': encode_changes(shown, pixels),
                }
            )
            shown = pixels


def encode_changes(before: Pixels, after: Pixels) -> str:
    """Return the places of all pixels that have changed, then their values, in base64."""
    places = np.flatnonzero(before != after)
    words = np.concatenate([places, after.ravel()[places]])
    return base64.b64encode(words.astype('<u4').tobytes()).decode()
