# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A unique name."""

from __future__ import annotations

import os
import random
import re
import socket
from typing import cast

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import MarkupArguments, Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_substitution('anon')
class AnonName(Substitution):
    """Becomes a name with a unique tail, the same one each time in one launch."""

    _arguments = MarkupArguments('name', of='anon substitution')

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    def describe(self) -> str:
        return f'AnonName({" + ".join(sub.describe() for sub in self.name)})'

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.name)
        key = 'anon' + name
        if key not in context.launch_configurations:
            context.launch_configurations[key] = self.compute_name(name)
        return cast(str, context.launch_configurations[key])

    def compute_name(self, id_value: str) -> str:
        """Return a new name that begins with the given one."""
        tail = f'{socket.gethostname()}_{os.getpid()}_{random.randint(0, 2**32)}'
        return re.sub(r'[.\-:]', '_', f'{id_value}_{tail}')
