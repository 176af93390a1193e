# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Please change the state of a lifecycle node."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from launch.event import Event
from lifecycle_msgs.msg import State, Transition  # type: ignore[import-untyped]

if TYPE_CHECKING:
    from ...actions import LifecycleNode


class ChangeState(Event):
    """Asks the lifecycle nodes that match to take a transition.

    :param transition_id: one of ``lifecycle_msgs.msg.Transition``.
    """

    name = 'launch_ros.events.lifecycle.ChangeState'

    valid_states = {
        getattr(State, name): name
        for name in (
            'PRIMARY_STATE_UNKNOWN',
            'PRIMARY_STATE_UNCONFIGURED',
            'PRIMARY_STATE_INACTIVE',
            'PRIMARY_STATE_ACTIVE',
            'PRIMARY_STATE_FINALIZED',
            'TRANSITION_STATE_CONFIGURING',
            'TRANSITION_STATE_CLEANINGUP',
            'TRANSITION_STATE_SHUTTINGDOWN',
            'TRANSITION_STATE_ACTIVATING',
            'TRANSITION_STATE_DEACTIVATING',
            'TRANSITION_STATE_ERRORPROCESSING',
        )
    }
    valid_transitions = {
        getattr(Transition, name): name
        for name in (
            'TRANSITION_CREATE',
            'TRANSITION_CONFIGURE',
            'TRANSITION_CLEANUP',
            'TRANSITION_ACTIVATE',
            'TRANSITION_DEACTIVATE',
            'TRANSITION_UNCONFIGURED_SHUTDOWN',
            'TRANSITION_INACTIVE_SHUTDOWN',
            'TRANSITION_ACTIVE_SHUTDOWN',
            'TRANSITION_DESTROY',
        )
    }

    def __init__(
        self, *, lifecycle_node_matcher: Callable[[LifecycleNode], bool], transition_id: int
    ) -> None:
        if transition_id not in self.valid_transitions:
            known = ', '.join(f'{key} ({name})' for key, name in self.valid_transitions.items())
            raise ValueError(f'transition_id={transition_id!r} is none of {known}')
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id
