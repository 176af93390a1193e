# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A DiagnosticStatus that is filled by methods."""

from __future__ import annotations

from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue


class DiagnosticStatusWrapper(DiagnosticStatus):
    """
    What a task fills in.

    :param kwds: fields of the message.
    """

    def __init__(self, *args: Any, **kwds: Any) -> None:
        super().__init__(*args, **kwds)

    def summary(self, *args: Any) -> None:
        """
        Set level and message.

        :param args: another status to take them of, or a level and a message.
        """
        self.level, message = _level_and_message('summary', args)
        self.message = str(message)

    def clearSummary(self) -> None:
        self.summary(DiagnosticStatus.OK, '')

    def mergeSummary(self, *args: Any) -> None:
        """
        Take another summary in: the worse level counts, and a good message gives way to a bad one.

        Two good messages, or two bad ones, stand one after the other.

        :param args: as of `summary`.
        """
        level, message = _level_and_message('mergeSummary', args)
        if (level > DiagnosticStatus.OK) == (self.level > DiagnosticStatus.OK):
            self.message = f'{self.message}; {message}' if self.message else message
        elif level > self.level:
            self.message = message
        self.level = max(self.level, level)

    def add(self, key: str, val: str) -> None:
        """
        Append a pair to the values.

        :raises TypeError: one of them is no text.
        """
        for text in (key, val):
            if not isinstance(text, str):
                raise TypeError(
                    f'add({key!r}, {val!r}): {text!r} is no text; write str({text!r}), or format '
                    'it'
                )
        self.values.append(KeyValue(key=key, value=val))


def _level_and_message(method: str, args: tuple[Any, ...]) -> tuple[bytes, str]:
    if len(args) == 1:
        return args[0].level, args[0].message
    if len(args) == 2:
        return args
    raise TypeError(f'{method} takes a status, or a level and a message, not {len(args)} values')
