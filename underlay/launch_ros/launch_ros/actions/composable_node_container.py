# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a container of nodes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ament_index_python import PackageNotFoundError
from launch.action import Action
from launch.frontend import Entity, expose_action, Parser
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType

from ..descriptions import ComposableNode
from .node import Node


@expose_action('node_container')
class ComposableNodeContainer(Node):
    """Runs a program that loads nodes, and has it load some; see LoadComposableNodes."""

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.__descriptions = list(composable_node_descriptions or ())

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: list[str] | None = None
    ) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser, ignore)[1]
        nodes = entity.get_attr('composable_node', data_type=list[Entity], optional=True) or ()
        kwargs['composable_node_descriptions'] = []
        for node in nodes:
            node_type, node_kwargs = ComposableNode.parse(parser, node)
            kwargs['composable_node_descriptions'].append(node_type(**node_kwargs))
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        from .load_composable_nodes import LoadComposableNodes

        try:
            entities = super().execute(context) or []
        except PackageNotFoundError as error:
            raise RuntimeError(
                f'{error.args[0]}: component containers are C++ programs; run the node as a Node '
                'with an executable of its package, or use a full ROS 2 Jazzy'
            ) from None
        wanted = [node for node in self.__descriptions if node.is_wanted(context)]
        if not wanted:
            return entities
        return [
            *entities,
            LoadComposableNodes(composable_node_descriptions=wanted, target_container=self),
        ]
