# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Python expressions over a message, as the options --filter of several verbs take them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ros2cli.errors import CommandError, UsageError


def message_filter(text: str | None) -> Callable[[Any], bool]:
    """Compile the condition on the message `m`; no text keeps every message.

    :raises UsageError: it is no expression.
    """
    if text is None:
        return lambda _: True
    try:
        code = compile(text, '<filter>', 'eval')
    except (SyntaxError, ValueError) as error:
        raise UsageError(
            f"Invalid expression '{text}' in option --filter: {error}; an example is 'm.data > 3'"
        ) from None

    def keep(m: Any) -> bool:
        try:
            return bool(eval(code, {'m': m}))
        except Exception as error:
            raise CommandError(f"--filter '{text}' fails: {error}") from None

    return keep
