# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments of the verbs: flags, numbers, and names for which the Tab key offers what there is."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping
import contextlib
import math
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:  # what Tab offers is looked for when it is pressed
    from rtps_graph.graph import Graph

# A parser, or a group of its arguments.
Parser = argparse._ActionsContainer


def add_flags(parser: Parser, flags: Mapping[str, str]) -> None:
    """Add options that take no value; given are their helps by their spellings, '-a --all'."""
    for spellings, text in flags.items():
        parser.add_argument(*spellings.split(), action='store_true', help=text)


# Numbers


def _number(
    kind: Callable[[str], float], allowed: str, is_allowed: Callable[[float], bool]
) -> Callable[[str], Any]:
    def parse(text: str) -> float:
        with contextlib.suppress(ValueError):
            number = kind(text)
            if is_allowed(number):
                return number
        raise argparse.ArgumentTypeError(f"'{text}' is refused: it must be {allowed}")

    return parse


finite_float = _number(float, 'a number', math.isfinite)
positive_float = _number(float, 'a number above 0', lambda number: 0 < number < math.inf)
nonnegative_float = _number(float, 'a number, 0 or more', lambda number: 0 <= number < math.inf)
positive_int = _number(int, 'a whole number above 0', lambda number: number > 0)
nonnegative_int = _number(int, 'a whole number, 0 or more', lambda number: number >= 0)

# Names


def add_completed(
    parser: Parser,
    name: str,
    choices: Callable[[argparse.Namespace], Iterable[str]],
    **options: Any,
) -> None:
    """Add an argument for which Tab offers what a function finds for the arguments so far."""

    def complete(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        try:
            return list(choices(parsed_args))
        except Exception:
            return []  # A completion has nowhere to say what went wrong.

    parser.add_argument(name, **options).completer = complete  # type: ignore[attr-defined]


def add_package(parser: Parser, **options: Any) -> None:
    def names(_: argparse.Namespace) -> list[str]:
        from ros2_diagnosis import packages

        return sorted(packages.installed())

    add_completed(parser, 'package_name', names, **options)


def add_topic(parser: Parser, name: str = 'topic_name', **options: Any) -> None:
    add_completed(parser, name, lambda _: _graph().topics(), **options)


def add_service(parser: Parser, **options: Any) -> None:
    add_completed(parser, 'service_name', lambda _: _graph().services(), **options)


def add_action(parser: Parser, **options: Any) -> None:
    add_completed(parser, 'action_name', lambda _: _graph().actions(), **options)


def add_node(parser: Parser, **options: Any) -> None:
    def names(_: argparse.Namespace) -> list[str]:
        return [node.full_name for node in _graph().nodes if not node.is_hidden]

    add_completed(parser, 'node_name', names, **options)


def add_type(parser: Parser, name: str, kind: str, **options: Any) -> None:
    """Add the name of an interface.

    :param kind: 'msg', 'srv', 'action', or '' for all.
    """

    def names(_: argparse.Namespace) -> list[str]:
        from ros2cli import interfaces

        return interfaces.known(kind)

    add_completed(parser, name, names, **options)


def add_values(parser: Parser, name: str, type_key: str, **options: Any) -> None:
    """Add a value in YAML; offered is the default one of the type, on one line, to be changed."""

    def prototype(args: argparse.Namespace) -> list[str]:
        import math

        from rosidl_runtime_py import message_to_yaml
        from rosidl_runtime_py.utilities import get_interface
        import yaml

        from ros2cli import interfaces

        filled_in = interfaces.filled_in(get_interface(getattr(args, type_key, None) or ''))
        values = yaml.safe_load(message_to_yaml(filled_in()))
        line = yaml.safe_dump(values, default_flow_style=True, sort_keys=False, width=math.inf)
        return [line.strip()]

    add_completed(parser, name, prototype, nargs='?', default='{}', **options)


def _graph() -> Graph:
    from ros2cli import discovery

    return discovery.read_graph()
