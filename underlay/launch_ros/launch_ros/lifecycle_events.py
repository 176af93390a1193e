# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Events to and from a running lifecycle node."""

from __future__ import annotations

import time
from typing import Any, TYPE_CHECKING

from launch.actions import OpaqueFunction
from launch.event_handler import EventHandler
from launch.launch_context import LaunchContext
from launch.logging import get_logger
from lifecycle_msgs.msg import TransitionEvent  # type: ignore[import-untyped]
from lifecycle_msgs.srv import ChangeState as ChangeStateService  # type: ignore[import-untyped]
from lifecycle_msgs.srv import GetState

from .events.lifecycle import ChangeState, StateTransition
from .ros_adapters import get_ros_node

if TYPE_CHECKING:
    from .actions import LifecycleNode

_POLL_SEC = 0.1
_ASK_AGAIN_SEC = 0.4
_FOUND_SEC = 5.0


class LifecycleEvents:
    """Turns transitions of a node into events, and ChangeState events into transitions.

    :param node_name: with its namespace.
    """

    def __init__(self, action: LifecycleNode, node_name: str, context: LaunchContext) -> None:
        self._action = action
        self._node_name = node_name
        self._context = context
        node = get_ros_node(context)
        self._subscription = node.create_subscription(
            TransitionEvent, f'{node_name}/transition_event', self._on_transition, 10
        )
        self._client = node.create_client(ChangeStateService, f'{node_name}/change_state')
        self._asking = node.create_client(GetState, f'{node_name}/get_state')
        context.register_event_handler(
            EventHandler(
                matcher=lambda event: isinstance(event, ChangeState),
                entities=OpaqueFunction(function=self._on_change_state),
            )
        )

    def _on_transition(self, message: Any) -> None:
        """Emit an event; called in the thread of the ROS node."""
        loop = self._context.asyncio_loop
        if loop is not None:
            event = StateTransition(action=self._action, msg=message)
            loop.call_soon_threadsafe(self._context.emit_event_sync, event)

    def _on_change_state(self, context: LaunchContext) -> None:
        event = context.locals.event
        if not event.lifecycle_node_matcher(self._action):
            return
        request = ChangeStateService.Request()
        request.transition.id = event.transition_id
        assert context.asyncio_loop is not None
        context.add_completion_future(
            context.asyncio_loop.run_in_executor(None, self._call, request)
        )

    def _is_reachable(self) -> bool:
        """Wait a little for the node: its service, and the publisher of its transitions."""
        if not self._client.wait_for_service(timeout_sec=_POLL_SEC):
            return False
        if get_ros_node(self._context).count_publishers(self._subscription.topic_name) > 0:
            return True
        time.sleep(_POLL_SEC)
        return False

    def _await_found(self) -> None:
        """Wait until the node has found what is here: it answers a client made after the others.

        On a busy machine it may be found before. Its transition would be heard by nobody then, and
        its answer be dropped: DDS announces endpoints in the order in which they were made. A node
        that does not answer is waited for no longer than 5 s.
        """
        futures: list[Any] = []

        def has_answered() -> bool:
            return any(future.done() for future in futures)

        end = time.monotonic() + _FOUND_SEC
        while not has_answered() and time.monotonic() < end:
            futures.append(self._asking.call_async(GetState.Request()))
            ask_again = time.monotonic() + _ASK_AGAIN_SEC
            while not has_answered() and time.monotonic() < ask_again:
                if self._context.is_shutdown:
                    return
                time.sleep(_POLL_SEC / 10)

    def _call(self, request: Any) -> None:
        """Call the service of the node; blocks, in a thread of its own, until the launch ends."""
        name = ChangeState.valid_transitions[request.transition.id]
        try:
            while not self._is_reachable():
                if self._context.is_shutdown:
                    return
            self._await_found()
            future = self._client.call_async(request)
            while not future.done():
                if self._context.is_shutdown:
                    return
                time.sleep(_POLL_SEC / 10)
            success = future.result().success
        except Exception as error:
            if self._context.is_shutdown:
                return
            raise RuntimeError(f"transition '{name}' of '{self._node_name}': {error}") from error
        if not success:
            get_logger('launch_ros.actions.lifecycle_node').error(
                f"Failed to make transition '{name}' for LifecycleNode '{self._node_name}'"
            )
