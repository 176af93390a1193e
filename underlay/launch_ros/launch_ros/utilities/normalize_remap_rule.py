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

    :raises TypeError: it is no tuple of two.
    """
    if not isinstance(remap_rule, tuple) or len(remap_rule) != 2:
        raise TypeError(f"a remapping is a tuple as ('from', 'to'), got {remap_rule!r}")
    source, target = remap_rule
    return (
        tuple(normalize_to_list_of_substitutions(source)),
        tuple(normalize_to_list_of_substitutions(target)),
    )


def normalize_remap_rules(remap_rules: Any) -> list[RemapRule]:
    if isinstance(remap_rules, str) or not isinstance(remap_rules, Iterable):
        raise TypeError(f"remappings are a list as [('from', 'to')], got {remap_rules!r}")
    return [normalize_remap_rule(rule) for rule in remap_rules]
