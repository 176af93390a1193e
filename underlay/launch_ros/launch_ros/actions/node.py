# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a ROS node."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from launch.action import Action
from launch.actions import ExecuteProcess
from launch.frontend import Entity, expose_action, Parser
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.logging import get_logger
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitutions import LocalSubstitution
from launch.utilities import (
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from ros2_diagnosis import parameter_files
import yaml

from ..parameter_descriptions import Parameter
from ..parameters_type import SomeParameters
from ..remap_rule_type import SomeRemapRules
from ..substitutions import ExecutableInPackage
from ..temporary_files import write_temporary_file
from ..utilities import (
    add_node_name,
    evaluate_parameters,
    get_node_name_count,
    make_namespace_absolute,
    normalize_parameters,
    normalize_remap_rules,
    prefix_namespace,
)
from ..utilities.namespace_utils import validate_namespace, validate_node_name
from ..utilities.normalize_parameters import as_yaml
from .global_parameters import global_parameter_arguments
from .markup import parse_nested_parameters
from .node_extensions import get_extensions, NodeActionExtension

__all__ = ['Node', 'NodeActionExtension', 'get_extensions']

_LOGGER = 'launch_ros.actions.node'
_TEXTS = {
    'name': 'name',
    'exec_name': 'exec_name',
    'pkg': 'package',
    'namespace': 'namespace',
}


@expose_action('node')
class Node(ExecuteProcess):
    """Runs a node of a package.

    :param executable: of the package, or a path where no package is given.
    :param name: of the node; default: what its code says.
    :param namespace: relative ones go below that of PushRosNamespace.
    :param exec_name: of the process, in place of that of the executable.
    :param parameters: files, dictionaries and Parameters; later ones win.
    :param remappings: pairs of names.
    :param ros_arguments: more of what follows ``--ros-args``.
    :param arguments: more of what goes before it.
    """

    UNSPECIFIED_NODE_NAME = '<node_name_unspecified>'
    UNSPECIFIED_NODE_NAMESPACE = '<node_namespace_unspecified>'

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: SomeParameters | None = None,
        remappings: SomeRemapRules | None = None,
        ros_arguments: Iterable[SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        cmd: list[SomeSubstitutionsType] = [executable]
        if package is not None:
            cmd = [ExecutableInPackage(package=package, executable=executable)]
        if arguments is not None:
            if isinstance(arguments, str) or not isinstance(arguments, Iterable):
                raise TypeError(
                    f"Node 'arguments' is {arguments!r}: write it as a list, as ['--flag', '5']"
                )
            cmd += arguments
        if ros_arguments is not None:
            ensure_argument_type(ros_arguments, list, 'ros_arguments', 'Node')
            cmd += ['--ros-args', *ros_arguments]
        cmd += ['--ros-args']
        if name is not None:
            cmd += ['-r', LocalSubstitution("ros_specific_arguments['name']", 'node name')]
        if parameters is not None:
            ensure_argument_type(parameters, list, 'parameters', 'Node')
        super().__init__(cmd=cmd, name=exec_name, **kwargs)
        self.__package = package
        self.__node_executable = executable
        self.__node_name = name
        self.__node_namespace = namespace
        self.__parameters = normalize_parameters(parameters or [])
        self.__remappings = normalize_remap_rules(remappings or [])
        self.__expanded_node_name = self.UNSPECIFIED_NODE_NAME
        self.__expanded_node_namespace = self.UNSPECIFIED_NODE_NAMESPACE
        self.__expanded_parameter_arguments: list[tuple[str, bool]] = []
        self.__expanded_remappings: list[tuple[str, str]] | None = None
        self.__final_node_name: str | None = None

    @staticmethod
    def parse_nested_parameters(params: Iterable[Entity], parser: Parser) -> list[Any]:
        return parse_nested_parameters(params, parser)

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: list[str] | None = None
    ) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser, ignore=['cmd', 'name', *(ignore or ())])[1]
        for attribute, keyword in (('args', 'arguments'), ('ros_args', 'ros_arguments')):
            text = entity.get_attr(attribute, optional=True)
            if text is not None:
                kwargs[keyword] = cls._parse_cmdline(text, parser)
        for attribute, keyword in _TEXTS.items():
            text = entity.get_attr(attribute, optional=True)
            if text is not None:
                kwargs[keyword] = parser.parse_substitution(text)
        kwargs['executable'] = parser.parse_substitution(entity.get_attr('exec'))
        remappings = parser.parse_pairs(entity, 'remap', 'from', 'to')
        if remappings:
            kwargs['remappings'] = remappings
        parameters = entity.get_attr('param', data_type=list[Entity], optional=True)
        if parameters is not None:
            kwargs['parameters'] = parse_nested_parameters(parameters, parser)
        return cls, kwargs

    @property
    def node_package(self) -> SomeSubstitutionsType | None:
        return self.__package

    @property
    def node_executable(self) -> SomeSubstitutionsType:
        return self.__node_executable

    @property
    def expanded_node_namespace(self) -> str:
        return self.__expanded_node_namespace

    @property
    def expanded_remapping_rules(self) -> list[tuple[str, str]] | None:
        return self.__expanded_remappings

    @property
    def node_name(self) -> str:
        """The name with its namespace, once the action is executed."""
        if self.__final_node_name is None:
            raise RuntimeError("cannot access 'node_name' before executing action")
        return self.__final_node_name

    def is_node_name_fully_specified(self) -> bool:
        unknown = (self.UNSPECIFIED_NODE_NAME, self.UNSPECIFIED_NODE_NAMESPACE)
        return not any(word in self.node_name for word in unknown)

    def _perform_substitutions(self, context: LaunchContext) -> None:
        """Complete the command; done once, a subclass may do it early."""
        if self.__final_node_name is not None:
            return
        words = self.__name_arguments(context)
        self.__expanded_parameter_arguments = [
            *global_parameter_arguments(context),
            *self.__parameter_arguments(context),
        ]
        for argument, is_file in self.__expanded_parameter_arguments:
            words += ['--params-file' if is_file else '-p', argument]
        words += self.__remapping_arguments(context)
        command = self.process_description.cmd
        command.extend(normalize_to_list_of_substitutions(word) for word in words)

    def __name_arguments(self, context: LaunchContext) -> list[SomeSubstitutionsType]:
        words: list[SomeSubstitutionsType] = []
        if self.__node_name is not None:
            name = perform_substitutions(
                context, normalize_to_list_of_substitutions(self.__node_name)
            )
            validate_node_name(name)
            self.__expanded_node_name = name
        namespace: str | None = None
        if self.__node_namespace is not None:
            namespace = perform_substitutions(
                context, normalize_to_list_of_substitutions(self.__node_namespace)
            )
        base = context.launch_configurations.get('ros_namespace')
        namespace = make_namespace_absolute(prefix_namespace(base, namespace))
        if namespace is not None:
            validate_namespace(namespace)
            self.__expanded_node_namespace = namespace
            words += ['-r', LocalSubstitution("ros_specific_arguments['ns']")]
        self.__final_node_name = prefix_namespace(
            self.__expanded_node_namespace, self.__expanded_node_name
        )
        return words

    def __parameter_arguments(self, context: LaunchContext) -> list[tuple[str, bool]]:
        arguments = []
        for item in evaluate_parameters(context, self.__parameters):
            if isinstance(item, Parameter):
                name, value = item.evaluate(context)
                arguments.append((f'{name}:={as_yaml(value)}', False))
                continue
            path = item if isinstance(item, Path) else self.__write_parameters(item)
            if path.is_file():
                arguments.append((str(path), True))
                if isinstance(item, Path) and (why := parameter_files.why_refused(item)):
                    get_logger(_LOGGER).warning(f'{path}: {"; ".join(why)}')
            else:
                from ros2_diagnosis.packages import why_not_in_share

                why_not = why_not_in_share(path)
                hint = f'; {why_not}' if why_not else ''
                get_logger(_LOGGER).warning(f'Parameter file path is not a file: {path}{hint}')
        return arguments

    def __write_parameters(self, parameters: dict[str, Any]) -> Path:
        node = self.node_name if self.is_node_name_fully_specified() else '/**'
        tree = {node: {'ros__parameters': parameters}}
        return write_temporary_file(yaml.safe_dump(tree, default_flow_style=False))

    def __remapping_arguments(self, context: LaunchContext) -> list[str]:
        pairs = list(context.launch_configurations.get('ros_remaps', ()))
        for source, target in self.__remappings:
            pairs.append(
                (perform_substitutions(context, source), perform_substitutions(context, target))
            )
        self.__expanded_remappings = pairs or None
        words: list[str] = []
        for source, target in pairs:
            words += ['-r', f'{source}:={target}']
        return words

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        self._perform_substitutions(context)
        names = {
            'name': f'__node:={self.__expanded_node_name}',
            'ns': f'__ns:={self.__expanded_node_namespace}',
        }
        for extension in get_extensions(get_logger(_LOGGER)).values():
            words, names = extension.prepare_for_execute(context, names, self)
            self.process_description.cmd.extend(map(normalize_to_list_of_substitutions, words))
        context.extend_locals({'ros_specific_arguments': names})
        entities = super().execute(context)
        if self.is_node_name_fully_specified():
            add_node_name(context, self.node_name)
            count = get_node_name_count(context, self.node_name)
            if count > 1:
                get_logger(str(self.process_description.final_name)).warning(
                    f'there are now at least {count} nodes with the name {self.node_name} created '
                    'within this launch context'
                )
        return entities
