# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Text with ``$(substitutions arguments)`` in it."""

from __future__ import annotations

import re
from typing import Any

from ..substitution import Substitution
from .expose import instantiate_substitution

_NAME = re.compile(r'[A-Za-z][A-Za-z0-9_-]*')


def replace_escaped_characters(data: str) -> str:
    r"""Return the text with ``\x`` replaced by ``x``."""
    return re.sub(r'\\(.)', r'\1', data)


class _Reader:
    """Reads a text from left to right.

    In a quoted part the other kind of quote is plain text, and so are both in the arguments of a
    substitution inside of it.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self.position = 0

    def error(self, what: str) -> ValueError:
        return ValueError(f'{what} at character {self.position + 1} of: {self.text}')

    @property
    def next(self) -> str:
        return self.text[self.position : self.position + 1]

    def at(self, prefix: str) -> bool:
        return self.text.startswith(prefix, self.position)

    def skip_space(self) -> None:
        while self.next.isspace():
            self.position += 1

    def fragments(self, stop: str, quote: str) -> list[Substitution]:
        """Read up to a character of ``stop`` (or the end), which is left unread."""
        from ..substitutions import TextSubstitution

        found: list[Substitution] = []
        plain = ''
        while self.next and self.next not in stop:
            if self.at('$('):
                if plain:
                    found.append(TextSubstitution(text=plain))
                    plain = ''
                found.append(self.substitution(quote))
                continue
            if stop and not quote and self.next in '(\'"':
                raise self.error(f'unexpected {self.next} (escape it with \\ or quote it)')
            if self.next == '\\' and self.position + 1 < len(self.text):
                self.position += 1
            plain += self.next
            self.position += 1
        if plain or not found:
            found.append(TextSubstitution(text=plain))
        return found

    def quoted(self) -> list[Substitution]:
        quote = self.next
        self.position += 1
        found = self.fragments(quote, quote)
        if not self.next:
            raise self.error(f'missing closing {quote}')
        self.position += 1
        if self.next and not self.next.isspace() and self.next != ')':
            raise self.error('expected a space or ) after the quoted text')
        return found

    def substitution(self, quote: str) -> Substitution:
        self.position += 2
        self.skip_space()
        name = _NAME.match(self.text, self.position)
        if name is None:
            raise self.error('expected the name of a substitution after $(')
        self.position = name.end()
        arguments: list[list[Substitution]] = []
        while True:
            self.skip_space()
            if not self.next:
                raise self.error('missing )')
            if self.next == ')':
                self.position += 1
                return instantiate_substitution(name.group(), arguments)
            if quote and self.next == quote:
                raise self.error(f'missing ) before {quote}')
            if not quote and self.next in '\'"':
                arguments.append(self.quoted())
            else:
                arguments.append(self.fragments(' \t\n)' + quote, quote))


def parse_substitution(string_value: str) -> list[Substitution]:
    """Return the substitutions whose joined texts the value means.

    :raises ValueError: it is not well formed; the message shows where.
    """
    return _Reader(str(string_value)).fragments('', '')


def parse_if_substitutions(value: Any) -> Any:
    """Return a value with every text in it parsed; one without substitutions stays text.

    :raises ValueError: it is a list, and its items without substitutions are of several types.
    """
    if not isinstance(value, list):
        return _parse_if_text(value)
    items = [_parse_if_text(item) for item in value]
    kinds = {type(item) for item in items if not isinstance(item, list)}
    if len(kinds) > 1:
        names = ' and '.join(sorted(kind.__name__ for kind in kinds))
        raise ValueError(f'the items of {value} are not of one type, but {names}')
    return items


def _parse_if_text(value: Any) -> Any:
    from ..substitutions import TextSubstitution

    if not isinstance(value, str):
        return value
    parsed = parse_substitution(value)
    if len(parsed) == 1 and isinstance(parsed[0], TextSubstitution):
        return parsed[0].text
    return parsed
