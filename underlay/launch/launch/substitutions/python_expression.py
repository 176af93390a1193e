# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The value of a Python expression."""

from __future__ import annotations

from collections.abc import Sequence
import importlib
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import MarkupArguments, Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_substitution('eval')
class PythonExpression(Substitution):
    """Becomes ``str()`` of what a Python expression evaluates to.

    :param python_modules: names of modules the expression may use; what is in ``math`` is also
        known by itself.

    What the expression raises is raised with the expression in its message.
    """

    _arguments = MarkupArguments(
        'expression', 'python_modules', required=1, of='eval substitution'
    )

    def __init__(
        self, expression: SomeSubstitutionsType, python_modules: SomeSubstitutionsType = ('math',)
    ) -> None:
        self.expression = normalize_to_list_of_substitutions(expression)
        self.python_modules = normalize_to_list_of_substitutions(python_modules)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        kwargs = super().parse(data)[1]
        if 'python_modules' in kwargs:
            names = ''.join(sub.text for sub in kwargs['python_modules'])
            kwargs['python_modules'] = [name.strip() for name in names.split(',') if name.strip()]
        return cls, kwargs

    def describe(self) -> str:
        return 'PythonExpr({}, [{}])'.format(
            ' + '.join(sub.describe() for sub in self.expression),
            ', '.join(sub.describe() for sub in self.python_modules),
        )

    def perform(self, context: LaunchContext) -> str:
        names: dict[str, Any] = {}
        for sub in self.python_modules:
            module = importlib.import_module(context.perform_substitution(sub))
            if module.__name__ == 'math':
                names.update(vars(module))
            names[module.__name__.partition('.')[0]] = importlib.import_module(
                module.__name__.partition('.')[0]
            )
        text = perform_substitutions(context, self.expression)
        try:
            return str(eval(text, {}, names))
        except Exception as error:
            what = (
                f"cannot evaluate the Python expression '{text}': {type(error).__name__}: {error}"
            )
            if isinstance(error, SyntaxError):
                error.msg, error.filename, error.lineno = what, None, None
            error.args = (what,)
            raise
