# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Visiting a tree of entities."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from ..launch_description_entity import LaunchDescriptionEntity
from ..source_location import attach_location

if TYPE_CHECKING:
    from ..launch_context import LaunchContext

_Pairs = list[tuple[LaunchDescriptionEntity, 'asyncio.Future[None]']]


def visit_all_entities_and_collect_futures(
    entity: LaunchDescriptionEntity, context: LaunchContext
) -> _Pairs:
    """Visit an entity and, depth first, what it yields; return what is still under way.

    An error that passes through is told the line of the launch file it came from.
    """
    pairs: _Pairs = []
    try:
        sub_entities = entity.visit(context)
    except Exception as error:
        attach_location(error, entity._location)
        raise
    future = entity.get_asyncio_future()
    if future is not None:
        pairs.append((entity, future))
    for sub_entity in sub_entities or ():
        if not isinstance(sub_entity, LaunchDescriptionEntity):
            failure = TypeError(
                f'{sub_entity!r} is not a launch action or description, but '
                f'{type(entity).__name__} yields it'
            )
            attach_location(failure, entity._location)
            raise failure
        pairs.extend(visit_all_entities_and_collect_futures(sub_entity, context))
    entity._leave(context)
    return pairs
