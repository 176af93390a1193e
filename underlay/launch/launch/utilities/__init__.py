# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What actions and substitutions share, under upstream's name of it."""

from .argument_types import create_future, ensure_argument_type
from .class_tools_impl import is_a, is_a_subclass, isclassinstance
from .normalizing import (
    normalize_to_list_of_entities,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from .signal_management import AsyncSafeSignalManager
from .visiting import visit_all_entities_and_collect_futures

__all__ = [
    'AsyncSafeSignalManager',
    'create_future',
    'ensure_argument_type',
    'is_a',
    'is_a_subclass',
    'isclassinstance',
    'normalize_to_list_of_entities',
    'normalize_to_list_of_substitutions',
    'perform_substitutions',
    'visit_all_entities_and_collect_futures',
]
