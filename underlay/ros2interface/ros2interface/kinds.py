# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The kinds of interfaces, and the options that choose among them."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass

from ros2cli import arguments
from rosidl_runtime_py import (
    get_action_interfaces,
    get_message_interfaces,
    get_service_interfaces,
)


@dataclass(frozen=True)
class Kind:
    """One kind of interfaces."""

    noun: str
    option: str
    interfaces: Callable[..., dict[str, list[str]]]  # of some packages, or of all


KINDS = (
    Kind('message', 'msgs', get_message_interfaces),
    Kind('service', 'srvs', get_service_interfaces),
    Kind('action', 'actions', get_action_interfaces),
)


def add_arguments(parser: argparse.ArgumentParser, text: str) -> None:
    """Add an option for each kind; `text` is its help, with {} for the kind."""
    for kind in KINDS:
        spellings = f'-{kind.option[0]} --only-{kind.option}'
        arguments.add_flags(parser, {spellings: text.format(kind.noun)})


def chosen(args: argparse.Namespace) -> list[Kind]:
    """List the kinds whose options were given."""
    return [kind for kind in KINDS if getattr(args, f'only_{kind.option}')]
