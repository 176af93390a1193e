# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Anything that a launch description may hold."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class LaunchDescriptionEntity:
    """Base of launch descriptions and actions."""

    # File and line where it was written, for error messages.
    _location: tuple[str, int] | None = None

    def describe(self) -> str:
        raise NotImplementedError(f'{type(self).__name__} does not describe itself')

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that a visit yields for sure."""
        return []

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the entities that a visit may yield, with a text saying when."""
        return []

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Do what the entity is for and return what is to be visited next."""
        del context
        return None

    def _leave(self, context: LaunchContext) -> None:
        """Do what is left when all that the visit yielded has been visited."""

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return what is done when the entity is, or None when a visit was all."""
        return None
