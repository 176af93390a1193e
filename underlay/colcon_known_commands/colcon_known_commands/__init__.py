# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Has colcon start the setup.py of a package less often.

Before each build of a package in Python, colcon starts its setup.py once to hear which commands
there are, and again to hear which options `develop` has: 0.7 s of the 1.9 s of a processor that
the build takes. All that it looks for are the commands `develop` and `egg_info` and the option
`--editable`. A setup.py that calls setup() of setuptools, and names no commands of its own, has
them all. Any other is asked as before.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from colcon_core.package_augmentation import PackageAugmentationExtensionPoint
from colcon_core.task.python.build import PythonBuildTask
import setuptools

COMMANDS = frozenset({'develop', 'egg_info'})
OPTIONS_OF_DEVELOP = frozenset({'--editable'})
# Setuptools 80 has another `develop`.
_KNOWN = int(setuptools.__version__.partition('.')[0]) < 80
# Words by which commands are brought, or what a setup.py does depends on how it is called.
_BY_WHICH_COMMANDS_DIFFER = (
    'cmdclass', 'command_packages', 'distclass', 'distutils', 'script_args', 'argv',
)  # fmt: skip

_ask_for_commands = PythonBuildTask._get_available_commands
_ask_for_options = PythonBuildTask._get_available_options


def is_plain(folder: Path) -> bool:
    """Return whether commands and options of a package's setup.py are those of setuptools."""
    try:
        setup_py = (folder / 'setup.py').read_text(encoding='utf-8')
        others = [
            path.read_text(encoding='utf-8')
            for path in (folder / 'setup.cfg', folder / 'pyproject.toml')
            if path.exists()
        ]
    except (OSError, UnicodeError):
        return False
    texts = ''.join((setup_py, *others))
    return (
        _KNOWN
        and 'setuptools' in setup_py
        and not any(word in texts for word in _BY_WHICH_COMMANDS_DIFFER)
    )


async def _known_commands(task: Any, path: str, env: Any) -> set[str]:
    if is_plain(Path(path)):
        return set(COMMANDS)
    return await _ask_for_commands(task, path, env)  # type: ignore[no-any-return]


async def _known_options(task: Any, path: str, env: Any, command: str) -> set[str]:
    if command == 'develop' and is_plain(Path(path)):
        return set(OPTIONS_OF_DEVELOP)
    return await _ask_for_options(task, path, env, command)  # type: ignore[no-any-return]


# colcon has no place for an extension of this; it loads the one below before it builds.
PythonBuildTask._get_available_commands = _known_commands
PythonBuildTask._get_available_options = _known_options


class KnownCommands(PackageAugmentationExtensionPoint):
    """Let colcon load this module; it knows nothing of packages."""

    def augment_package(self, desc: Any, *, additional_argument_names: Any = None) -> None:
        pass
