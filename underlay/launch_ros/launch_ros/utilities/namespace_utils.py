# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Namespaces and names of nodes."""

from __future__ import annotations

import re

_TOKEN = re.compile(r'[A-Za-z_][A-Za-z0-9_]*\Z')


def is_root_namespace(ns: str) -> bool:
    return ns == '/'


def is_namespace_absolute(ns: str) -> bool:
    return ns.startswith('/')


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Return a namespace below another one; an absolute one stays as it is.

    None is no namespace at all, '' the one that the node would have anyway.
    """
    if ns is None:
        joined = base_ns
    elif not base_ns or is_namespace_absolute(ns):
        joined = ns
    else:
        joined = f'{base_ns.rstrip("/")}/{ns}'
    if joined is None or is_root_namespace(joined):
        return joined
    return joined.rstrip('/')


def make_namespace_absolute(ns: str | None) -> str | None:
    if ns is None or is_namespace_absolute(ns):
        return ns
    return '/' + ns


def validate_node_name(name: str) -> None:
    """Check the name of a node.

    :raises ValueError: it is none.
    """
    if not _TOKEN.match(name):
        raise ValueError(
            f"node name '{name}' is refused: a name has letters, digits and _ only, and does not "
            'begin with a digit'
        )


def validate_namespace(namespace: str) -> None:
    """Check an absolute namespace.

    :raises ValueError: it is none.
    """
    tokens = namespace[1:].split('/') if namespace != '/' else []
    if not namespace.startswith('/') or not all(_TOKEN.match(token) for token in tokens):
        raise ValueError(
            f"namespace '{namespace}' is refused: its parts have letters, digits and _ only, do "
            'not begin with a digit and have one / between them'
        )
