# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What parameters may be written as."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from launch.some_substitutions_type import (
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
)
from launch.substitution import Substitution

from .parameter_descriptions import Parameter, ParameterFile, ParameterValue

EvaluatedParameterValue = (
    bool
    | int
    | float
    | str
    | bytes
    | Sequence[bool]
    | Sequence[int]
    | Sequence[float]
    | Sequence[str]
)
EvaluatedParameters = Sequence[Path | dict[str, EvaluatedParameterValue] | Parameter]
SomeParameterFile = SomeSubstitutionsType | ParameterFile
SomeParameterName = Sequence[Substitution | str]
SomeParameterValue = Any
SomeParameterValue_types_tuple = (*SomeSubstitutionsType_types_tuple, str, int, float, bool, bytes)
SomeParametersDict = Mapping[SomeSubstitutionsType, Any]
SomeParameters = Sequence[SomeParameterFile | Parameter | Mapping[Any, Any]]
ParameterName = Sequence[Substitution]
ParametersDict = dict[tuple[Substitution, ...], ParameterValue]
Parameters = Sequence[ParameterFile | ParametersDict | Parameter]

__all__ = [
    'EvaluatedParameterValue',
    'EvaluatedParameters',
    'Parameter',
    'ParameterFile',
    'ParameterName',
    'ParameterValue',
    'Parameters',
    'ParametersDict',
    'SomeParameterFile',
    'SomeParameterName',
    'SomeParameterValue',
    'SomeParameterValue_types_tuple',
    'SomeParameters',
    'SomeParametersDict',
]
