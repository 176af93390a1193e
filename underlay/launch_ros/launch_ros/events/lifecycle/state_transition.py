# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A lifecycle node has changed its state."""

from __future__ import annotations

from typing import Any, TYPE_CHECKING

from launch.event import Event

if TYPE_CHECKING:
    from ...actions import LifecycleNode


class StateTransition(Event):
    """Emitted when a lifecycle node has taken a transition.

    :param msg: a ``lifecycle_msgs.msg.TransitionEvent``.
    """

    name = 'launch_ros.events.lifecycle.StateTransition'

    def __init__(self, *, action: LifecycleNode, msg: Any) -> None:
        self.action = action
        self.msg = msg

    @property
    def timestamp(self) -> int:
        return int(self.msg.timestamp)

    @property
    def transition(self) -> str:
        return str(self.msg.transition.label)

    @property
    def start_state(self) -> str:
        return str(self.msg.start_state.label)

    @property
    def goal_state(self) -> str:
        return str(self.msg.goal_state.label)
