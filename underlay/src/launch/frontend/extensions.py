# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The packages that bring actions and substitutions for markup launch files."""

from __future__ import annotations

import importlib
from importlib import metadata
import warnings

_OWN = ('launch.actions', 'launch.substitutions', 'launch_ros.actions', 'launch_ros.substitutions')
_loaded: set[str] = set()


def load_extensions() -> None:
    """Import what belongs to launch and launch_ros."""
    if 'own' in _loaded:
        return
    _loaded.add('own')
    for name in _OWN:
        importlib.import_module(name)


def load_foreign_extensions() -> None:
    """Import what other distributions register; slow, so only for a name nobody knows yet."""
    if 'foreign' in _loaded:
        return
    _loaded.add('foreign')
    for entry_point in metadata.entry_points(group='launch.frontend.launch_extension'):
        try:
            entry_point.load()
        except Exception as error:
            warnings.warn(
                f'Failed to load the launch extension {entry_point.name}: {error}', stacklevel=2
            )
