# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a file of pytest."""

from __future__ import annotations

import sys
from typing import Any

from launch import SomeSubstitutionsType

from .test import Test


class PyTest(Test):
    """Runs pytest on a file or a folder; the other arguments are those of Test."""

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[sys.executable, '-m', 'pytest', path], **kwargs)
        self.__path = path

    @property
    def path(self) -> SomeSubstitutionsType:
        return self.__path
