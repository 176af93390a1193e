# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The commands and verbs that exist: a module each, its docstring being its help."""

from __future__ import annotations

import ast
import importlib
from pathlib import Path
import pkgutil
from types import ModuleType

# Second names as upstream has them.
_ALIASES = {'ros2cli.command': {'wtf': 'doctor'}}


# What a full ROS 2 has besides; each is refused with a line that says so.
_LEFT_OUT = {
    'ros2cli.command': (
        'component', 'control', 'extension_points', 'extensions', 'lifecycle', 'multicast',
        'plugin', 'security', 'test', 'trace',
    ),
    'ros2cli.command.bag': ('burst', 'convert', 'list', 'reindex'),
    'ros2cli.command.action': ('echo', 'find'),
}  # fmt: skip


def is_left_out(package: str, name: str) -> bool:
    return name in _LEFT_OUT.get(package, ())


def names(package: str) -> list[str]:
    """List the modules of a package, except those whose name begins with an underscore."""
    return sorted(
        module.name
        for module in pkgutil.iter_modules([str(_folder(package))])
        if not module.name.startswith('_')
    )


def with_aliases(package: str) -> dict[str, str]:
    """Map every name that can be typed to the module that it stands for."""
    known = {name: name for name in names(package)}
    return known | {a: m for a, m in _ALIASES.get(package, {}).items() if m in known}


def load(package: str, name: str) -> ModuleType:
    return importlib.import_module(f'{package}.{name}')


def help_text(package: str, name: str) -> str:
    """Read a module's docstring without importing it (a verb may import all of rclpy)."""
    folder = _folder(package)
    path = folder / name / '__init__.py'
    if not path.is_file():
        path = folder / f'{name}.py'
    return ast.get_docstring(ast.parse(path.read_bytes())) or ''


def first_line(package: str, name: str) -> str:
    return help_text(package, name).partition('\n')[0]


def _folder(package: str) -> Path:
    return Path(__file__).parent.joinpath(*package.split('.')[1:])
