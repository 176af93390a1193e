# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the Tab key offers for the arguments of the verbs."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable
from typing import Any

from ros2_diagnosis import packages
from rtps_graph.graph import Graph


def package(action: argparse.Action) -> None:
    attach(action, lambda _: sorted(packages.installed()))


def executable(action: argparse.Action) -> None:
    attach(action, lambda args: [p.name for p in packages.executables(args.package_name)])


def launch_file(action: argparse.Action) -> None:
    def names(args: argparse.Namespace) -> list[str]:
        return [p.name for p in packages.launch_files(packages.share_of(args.package_name))]

    attach(action, names)


def topic(action: argparse.Action) -> None:
    attach(action, lambda _: _graph().topics())


def service(action: argparse.Action) -> None:
    attach(action, lambda _: _graph().services())


def action_name(action: argparse.Action) -> None:
    attach(action, lambda _: _graph().actions())


def node(action: argparse.Action) -> None:
    attach(action, lambda _: [n.full_name for n in _graph().nodes if not n.is_hidden])


def message_type(action: argparse.Action) -> None:
    attach(action, lambda _: _interfaces('msg'))


def service_type(action: argparse.Action) -> None:
    attach(action, lambda _: _interfaces('srv'))


def action_type(action: argparse.Action) -> None:
    attach(action, lambda _: _interfaces('action'))


def any_interface(action: argparse.Action) -> None:
    attach(action, lambda _: _interfaces(''))


def values(action: argparse.Action, type_key: str) -> None:
    """Offer the type's default value, as YAML on one line, to be changed."""
    attach(action, lambda args: _prototype(getattr(args, type_key, None)))


def attach(
    action: argparse.Action, choices: Callable[[argparse.Namespace], Iterable[str]]
) -> None:
    """Offer what a function finds for the arguments so far."""

    def complete(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        try:
            return list(choices(parsed_args))
        except Exception:
            return []  # A completion has nowhere to say what went wrong.

    action.completer = complete  # type: ignore[attr-defined]


def _graph() -> Graph:
    from ros2cli import discovery

    return discovery.read_graph()


def _interfaces(kind: str) -> list[str]:
    from rosidl_runtime_py import get_interfaces

    return [
        f'{package_name}/{name}'
        for package_name, names in get_interfaces().items()
        for name in names
        if name.startswith(kind)
    ]


def _prototype(type_name: str | None) -> list[str]:
    from rosidl_runtime_py import message_to_yaml
    from rosidl_runtime_py.utilities import get_interface

    interface = get_interface(type_name or '')
    for part in ('Request', 'Goal'):
        interface = getattr(interface, part, interface)
    return [message_to_yaml(interface(), flow_style=True).strip()]
