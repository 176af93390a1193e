# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Packages of messages whose fields are drawn at random, written as a student writes them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from random import Random

_NUMBERS = (
    *('bool', 'byte', 'char', 'float32', 'float64', 'int8', 'uint8', 'int16', 'uint16'),
    *('int32', 'uint32', 'int64', 'uint64'),
)
_OTHERS = ('string', 'string<=6', 'wstring', 'wstring<=6')
_OF_WHEELS = ('builtin_interfaces/Time', 'geometry_msgs/Pose', 'std_msgs/Header', 'std_msgs/Empty')
_SUFFIXES = ('', '', '', '[]', '[3]', '[<=2]')
_MANIFEST = """\
<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>for tests</description>
  <maintainer email="someone@example.org">someone</maintainer>
  <license>Apache-2.0</license>
  {depends}
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
_DEPENDENCIES = ('builtin_interfaces', 'geometry_msgs', 'std_msgs')


def random_definition(random: Random, others: Sequence[str]) -> str:
    """Return a message of up to twelve fields, some of them messages of its package."""
    kinds = (*_NUMBERS, *_OTHERS, *random.choices(_OF_WHEELS, k=2), *others[-3:])
    lines = [
        f'{random.choice(kinds)}{random.choice(_SUFFIXES)} f{i}'
        for i in range(random.randint(0, 12))
    ]
    return '\n'.join(lines) + '\n'


def write_package(folder: Path, definitions: dict[str, str]) -> None:
    """Write a package of messages, by their names; the folder's name is the package's."""
    (folder / 'msg').mkdir(parents=True)
    for name, text in definitions.items():
        (folder / 'msg' / f'{name}.msg').write_text(text)
    depends = '\n  '.join(f'<depend>{name}</depend>' for name in _DEPENDENCIES)
    (folder / 'package.xml').write_text(_MANIFEST.format(name=folder.name, depends=depends))
    files = '\n  '.join(f'"msg/{name}.msg"' for name in definitions)
    finds = '\n'.join(
        f'find_package({name} REQUIRED)' for name in ('rosidl_default_generators', *_DEPENDENCIES)
    )
    (folder / 'CMakeLists.txt').write_text(
        f'project({folder.name})\n{finds}\n'
        f'rosidl_generate_interfaces(${{PROJECT_NAME}}\n  {files}\n'
        f'  DEPENDENCIES {" ".join(_DEPENDENCIES)}\n)\n'
    )


def write_random_package(folder: Path, count: int, random: Random) -> list[str]:
    """Write a package of so many messages, and return their names."""
    definitions: dict[str, str] = {}
    for i in range(count):
        definitions[f'Random{i}'] = random_definition(random, list(definitions))
    write_package(folder, definitions)
    return list(definitions)
