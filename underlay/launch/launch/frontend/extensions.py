# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The packages that bring actions and substitutions for markup launch files."""

from __future__ import annotations

import functools
import importlib
import warnings

from entry_point_index import entry_points, load

_OWN = ('launch.actions', 'launch.substitutions')


@functools.cache
def load_extensions() -> None:
    """Import what belongs to launch, and what distributions register."""
    for name in _OWN:
        importlib.import_module(name)
    for name, target in entry_points('launch.frontend.launch_extension').items():
        try:
            load(target)
        except Exception as error:
            warnings.warn(f'Failed to load the launch extension {name}: {error}', stacklevel=2)
