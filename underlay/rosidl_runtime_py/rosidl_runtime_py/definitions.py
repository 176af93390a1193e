# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The texts of interface definitions, and the types that they contain."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
import re

from rosidl_runtime_py.get_interfaces import get_interface_path

_FIELD = re.compile(
    r'(?P<type>(?:[A-Za-z]\w*/)?[A-Z]\w*)(?:\[(?:<=)?\d*\])?\s+[a-z]\w*\s*(?:#.*)?(?:\s+.*)?'
)


@dataclass(frozen=True)
class Line:
    """One line of a definition."""

    text: str
    nested_type: str | None  # 'package/msg/Type' of a field that is a message itself

    @property
    def is_comment(self) -> bool:
        return self.text.lstrip().startswith('#')

    def without_comment(self) -> str:
        """Return the text without a comment at its end."""
        if '"' in self.text or "'" in self.text:
            return self.text  # A default value may hold the sign.
        return self.text.partition('#')[0].rstrip()


def text_of(interface: str) -> str:
    """Return the definition of 'package/msg/Type' as its author wrote it.

    :raises ValueError: the name is not of that form.
    :raises LookupError: there is none.
    """
    return Path(get_interface_path(interface)).read_text(encoding='utf-8')


def lines(interface: str) -> Iterator[Line]:
    """Yield the lines of a definition; raises as `text_of` does."""
    package = interface.partition('/')[0]
    for text in text_of(interface).splitlines():
        yield Line(text.rstrip(), _nested_type(text, package))


def _nested_type(text: str, package: str) -> str | None:
    match = _FIELD.fullmatch(text.strip())
    if match is None or text.lstrip().startswith('#'):
        return None
    name = match['type']
    if '/' in name:
        return name.replace('/', '/msg/')
    return 'std_msgs/msg/Header' if name == 'Header' else f'{package}/msg/{name}'


def contained_types(interface: str) -> list[str]:
    """List the messages that an interface contains, at any depth, each once."""
    found: list[str] = []
    pending = [interface]
    while pending:
        for line in lines(pending.pop(0)):
            if line.nested_type and line.nested_type not in (*found, interface):
                found.append(line.nested_type)
                pending.append(line.nested_type)
    return found
