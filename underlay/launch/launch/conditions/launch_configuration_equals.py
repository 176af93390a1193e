# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Do it if a launch configuration has a value."""

from __future__ import annotations

import warnings

from ..condition import Condition
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


class LaunchConfigurationEquals(Condition):
    """Holds where the configuration is the expected text, or with None where it is not set."""

    def __init__(
        self,
        launch_configuration_name: str,
        expected_value: SomeSubstitutionsType | None,
    ) -> None:
        warnings.warn(
            f'{type(self).__name__} is deprecated: use IfCondition with EqualsSubstitution or '
            f"NotEqualsSubstitution of LaunchConfiguration('{launch_configuration_name}')",
            UserWarning,
            stacklevel=2,
        )
        self.__name = launch_configuration_name
        self.__expected = (
            None if expected_value is None else normalize_to_list_of_substitutions(expected_value)
        )
        super().__init__(predicate=self._predicate_func)

    def _predicate_func(self, context: LaunchContext) -> bool:
        expected = None
        if self.__expected is not None:
            expected = perform_substitutions(context, self.__expected)
        value: str | None = context.launch_configurations.get(self.__name)
        return value == expected

    def describe(self) -> str:
        return f'{type(self).__name__}({self.__name})'
