# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What Tab offers, as objects that upstream's packages set as `completer` of an argument."""

from __future__ import annotations

import argparse
from typing import Any

from ros2cli import discovery, interfaces


class NameCompleter:
    """Offers the topics, services or actions (`kind`) that there are.

    :param hidden_key: where the arguments say whether hidden ones count too.
    """

    def __init__(self, kind: str, hidden_key: str | None = None) -> None:
        self._kind = kind
        self._hidden_key = hidden_key

    def __call__(self, prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        graph = discovery.read_graph(parsed_args, quiet=True)
        hidden = getattr(parsed_args, self._hidden_key or '', False)
        return list(discovery.by_kind(graph, self._kind, hidden=hidden))


class TypeCompleter:
    """Offers the types of the topic, service or action that was named; else all that exist.

    :param name_key: where the arguments hold the name.
    """

    def __init__(self, kind: str, name_key: str | None) -> None:
        self._kind = kind
        self._name_key = name_key

    def __call__(self, prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        name = getattr(parsed_args, self._name_key or '', None)
        if name is not None:
            graph = discovery.read_graph(parsed_args, quiet=True)
            if types := discovery.by_kind(graph, self._kind).get(name):
                return types
        return known_types(self._kind)


class PrototypeCompleter:
    """Offers a message, request or goal with its default values.

    :param type_key: where the arguments hold the type.
    """

    def __init__(self, type_key: str | None) -> None:
        self._type_key = type_key

    def __call__(self, prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        from rosidl_runtime_py import message_to_yaml
        from rosidl_runtime_py.utilities import get_interface

        interface = get_interface(getattr(parsed_args, self._type_key or ''))
        return [message_to_yaml(interfaces.filled_in(interface)())]


def known_types(kind: str) -> list[str]:
    """List the installed types of topics, services or actions."""
    return interfaces.known({'topic': 'msg', 'service': 'srv', 'action': 'action'}[kind])
