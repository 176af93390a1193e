# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Files that live as long as the launch."""

from __future__ import annotations

import atexit
import os
from pathlib import Path
import tempfile

_paths: list[Path] = []


@atexit.register
def _remove() -> None:
    for path in _paths:
        path.unlink(missing_ok=True)


def write_temporary_file(text: str) -> Path:
    """Write a parameter file that is removed when this process ends."""
    fd, name = tempfile.mkstemp(prefix='launch_params_')
    with os.fdopen(fd, 'w', encoding='utf-8') as file:
        file.write(text)
    _paths.append(Path(name))
    return _paths[-1]
