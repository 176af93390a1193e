# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Log handlers whose format depends on the logger."""

from __future__ import annotations

import contextlib
import logging
import sys
from typing import Any


class FormatPerLogger(logging.Handler):
    """Mixes a formatter a logger into a handler."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._formatters: dict[str, logging.Formatter] = {}

    def setFormatterFor(self, logger: logging.Logger, formatter: logging.Formatter) -> None:  # noqa: N802
        self._formatters[logger.name] = formatter

    def getFormatterFor(self, logger: logging.Logger) -> logging.Formatter | None:  # noqa: N802
        return self._formatters.get(logger.name, self.formatter)

    def unsetFormatterFor(self, logger: logging.Logger) -> None:  # noqa: N802
        self._formatters.pop(logger.name, None)

    def format(self, record: logging.LogRecord) -> str:
        formatter = self._formatters.get(record.name)
        return super().format(record) if formatter is None else formatter.format(record)


class StreamHandler(FormatPerLogger, logging.StreamHandler):  # type: ignore[type-arg]
    """Writes to a stream."""


class ScreenHandler(FormatPerLogger):
    """Writes to whatever is standard output at the moment, whatever its encoding."""

    _fails = False

    def emit(self, record: logging.LogRecord) -> None:
        text = self.format(record) + '\n'
        encoding = getattr(sys.stdout, 'encoding', None) or 'utf-8'
        try:
            sys.stdout.write(text.encode(encoding, 'replace').decode(encoding))
            sys.stdout.flush()
        except (BrokenPipeError, ValueError):
            # The reader has gone (`ros2 launch ... | head`): the nodes go on, unseen.
            return
        except OSError as error:
            # They go on, too, where a disk is full, or end in order where the terminal is closed.
            if not self._fails:
                self._fails = True
                _tell('standard output', error)


class FileHandler(FormatPerLogger, logging.FileHandler):
    """Writes to a file, made with the first line, while the disk has room for it."""

    def __init__(self, filename: str, *, encoding: str = 'utf-8') -> None:
        super().__init__(filename, encoding=encoding, delay=True)
        self._fails = False

    def emit(self, record: logging.LogRecord) -> None:
        try:
            super().emit(record)
        except OSError:  # it cannot be made
            self.handleError(record)

    def handleError(self, record: logging.LogRecord) -> None:  # noqa: N802
        error = sys.exc_info()[1]
        if not isinstance(error, OSError):
            super().handleError(record)
        elif not self._fails:
            self._fails = True
            _tell(self.baseFilename, error)

    def close(self) -> None:
        with contextlib.suppress(OSError):  # said above
            super().close()


def _tell(place: str, error: OSError) -> None:
    with contextlib.suppress(OSError):  # that may be the same terminal, or disk
        print(
            f'cannot write {place} ({error.strerror}): what the launch says is missing there from '
            'here on',
            file=sys.stderr,
        )


def __getattr__(name: str) -> type[logging.Handler]:
    """Make any other handler of ``logging`` and ``logging.handlers`` with a format per logger."""
    import logging.handlers

    base = getattr(logging.handlers, name, None) or getattr(logging, name, None)
    if not isinstance(base, type) or not issubclass(base, logging.Handler):
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    made = type(name, (FormatPerLogger, base), {'__doc__': base.__doc__})
    globals()[name] = made
    return made
