# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters, their values and files of them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from launch.frontend.parse_substitution import parse_substitution
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch.utilities.type_utils import (
    normalize_typed_substitution,
    perform_typed_substitution,
)
from launch.utilities.typing_file_path import FilePath
import yaml

from .temporary_files import write_temporary_file


class ParameterValue:
    """The value of a parameter.

    :param value: a value, a substitution or a list of them.
    :param value_type: what the text of substitutions is to be read as: bool, int, float, str or
        a ``List`` of one of them; without it, what YAML takes it for.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.__value = normalize_typed_substitution(value, value_type)
        self.value_type = value_type
        self.__evaluated: Any = None

    @property
    def value(self) -> Any:
        return self.__value if self.__evaluated is None else self.__evaluated

    def __str__(self) -> str:
        kind = getattr(self.value_type, '__name__', self.value_type)
        return f'launch_ros.description.ParameterValue(value={self.value}, value_type={kind})'

    def evaluate(self, context: LaunchContext) -> Any:
        self.__evaluated = perform_typed_substitution(context, self.__value, self.value_type)
        return self.__evaluated


class Parameter:
    """A parameter with its name; see :class:`ParameterValue`."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__parameter_value = ParameterValue(value, value_type=value_type)
        self.__evaluated_name: str | None = None

    @property
    def name(self) -> list[Substitution] | str:
        return self.__name if self.__evaluated_name is None else self.__evaluated_name

    @property
    def value(self) -> Any:
        return self.__parameter_value.value

    @property
    def value_type(self) -> Any:
        return self.__parameter_value.value_type

    def __str__(self) -> str:
        kind = getattr(self.value_type, '__name__', self.value_type)
        return (
            f'launch_ros.description.Parameter(name={self.name}, value={self.value}, '
            f'value_type={kind})'
        )

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        self.__evaluated_name = perform_substitutions(context, self.__name)
        return self.__evaluated_name, self.__parameter_value.evaluate(context)


class ParameterFile:
    """A file of parameters.

    :param allow_substs: the file has substitutions, as ``$(var name)``, also in its comments; in
        quotes they are text.
    """

    def __init__(
        self,
        param_file: FilePath | SomeSubstitutionsType,
        *,
        allow_substs: bool | SomeSubstitutionsType = False,
    ) -> None:
        if isinstance(param_file, (bytes, os.PathLike)):
            param_file = os.fsdecode(param_file)
        self.__param_file = normalize_to_list_of_substitutions(param_file)
        self.allow_substs = normalize_typed_substitution(allow_substs, bool)
        self.__evaluated: Path | None = None
        self.__is_temporary = False

    @property
    def param_file(self) -> FilePath | list[Substitution]:
        return self.__param_file if self.__evaluated is None else self.__evaluated

    def __str__(self) -> str:
        return (
            f'launch_ros.description.ParameterFile(param_file={self.param_file!r}, '
            f'allow_substs={self.allow_substs})'
        )

    def evaluate(self, context: LaunchContext) -> Path:
        """Return the path, of a file with the substitutions performed where it has some."""
        path = Path(perform_substitutions(context, self.__param_file))
        if perform_typed_substitution(context, self.allow_substs, bool):
            path = self.__substitute(context, path)
            self.__is_temporary = True
        self.__evaluated = path
        return path

    @staticmethod
    def __substitute(context: LaunchContext, path: Path) -> Path:
        text = path.read_text(encoding='utf-8')
        text = perform_substitutions(context, parse_substitution(text))
        try:
            yaml.safe_load(text)
        except yaml.YAMLError as error:
            raise SubstitutionFailure(
                f"the parameter file '{path}' is not valid YAML after its substitutions: {error}"
            ) from None
        return write_temporary_file(text)

    def cleanup(self) -> None:
        """Remove the file that evaluating has written; else it is removed at the end."""
        if self.__is_temporary and self.__evaluated is not None:
            self.__evaluated.unlink(missing_ok=True)
            self.__evaluated = None
