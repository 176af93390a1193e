# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Names of folders for what others have named: unique, short, and harmless everywhere."""

from collections.abc import Iterable, Sequence
from itertools import count
from pathlib import Path
import unicodedata

_HARMLESS = ' .+()=,@-'  # beside letters, digits and _
_LONGEST_NAME = 100  # bytes


def folder_names(places: Sequence[Path], *, taken: Iterable[str] = ()) -> list[str]:
    """
    Return for each place the name of a folder of its own.

    It is the last part of the place; where several places have the same, also the parts above it,
    as far as these tell them apart.

    :param taken: names that are given already; upper and lower case are the same.
    """
    names = [place.name for place in places]
    if len(set(names)) < len(names):
        parts = [place.absolute().parts[1:] for place in places]
        depth, different = 1, len(set(parts))
        while len({p[-depth:] for p in parts}) < different:
            depth += 1
        names = ['_'.join(p[-depth:]) for p in parts]
    folded = {name.casefold() for name in taken}
    return [_unique(harmless(name), folded) for name in names]


def harmless(name: str) -> str:
    """Return a name that every file system takes, that hides no file, and is no option."""
    kept = (c if is_of_a_word(c) or c in _HARMLESS else '_' for c in composed(name))
    name = ''.join(kept).lstrip(' .-').rstrip(' .')
    return name.encode()[:_LONGEST_NAME].decode(errors='ignore') or 'unnamed'


def composed(name: str) -> str:
    """Return a name with each letter and its accents in one: macOS takes them apart in files."""
    return unicodedata.normalize('NFC', name)


def is_of_a_word(char: str) -> bool:
    """Tell whether it is a letter, a digit, an underscore, or a mark on a letter."""
    return char.isalnum() or unicodedata.category(char) in ('Mn', 'Mc', 'Me', 'Pc')


def _unique(name: str, taken: set[str]) -> str:
    """Add a number where another one has the name; case does not count."""
    numbered = (name if number == 1 else f'{name}_{number}' for number in count(1))
    free = next(candidate for candidate in numbered if candidate.casefold() not in taken)
    taken.add(free.casefold())
    return free
