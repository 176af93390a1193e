# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a test of GoogleTest."""

from __future__ import annotations

from typing import Any

from launch import SomeSubstitutionsType

from .test import Test


class GTest(Test):
    """Runs a program of tests; the other arguments are those of Test."""

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[path], **kwargs)
        self.__path = path

    @property
    def path(self) -> SomeSubstitutionsType:
        return self.__path
