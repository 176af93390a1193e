# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A launch file that cannot be read."""

from __future__ import annotations

from collections.abc import Sequence

from .source_location import located_error


class InvalidLaunchFileError(Exception):
    """Raised when no loader understands a launch file.

    :param extension: of the file, without the dot; '' where it says nothing.
    :param likely_errors: what the loaders said, the likeliest first.
    """

    def __init__(self, extension: str = '', *, likely_errors: Sequence[Exception]) -> None:
        self._extension = extension
        self._likely_errors = list(likely_errors)
        if not extension:
            self._error_message = (
                'The launch file may have a syntax error, or its format is unknown'
            )
        else:
            number = 'multiple exceptions' if len(self._likely_errors) > 1 else 'exception'
            self._error_message = (
                f'Caught {number} when trying to load file of format [{extension}]'
            )
        texts = [f'{type(error).__name__}: {error}' for error in self._likely_errors]
        between = ': ' if len(texts) == 1 else '\n - '
        self._error_message += ''.join(between + text for text in texts)
        super().__init__(self._error_message)
        if self._likely_errors:
            self.__cause__ = self._likely_errors[0]
            located_error(self, getattr(self._likely_errors[0], 'launch_location', None))

    def __str__(self) -> str:
        return self._error_message
