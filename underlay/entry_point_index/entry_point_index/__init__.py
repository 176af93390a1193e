# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Entry points of the installed distributions, and what they say of themselves, without importing.

importlib.metadata takes longer for it than the whole of `ros2 --help`. Read are the files
entry_points.txt of the folders on sys.path (packaging.python.org, "Entry points specification").
"""

from __future__ import annotations

import functools
import importlib
from importlib.machinery import PathFinder
import os
import sys
from typing import Any


def entry_points(group: str) -> dict[str, str]:
    """Map the names in a group to 'module' or 'module:attribute'; the first on sys.path counts."""
    found: dict[str, str] = {}
    for text in _texts():
        inside = False
        for line in map(str.strip, text.splitlines()):
            if line.startswith('['):
                inside = line == f'[{group}]'
            elif inside and '=' in line and not line.startswith(('#', ';')):
                name, _, target = line.partition('=')
                found.setdefault(name.strip(), target.partition('[')[0].strip())
    return found


def load(target: str) -> Any:
    """Import what an entry point names."""
    module, _, attributes = target.partition(':')
    found: Any = importlib.import_module(module)
    for name in filter(None, attributes.split('.')):
        found = getattr(found, name)
    return found


def docstring(target: str) -> str:
    """Return the docstring of 'module:Class' from its source; import it only where that fails."""
    import ast  # only help needs it
    import textwrap

    module, _, name = target.partition(':')
    source = _source(module)
    if source is not None:
        with open(source, 'rb') as file:  # noqa: PTH123 -- pathlib takes its time
            tree = ast.parse(file.read())
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and node.name == name:
                text = (ast.get_docstring(node, clean=False) or '').strip()
                first, _, others = text.partition('\n')
                if text:
                    return f'{first}\n{textwrap.dedent(others)}'.strip()
    import inspect  # takes a tenth of the time of `ros2 --help`

    return inspect.getdoc(load(target)) or ''


def _source(module: str) -> str | None:
    """Find the file of a module without importing its packages."""
    path = None
    parts = module.split('.')
    for end in range(1, len(parts) + 1):
        spec = PathFinder.find_spec('.'.join(parts[:end]), path)
        if spec is None:
            return None
        path = spec.submodule_search_locations
    return spec.origin if spec and spec.origin and spec.origin.endswith('.py') else None


@functools.cache
def _texts() -> tuple[str, ...]:
    texts = []
    for folder in sys.path:
        try:
            names = os.listdir(folder or '.')  # noqa: PTH208 -- as above
        except OSError:
            continue
        for name in sorted(names):
            if name.endswith(('.dist-info', '.egg-info')):
                path = f'{folder or "."}/{name}/entry_points.txt'
                try:
                    with open(path, encoding='utf-8') as file:  # noqa: PTH123 -- as above
                        texts.append(file.read())
                except OSError:
                    continue
    return tuple(texts)
