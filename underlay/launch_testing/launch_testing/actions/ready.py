# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Say that the tests may start."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
import logging

from launch import Action, LaunchContext, LaunchDescriptionEntity

_logger = logging.getLogger(__name__)


class ReadyToTest(Action):
    """Tells the tests of a launch that they may start."""

    def __init__(self) -> None:
        super().__init__()
        self._callbacks: list[Callable[[], object]] = []

    def _add_callback(self, callback: Callable[[], object]) -> None:
        self._callbacks.append(callback)

    def execute(self, context: LaunchContext) -> None:
        for callback in self._callbacks:
            try:
                callback()
            except Exception as error:
                _logger.error(error)


def find_ready_to_test(entities: Iterable[LaunchDescriptionEntity]) -> Iterator[ReadyToTest]:
    """Yield each ReadyToTest among entities and whatever these may lead to."""
    for entity in entities:
        if isinstance(entity, ReadyToTest):
            yield entity
        yield from find_ready_to_test(entity.describe_sub_entities())
        for _, conditional in entity.describe_conditional_sub_entities():
            yield from find_ready_to_test(conditional)
