# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Questions to objects and classes, in the module that upstream has them in."""

from __future__ import annotations

import inspect


def isclassinstance(obj: object) -> bool:
    """Return whether an object is of a class: in Python 3, everything is."""
    return hasattr(obj, '__class__')


def is_a(obj: object, entity_type: type) -> bool:
    """Return whether an object is of the type or of one derived from it.

    :raises RuntimeError: ``entity_type`` is no class.
    """
    if not inspect.isclass(entity_type):
        raise RuntimeError(f'entity_type {entity_type!r} is not a class')
    return isinstance(obj, entity_type)


def is_a_subclass(obj: object, entity_type: type) -> bool:
    """Return whether an object or a class is of the type or one derived from it."""
    return is_a(obj, entity_type) or (inspect.isclass(obj) and issubclass(obj, entity_type))
