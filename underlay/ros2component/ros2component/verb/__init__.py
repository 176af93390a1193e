# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the verbs of `ros2 component` share."""

from __future__ import annotations

import argparse
from typing import Any

from ros2_diagnosis import nearest
from ros2cli import arguments
from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension

from ros2component import api

__all__ = ['VerbExtension']


def add_container(parser: argparse.ArgumentParser, text: str, **options: Any) -> None:
    arguments.add_completed(parser, 'container_node_name', api.containers, help=text, **options)


def find_container(args: argparse.Namespace) -> str:
    """Return the full name of the container that the arguments name.

    :raises CommandError: there is none.
    """
    name = str(args.container_node_name)
    known = api.containers(args)
    if name not in known:
        raise CommandError(f"Unable to find container node '{name}'{nearest.hint(name, known)}")
    return name


def load(node: Any, container: str, args: argparse.Namespace) -> tuple[int, str]:
    """Load the component that the arguments describe."""
    return api.load_component_into_container(
        node=node,
        remote_container_node_name=container,
        package_name=args.package_name,
        plugin_name=args.plugin_name,
        node_name=args.node_name,
        node_namespace=args.node_namespace,
        log_level=args.log_level,
        remap_rules=args.remap_rules,
        parameters=args.parameters,
        extra_arguments=args.extra_arguments,
    )
