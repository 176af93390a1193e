# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""OpenCV, which is there where somebody has installed it."""

from __future__ import annotations

from typing import Any


def opencv() -> Any:
    """Return the module cv2.

    :raises ModuleNotFoundError: it is not installed; the message says how it is.
    """
    try:
        import cv2
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            f"{error}: the set-up of the lab leaves OpenCV out; in the lab's folder, `./lab exec "
            'pip install -c requirements/constraints.txt -r requirements/vision.in` installs it',
            name=error.name,
        ) from None
    return cv2
