# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Types of command-line arguments, with messages that say what is allowed."""

from __future__ import annotations

from argparse import ArgumentTypeError
import math
from typing import Any

import yaml

from ros2cli.errors import CommandError


def positive_float(text: str) -> float:
    number = _number(text)
    if not number > 0:
        raise ArgumentTypeError(f"'{text}' is refused: it must be a number above 0")
    return number


def nonnegative_float(text: str) -> float:
    number = _number(text)
    if not number >= 0:
        raise ArgumentTypeError(f"'{text}' is refused: it must be a number, 0 or more")
    return number


def positive_int(text: str) -> int:
    number = _whole(text)
    if number < 1:
        raise ArgumentTypeError(f"'{text}' is refused: it must be a whole number above 0")
    return number


def nonnegative_int(text: str) -> int:
    number = _whole(text)
    if number < 0:
        raise ArgumentTypeError(f"'{text}' is refused: it must be a whole number, 0 or more")
    return number


def yaml_mapping(text: str) -> dict[str, Any]:
    """Read the values of a message.

    :raises CommandError: the text is no YAML, or no dictionary.
    """
    values = yaml_value(text)
    if values is None:
        return {}
    if not isinstance(values, dict):
        raise CommandError(
            'The passed value needs to be a dictionary in YAML format: '
            f'"{{field: value}}"; {text!r} is a {type(values).__name__}'
        )
    return values


def yaml_value(text: str) -> Any:
    """Read one YAML value.

    :raises CommandError: the text is no YAML.
    """
    try:
        return yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError) as error:
        reason = ' '.join(str(error).split())
        raise CommandError(f'{text!r} is no YAML: {reason}') from None


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        return math.nan
    return number if math.isfinite(number) else math.nan


def _whole(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        return -1
