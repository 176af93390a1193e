# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The old name of the type of entities."""

from .some_entities_type import (
    SomeEntitiesType as SomeActionsType,
)
from .some_entities_type import (
    SomeEntitiesType_types_tuple as SomeActionsType_types_tuple,
)

__all__ = ['SomeActionsType', 'SomeActionsType_types_tuple']
