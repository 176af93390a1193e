# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Push a namespace."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.frontend import expose_action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from ..utilities import make_namespace_absolute, prefix_namespace
from ..utilities.namespace_utils import validate_namespace


@expose_action('push_ros_namespace')
@expose_action('push-ros-namespace')
class PushROSNamespace(Action):
    """Puts the nodes that follow, in its scope, below a namespace."""

    _attributes = {'namespace': 'namespace'}

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.namespace = normalize_to_list_of_substitutions(namespace)

    def execute(self, context: LaunchContext) -> None:
        pushed = perform_substitutions(context, self.namespace)
        previous = context.launch_configurations.get('ros_namespace')
        namespace = make_namespace_absolute(prefix_namespace(previous, pushed))
        assert namespace is not None  # what is pushed is text
        try:
            validate_namespace(namespace)
        except ValueError as error:
            raise SubstitutionFailure(f"'{pushed}' cannot be pushed: {error}") from None
        context.launch_configurations['ros_namespace'] = namespace


PushRosNamespace = PushROSNamespace
