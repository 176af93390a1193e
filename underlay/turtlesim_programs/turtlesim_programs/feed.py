# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the page is to show, handed from the node's thread to those of the pages."""

from __future__ import annotations

from dataclasses import dataclass
import threading

from turtlesim_programs.motion import Colour


@dataclass(frozen=True)
class Look:
    """A turtle in the picture, in pixels from the top left."""

    name: str
    x: float
    y: float
    theta: float
    kind: int


@dataclass(frozen=True)
class Picture:
    """All that is drawn above and below the lines."""

    background: Colour
    turtles: tuple[Look, ...]


class PictureFeed:
    """The newest picture."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._picture: Picture | None = None
        self._version = 0

    def show(self, picture: Picture) -> None:
        """Wake every page: this, or the lines under it, is new."""
        with self._changed:
            self._picture = picture
            self._version += 1
            self._changed.notify_all()

    def wait(self, seen: int, timeout_sec: float) -> tuple[int, Picture | None]:
        """Return the picture and its version, as soon as it is newer than the one seen."""
        with self._changed:
            self._changed.wait_for(lambda: self._version > seen, timeout_sec)
            return self._version, self._picture
