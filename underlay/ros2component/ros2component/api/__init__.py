# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Components: those that packages register, and those in running containers.

The node that asks, `node`, is a node of rclpy or one of ros2cli. Containers are programs in C++:
with the wheels there is none on this computer, but there may be on others.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Mapping, Sequence
import subprocess
from typing import Any, NamedTuple

from ament_index_python import get_resource, get_resources, has_resource
from ros2cli import arguments, discovery
from ros2cli.errors import CommandError
from ros2node.api import get_service_server_info, NodeName
from ros2pkg.api import get_executable_paths, PackageNotFound
from rtps_graph.graph import Role

COMPONENTS_RESOURCE_TYPE = 'rclcpp_components'
_SERVICES = {'load_node': 'LoadNode', 'unload_node': 'UnloadNode', 'list_nodes': 'ListNodes'}


class ComponentInfo(NamedTuple):
    uid: int  # of the component, in its container
    name: str


# Registered components


def get_package_names_with_component_types() -> list[str]:
    return list(get_resources(COMPONENTS_RESOURCE_TYPE))


def get_package_component_types(*, package_name: str | None = None) -> list[str]:
    """List the types that a package registers in the ament index; [] where it registers none."""
    if not package_name or not has_resource(COMPONENTS_RESOURCE_TYPE, package_name):
        return []
    text, _ = get_resource(COMPONENTS_RESOURCE_TYPE, package_name)
    return [line.partition(';')[0] for line in text.splitlines()]


def get_registered_component_types() -> list[tuple[str, list[str]]]:
    """List each package that registers components, with their types."""
    return [
        (name, get_package_component_types(package_name=name))
        for name in get_package_names_with_component_types()
    ]


# Containers


def is_container(services: Mapping[str, Sequence[str]]) -> bool:
    """Tell whether a node with these services, their types by their names, is a container."""
    return all(
        any(
            name.endswith(f'_container/{service}')
            and f'composition_interfaces/srv/{type_name}' in types
            for name, types in services.items()
        )
        for service, type_name in _SERVICES.items()
    )


def find_container_node_names(*, node: Any, node_names: Iterable[NodeName]) -> list[NodeName]:
    """Keep the containers among nodes."""
    from rclpy.node import NodeNameNonExistentError

    found = []
    for each in node_names:
        try:
            services = get_service_server_info(
                node=node, remote_node_name=each.full_name, include_hidden=True
            )
        except NodeNameNonExistentError:
            continue  # It has ended since it was listed.
        if is_container({service.name: service.types for service in services}):
            found.append(each)
    return found


def containers(args: argparse.Namespace | None) -> list[str]:
    """List the full names of the containers in the graph, without hidden ones."""
    return sorted(
        node.full_name
        for node in discovery.read_graph(args).nodes
        if is_container(node.having(Role.SERVER)) and not node.is_hidden
    )


def get_components_in_container(
    *, node: Any, remote_container_node_name: str
) -> tuple[bool, list[ComponentInfo] | str]:
    """Return True and the components of a container, or False and why they are not known."""
    names = [remote_container_node_name]
    (outcome,) = get_components_in_containers(
        node=node, remote_containers_node_names=names
    ).values()
    return outcome


def get_components_in_containers(
    *, node: Any, remote_containers_node_names: Sequence[str]
) -> dict[str, tuple[bool, list[ComponentInfo] | str]]:
    """Ask several containers side by side; see `get_components_in_container`."""
    if not remote_containers_node_names:
        return {}
    from composition_interfaces.srv import ListNodes
    from ros2cli import calls

    names = {f'{name}/_container/list_nodes': name for name in remote_containers_node_names}
    requests = {name: ListNodes.Request() for name in names}
    answers = calls.call_all(node, ListNodes, requests, only_asks=True)
    found: dict[str, tuple[bool, list[ComponentInfo] | str]] = {}
    for name, answer in answers.items():
        if isinstance(answer, Exception):
            found[names[name]] = False, str(answer)
        else:
            pairs = zip(answer.unique_ids, answer.full_node_names, strict=True)
            found[names[name]] = True, [ComponentInfo(*pair) for pair in pairs]
    return found


def load_component_into_container(
    *,
    node: Any,
    remote_container_node_name: str,
    package_name: str,
    plugin_name: str,
    node_name: str | None = None,
    node_namespace: str | None = None,
    log_level: int | None = None,
    remap_rules: Sequence[str] | None = None,
    parameters: Sequence[str] | None = None,
    extra_arguments: Sequence[str] | None = None,
) -> tuple[int, str]:
    """Load a component; return its number in the container and the full name of its node.

    :param remap_rules: each 'from:=to'.
    :param parameters: each 'name:=value'; so are `extra_arguments`, which the container reads.
    :raises RuntimeError: the container does not answer, or refuses.
    """
    from composition_interfaces.srv import LoadNode
    from ros2cli import calls

    given = {
        'node_name': node_name,
        'node_namespace': node_namespace,
        'log_level': log_level,
        'remap_rules': remap_rules,
        'parameters': _parameters(parameters),
        'extra_arguments': _parameters(extra_arguments),
    }
    request = LoadNode.Request(
        package_name=package_name,
        plugin_name=plugin_name,
        **{name: value for name, value in given.items() if value is not None},
    )
    name = f'{remote_container_node_name}/_container/load_node'
    response = calls.call(node, LoadNode, name, request, may_take_long=True)
    if not response.success:
        raise CommandError(f'Failed to load component: {response.error_message.capitalize()}')
    return response.unique_id, response.full_node_name


def unload_component_from_container(
    *, node: Any, remote_container_node_name: str, component_uids: Iterable[int]
) -> Iterator[tuple[int, bool, str]]:
    """Unload components one after the other; yield for each its number, whether it failed, why.

    :raises RuntimeError: the container does not answer.
    """
    from composition_interfaces.srv import UnloadNode
    from ros2cli import calls

    name = f'{remote_container_node_name}/_container/unload_node'
    for uid in component_uids:
        request = UnloadNode.Request(unique_id=uid)
        response = calls.call(node, UnloadNode, name, request, may_take_long=True)
        yield uid, not response.success, response.error_message


def run_standalone_container(*, container_node_name: str) -> subprocess.Popen[bytes]:
    """Start a container of rclcpp_components.

    :raises RuntimeError: that package is not there, or has none.
    """
    try:
        paths = get_executable_paths(package_name='rclcpp_components')
    except PackageNotFound:
        raise CommandError(
            "Package 'rclcpp_components' not found: containers are programs in C++, which the "
            'wheels have not; run the node by `ros2 run`, or source a ROS 2 Jazzy'
        ) from None
    path = next((path for path in paths if 'component_container' in path), None)
    if path is None:
        raise CommandError('No component container node found!')
    return subprocess.Popen([path, '--ros-args', '-r', f'__node:={container_node_name}'])


def _parameters(texts: Sequence[str] | None) -> list[Any] | None:
    from rcl_interfaces.msg import Parameter
    from rclpy.parameter import get_parameter_value

    if texts is None:
        return None
    parts = (text.partition(':=') for text in texts)
    return [
        Parameter(name=name, value=get_parameter_value(string_value=value))
        for name, _, value in parts
    ]


# Arguments


def add_component_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what says which component, and how it is to be loaded."""
    complete = ComponentTypeNameCompleter(package_name_key='package_name')
    arguments.add_completed(
        parser,
        'package_name',
        lambda _: get_package_names_with_component_types(),
        help='Name of the package where the component is to be found',
    )
    arguments.add_completed(
        parser,
        'plugin_name',
        lambda args: complete('', args),
        help='Type name of the component to be loaded',
    )
    parser.add_argument('-n', '--node-name', help='Component node name')
    parser.add_argument('--node-namespace', help='Component node namespace')
    parser.add_argument('--log-level', type=int, help='Component node log level')
    for short, name, text in (
        ('-r', 'remap-rule', "Component node remapping rules, in the 'from:=to' form"),
        ('-p', 'parameter', "Component node parameters, in the 'name:=value' form"),
        ('-e', 'extra-argument', "Extra arguments for the container, in the 'name:=value' form"),
    ):
        dest = f'{name.replace("-", "_")}s'
        parser.add_argument(short, f'--{name}', action='append', dest=dest, help=text)


def package_with_components_name_completer(**_: Any) -> list[str]:
    return get_package_names_with_component_types()


def container_node_name_completer(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    return containers(parsed_args)


class ComponentTypeNameCompleter:
    """Offers the types of the package that was typed.

    :param package_name_key: where the arguments have the package.
    """

    def __init__(self, *, package_name_key: str) -> None:
        self.package_name_key = package_name_key

    def __call__(self, prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        package_name = getattr(parsed_args, self.package_name_key)
        return get_package_component_types(package_name=package_name)
