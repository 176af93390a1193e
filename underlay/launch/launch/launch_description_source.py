# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where a launch description comes from."""

from __future__ import annotations

from .launch_context import LaunchContext
from .launch_description import LaunchDescription
from .logging import get_logger
from .some_substitutions_type import SomeSubstitutionsType
from .utilities import normalize_to_list_of_substitutions, perform_substitutions


class LaunchDescriptionSource:
    """Base of the sources; reads its file when it is first asked for the description."""

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = '<string>',
        method: str = 'unspecified mechanism from a script',
    ) -> None:
        self.__launch_description = launch_description
        self.__location = normalize_to_list_of_substitutions(location)
        self.__expanded_location: str | None = None
        self.method = method

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """
        Return the description, or None where it is known only while the launch runs.

        The file is read again then: actions may set what it asks for, as environment variables.
        """
        if self.__launch_description is not None:
            return self.__launch_description
        try:
            location = perform_substitutions(LaunchContext(), self.__location)
            return self._get_launch_description(location)
        except Exception as error:  # the launch says so, if it comes to that
            get_logger('launch').debug(f'not loaded without a context: {error}')
            return None

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """Return the description, read when this is called first."""
        if self.__expanded_location is None:
            self.__expanded_location = perform_substitutions(context, self.__location)
        if self.__launch_description is None:
            self.__launch_description = self._get_launch_description(self.__expanded_location)
        return self.__launch_description

    def _get_launch_description(self, location: str) -> LaunchDescription:
        raise RuntimeError(
            f'{type(self).__name__} of {location} was given no launch description and reads none'
        )

    @property
    def location(self) -> str:
        """The path where it is known, else the substitutions that it is to be made of."""
        if self.__expanded_location is None:
            return ' + '.join(sub.describe() for sub in self.__location)
        return self.__expanded_location
