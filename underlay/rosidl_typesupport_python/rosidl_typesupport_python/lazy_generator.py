# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Make rosidl_generator_py load its generator only for who asks for it; set-up runs it once.

    python -m rosidl_typesupport_python.lazy_generator

Each module of messages imports that package for one small function. With it came the generator, a
parser of IDL and a template engine, which took an eighth of the time that a node needs to start.
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

_FRONT = '''\
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The front of the package, as rosidl_typesupport_python.lazy_generator has written it."""

from rosidl_generator_py.import_type_support_impl import import_type_support

__all__ = ['generate_py', 'import_type_support']


def __getattr__(name):
    if name != 'generate_py':
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    from rosidl_generator_py.generate_py_impl import generate_py

    return generate_py
'''


def main() -> None:
    """Replace the front of the installed package."""
    spec = find_spec('rosidl_generator_py')
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError('rosidl_generator_py is not installed')
    front = Path(spec.origin)
    new = front.with_suffix('.new')
    new.write_text(_FRONT)
    new.replace(front)


if __name__ == '__main__':
    main()
