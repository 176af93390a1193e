# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Load nodes into a container."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch.action import Action
from launch.frontend import Entity, expose_action, Parser
from launch.launch_context import LaunchContext

from ..descriptions import ComposableNode

REFUSAL = (
    'component containers are C++ programs that this installation from the Python package index '
    'does not have: run the node as a Node with an executable of its package, or use a full ROS 2 '
    'Jazzy'
)


@expose_action('load_composable_node')
class LoadComposableNodes(Action):
    """Refused when it is executed: there are no component containers here."""

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: Any,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__descriptions = list(composable_node_descriptions)
        self.__target_container = target_container

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        kwargs['target_container'] = parser.parse_substitution(entity.get_attr('target'))
        kwargs['composable_node_descriptions'] = []
        for node in entity.get_attr('composable_node', data_type=list[Entity]):
            node_type, node_kwargs = ComposableNode.parse(parser, node)
            kwargs['composable_node_descriptions'].append(node_type(**node_kwargs))
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        del context
        raise RuntimeError(f'LoadComposableNodes: {REFUSAL}')
