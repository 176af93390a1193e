# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Lines from the bytes that a process writes."""

from __future__ import annotations

import codecs
from collections.abc import Callable
import logging


class ProcessOutput:
    """Logs one stream of a process line by line.

    :param format_line: makes the logged text of a line.
    :param cached: keep everything for :attr:`text`.
    """

    def __init__(
        self, logger: logging.Logger, format_line: Callable[[str], str], *, cached: bool
    ) -> None:
        self.logger = logger
        self.format_line = format_line
        self._decoder = codecs.getincrementaldecoder('utf-8')('replace')
        self._rest = ''
        self._cache: list[str] | None = [] if cached else None

    @property
    def text(self) -> str:
        """Everything written so far; only where it is cached."""
        return ''.join(self._cache or ())

    def feed(self, data: bytes) -> None:
        text = self._decoder.decode(data)
        if self._cache is not None:
            self._cache.append(text)
        *lines, self._rest = (self._rest + text).split('\n')
        for line in lines:
            self.logger.info(self.format_line(line))

    def flush(self) -> None:
        """Log a last line without an end."""
        self._rest += self._decoder.decode(b'', True)
        if self._rest:
            self.logger.info(self.format_line(self._rest))
        self._rest = ''
