# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Make the modules of messages load only for who needs it what takes long; set-up runs it once.

    python -m rosidl_typesupport_python.lazy_imports

Each module of messages imports rosidl_generator_py for one small function. With it came the
generator, a parser of IDL and a template engine, an eighth of the time that a node needs to start.
One with an array of fixed length imports numpy, a third of that time; every node loads one such,
for the events of its services, and few ever make its message.
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

_FRONT = '''\
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The front of the package, as rosidl_typesupport_python.lazy_imports has written it."""

from rosidl_generator_py.import_type_support_impl import import_type_support

__all__ = ['generate_py', 'import_type_support']


def __getattr__(name):
    if name != 'generate_py':
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    from rosidl_generator_py.generate_py_impl import generate_py

    return generate_py
'''
_NUMPY = '''\
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Stands in for numpy until something of it is asked for; see the front of the package."""


def __getattr__(name):
    import numpy

    return globals().setdefault(name, getattr(numpy, name))
'''
_IMPORT = 'import numpy  # noqa: E402, I100\n'  # as rosidl_generator_py writes it
_LAZY_IMPORT = 'import rosidl_generator_py.lazy_numpy as numpy  # noqa: E402, I100\n'


def main() -> None:
    """Replace the front of the installed package, and that import in the installed messages."""
    spec = find_spec('rosidl_generator_py')
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError('rosidl_generator_py is not installed')
    front = Path(spec.origin)
    _write(front, _FRONT)
    _write(front.with_name('lazy_numpy.py'), _NUMPY)
    for module in front.parent.parent.glob('*/msg/_*.py'):
        text = module.read_text(encoding='utf-8')
        if _IMPORT in text:
            _write(module, text.replace(_IMPORT, _LAZY_IMPORT))


def _write(path: Path, text: str) -> None:
    new = path.with_suffix('.new')
    new.write_text(text, encoding='utf-8')
    new.replace(path)


if __name__ == '__main__':
    main()
