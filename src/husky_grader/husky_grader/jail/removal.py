# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Remove what jailed programs have left."""

from pathlib import Path
import subprocess


def remove(folder: Path) -> None:
    """Remove a folder, however deep its folders are in each other, and closed to everybody."""
    # shutil.rmtree gives up at a folder that it may not read, and at the depth of Python's stack.
    for command in (['chmod', '-R', 'u+rwX'], ['rm', '-rf']):
        subprocess.run(
            [*command, '--', str(folder)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            check=False,
        )
