# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The content of a file."""

from __future__ import annotations

from pathlib import Path

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import MarkupArguments, Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .substitution_failure import SubstitutionFailure


@expose_substitution('file-content')
class FileContent(Substitution):
    """Becomes the content of a text file."""

    _arguments = MarkupArguments('path', of='file-content substitution')

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self.path = normalize_to_list_of_substitutions(path)

    def describe(self) -> str:
        return f'FileContent({" + ".join(sub.describe() for sub in self.path)})'

    def perform(self, context: LaunchContext) -> str:
        path = perform_substitutions(context, self.path)
        try:
            return Path(path).read_text(encoding='utf-8')
        except FileNotFoundError:
            raise SubstitutionFailure(f'File not found: {path}') from None
        except (OSError, UnicodeDecodeError) as error:
            raise SubstitutionFailure(f"cannot read the file '{path}': {error}") from None
