# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""When a message is from."""

from __future__ import annotations

from typing import Any

from rclpy.clock import ROSClock
from rclpy.logging import get_logger
from rclpy.time import Time


class Stamps:
    """Finds the stamp of messages for one filter.

    :param logger: the name of the logger that says, once, that a message is left out.
    """

    def __init__(self, logger: str) -> None:
        self._logger = logger
        self._has_warned = False

    def of(self, msg: Any, allow_headerless: bool) -> Time | None:
        """Return the stamp; None: the message has none and is to be left out.

        :param allow_headerless: return the time of arrival where there is no stamp. That is the
            time of the wall also with `use_sim_time`, as upstream.
        """
        stamp = getattr(getattr(msg, 'header', None), 'stamp', None)
        if stamp is not None:
            return stamp if hasattr(stamp, 'nanoseconds') else Time.from_msg(stamp)
        if allow_headerless:
            return ROSClock().now()
        if not self._has_warned:
            self._has_warned = True
            get_logger(self._logger).warning(
                f'{type(msg).__name__} has no header.stamp: such messages are left out; '
                'allow_headerless=True takes the time at which they arrive'
            )
        return None
