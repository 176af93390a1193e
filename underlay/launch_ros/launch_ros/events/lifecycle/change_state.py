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
        State.PRIMARY_STATE_UNKNOWN: 'unknown',
        State.PRIMARY_STATE_UNCONFIGURED: 'unconfigured',
        State.PRIMARY_STATE_INACTIVE: 'inactive',
        State.PRIMARY_STATE_ACTIVE: 'active',
        State.PRIMARY_STATE_FINALIZED: 'finalized',
        State.TRANSITION_STATE_CONFIGURING: 'configuring',
        State.TRANSITION_STATE_CLEANINGUP: 'cleaningup',
        State.TRANSITION_STATE_SHUTTINGDOWN: 'shuttingdown',
        State.TRANSITION_STATE_ACTIVATING: 'activating',
        State.TRANSITION_STATE_DEACTIVATING: 'deactivating',
        State.TRANSITION_STATE_ERRORPROCESSING: 'errorprocessing',
    }
    valid_transitions = {
        Transition.TRANSITION_CREATE: 'create',
        Transition.TRANSITION_CONFIGURE: 'configure',
        Transition.TRANSITION_CLEANUP: 'cleanup',
        Transition.TRANSITION_ACTIVATE: 'activate',
        Transition.TRANSITION_DEACTIVATE: 'deactivate',
        Transition.TRANSITION_UNCONFIGURED_SHUTDOWN: 'unconfigured_shutdown',
        Transition.TRANSITION_INACTIVE_SHUTDOWN: 'inactive_shutdown',
        Transition.TRANSITION_ACTIVE_SHUTDOWN: 'active_shutdown',
        Transition.TRANSITION_DESTROY: 'destroy',
    }

    def __init__(
        self, *, lifecycle_node_matcher: Callable[[LifecycleNode], bool], transition_id: int
    ) -> None:
        if transition_id not in self.valid_transitions:
            known = ', '.join(f'{key} ({name})' for key, name in self.valid_transitions.items())
            raise ValueError(f'transition_id={transition_id!r} is none of {known}')
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id
