# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Upstream's templates, each parsed once.

rosidl_adapter and rosidl_pycommon expand a template by a new interpreter of empy 3, which parses
it anew. That takes as long as all else that is done for a definition.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import em


class Interpreter(em.Interpreter):
    """
    Expands templates.

    It leaves sys.stdout as it is: in upstream's templates nothing is printed, and empy's own
    interpreter allows nobody else to redirect it.
    """

    def __init__(self, *, options: dict[str, Any], **others: Any) -> None:
        super().__init__(options={**options, em.OVERRIDE_OPT: False}, **others)

    def installProxy(self) -> None:  # noqa: N802 empy's name
        pass

    def parse(self, scanner: Any, locals: Any = None) -> None:  # noqa: A002 empy's name
        for token in _tokens(scanner.buffer):
            token.run(self, locals)


@cache
def _tokens(text: str) -> list[Any]:
    return list(iter(em.Scanner(em.DEFAULT_PREFIX, text).one, None))


def parse_once() -> None:
    """Have upstream's modules expand templates by the interpreter above."""
    em.Interpreter = Interpreter
