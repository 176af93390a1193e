# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Remappings from whatever the user wrote."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch.utilities import normalize_to_list_of_substitutions

from ..remap_rule_type import RemapRule


def normalize_remap_rule(remap_rule: Any) -> RemapRule:
    """Return a pair of substitutions.

    :raises TypeError: it is no pair.
    """
    if isinstance(remap_rule, str) or not isinstance(remap_rule, Iterable):
        raise TypeError(f"a remapping is a pair as ('from', 'to'), got {remap_rule!r}")
    pair = tuple(remap_rule)
    if len(pair) != 2:
        raise TypeError(f"a remapping is a pair as ('from', 'to'), got {pair!r}")
    return (
        tuple(normalize_to_list_of_substitutions(pair[0])),
        tuple(normalize_to_list_of_substitutions(pair[1])),
    )


def normalize_remap_rules(remap_rules: Any) -> list[RemapRule]:
    if isinstance(remap_rules, str) or not isinstance(remap_rules, Iterable):
        raise TypeError(f"remappings are a list as [('from', 'to')], got {remap_rules!r}")
    return [normalize_remap_rule(rule) for rule in remap_rules]
