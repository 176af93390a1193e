# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The files that an MJCF world is made of."""

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

_ROBOT = 'husky.xml'  # beside a world it is the robot there
_NAME_FILES = ('include', 'model')  # MJCF files, which name others in turn
_FOLDERS = ('assetdir', 'meshdir', 'texturedir')


def files_of_world(world: Path) -> tuple[Path, ...]:
    """Return the files that a world is made of, itself first; those that it names in vain not."""
    elements = list(_elements(world))
    folders = ['', *(value for each in elements for value in map(each.get, _FOLDERS) if value)]
    names = [value for each in elements for key, value in each.items() if key.startswith('file')]
    every = [world.parent / folder / name for name in names for folder in folders]
    there = [path for path in (world.with_name(_ROBOT), *every) if path.is_file()]
    return tuple(dict.fromkeys([world, *there]))


def _elements(world: Path) -> Iterator[ElementTree.Element]:
    """Yield the elements of a world, of its robot and of the files that they include."""
    left, seen = [world, world.with_name(_ROBOT)], set()
    while left:
        file = left.pop()
        if file in seen or not file.is_file():
            continue
        seen.add(file)
        try:
            elements = list(ElementTree.parse(file).iter())  # noqa: S314  # of the teaching staff
        except ElementTree.ParseError:  # MuJoCo may read it all the same
            continue
        yield from elements
        left += [
            world.parent / each.get('file', '') for each in elements if each.tag in _NAME_FILES
        ]
