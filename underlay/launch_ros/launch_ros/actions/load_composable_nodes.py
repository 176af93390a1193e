# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Load nodes into a container."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
import time
from typing import Any

from launch.action import Action
from launch.frontend import Entity, expose_action, Parser
from launch.launch_context import LaunchContext
from launch.logging import get_logger
from launch.some_substitutions_type import (
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
)
from launch.utilities import (
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

from ..descriptions import ComposableNode
from ..parameter_descriptions import ParameterFile
from ..ros_adapters import get_ros_node
from ..utilities import (
    add_node_name,
    evaluate_parameters,
    get_node_name_count,
    make_namespace_absolute,
    normalize_parameter_dict,
    prefix_namespace,
    to_parameters_list,
)
from .composable_node_container import ComposableNodeContainer

_POLL_SEC = 0.1


@expose_action('load_composable_node')
class LoadComposableNodes(Action):
    """Has a running container load nodes, one after the other.

    :param target_container: the container or its full name; it is waited for.
    """

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: SomeSubstitutionsType | ComposableNodeContainer,
        **kwargs: Any,
    ) -> None:
        ensure_argument_type(
            target_container,
            (*SomeSubstitutionsType_types_tuple, ComposableNodeContainer),
            'target_container',
            'LoadComposableNodes',
        )
        super().__init__(**kwargs)
        self.__descriptions = list(composable_node_descriptions)
        self.__target_container = target_container
        self.__container_name = ''
        self.__client: Any = None

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
        if isinstance(self.__target_container, ComposableNodeContainer):
            self.__container_name = self.__target_container.node_name
        else:
            self.__container_name = perform_substitutions(
                context, normalize_to_list_of_substitutions(self.__target_container)
            )
        # Now: by the time that the container answers, the scope of this action is left.
        requests = [
            get_composable_node_load_request(node, context)
            for node in self.__descriptions
            if node.is_wanted(context)
        ]
        if not requests:
            return
        from composition_interfaces.srv import LoadNode

        self.__client = get_ros_node(context).create_client(
            LoadNode, f'{self.__container_name}/_container/load_node'
        )
        assert context.asyncio_loop is not None
        context.add_completion_future(
            context.asyncio_loop.run_in_executor(None, self.__load_all, requests, context)
        )

    def __load_all(self, requests: list[Any], context: LaunchContext) -> None:
        """Call the service of the container; blocks, in a thread, until the launch ends."""
        for request in requests:
            while not self.__client.wait_for_service(timeout_sec=_POLL_SEC):
                if context.is_shutdown:
                    return
            future = self.__client.call_async(request)
            while not future.done():
                if context.is_shutdown:
                    return
                time.sleep(_POLL_SEC / 10)
            self.__on_answer(request, future.result(), context)

    def __on_answer(self, request: Any, response: Any, context: LaunchContext) -> None:
        logger = get_logger('launch_ros.actions.load_composable_nodes')
        name = response.full_node_name or request.node_name
        if not response.success:
            logger.error(
                f"Failed to load node '{name}' of type '{request.plugin_name}' in container "
                f"'{self.__container_name}': {response.error_message}"
            )
            return
        add_node_name(context, name)
        count = get_node_name_count(context, name)
        if count > 1:
            get_logger(self.__container_name).warning(
                f'there are now at least {count} nodes with the name {name} created within this '
                'launch context'
            )
        logger.info(f"Loaded node '{name}' in container '{self.__container_name}'")


def get_composable_node_load_request(
    composable_node_description: ComposableNode, context: LaunchContext
) -> Any:
    """Return what a container is asked to load, None where the node's condition does not hold."""
    node = composable_node_description
    if not node.is_wanted(context):
        return None

    def perform(subs: Any) -> str:
        return '' if subs is None else perform_substitutions(context, subs)

    from composition_interfaces.srv import LoadNode

    request = LoadNode.Request()
    request.package_name = perform(node.package)
    request.plugin_name = perform(node.node_plugin)
    request.node_name = perform(node.node_name)
    own = None if node.node_namespace is None else perform(node.node_namespace)
    base = context.launch_configurations.get('ros_namespace')
    namespace = make_namespace_absolute(prefix_namespace(base, own))
    request.node_namespace = namespace or ''
    pairs = list(context.launch_configurations.get('ros_remaps', ()))
    pairs += [(perform(source), perform(target)) for source, target in node.remappings or ()]
    request.remap_rules = [f'{source}:={target}' for source, target in pairs]
    for field, parameters in (
        ('parameters', [*_global_parameters(context), *(node.parameters or ())]),
        ('extra_arguments', node.extra_arguments or ()),
    ):
        evaluated = evaluate_parameters(context, parameters)
        found = to_parameters_list(context, request.node_name, namespace, evaluated)
        setattr(request, field, [parameter.to_parameter_msg() for parameter in found])
    return request


def _global_parameters(context: LaunchContext) -> list[Any]:
    """Return what SetParameter and SetParametersFromFile have set, normalized."""
    return [
        normalize_parameter_dict({item[0]: item[1]})
        if isinstance(item, tuple)
        else ParameterFile(Path(item).absolute())
        for item in context.launch_configurations.get('global_params', ())
    ]
