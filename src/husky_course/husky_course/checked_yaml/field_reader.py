# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read the mappings of a YAML file by tables of their fields; every mistake is named at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from difflib import get_close_matches
import re
from typing import Any

from husky_course.checked_yaml.fields import Field, Table
from husky_course.checked_yaml.layout import odd_space
from husky_course.checked_yaml.yaml_tree import FileRefused, Problem, Value

_NUMBER = re.compile(r'[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?', re.ASCII)
_MOST_OF_A_NUMBER = 40
"""Characters; to look for what a longer text may mean takes time by the square of its length."""
_MEASURED = re.compile(r'([-+]?\d*\.?\d+)\s*(?!(?<=0)[xob])([a-zA-Z%°][a-zA-Z/%°]*\d?)', re.ASCII)
_SAME_UNIT = {'%': 'percent', 'sec': 's', 'hz': 'Hz'}
_WHOLE = re.compile(r'[-+]?\d{1,18}', re.ASCII)


class FieldReader:
    """Collects what is wrong while it reads, so that one run shows all of it."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.problems: list[Problem] = []

    def wrong(self, where: Value, name: str, message: str) -> None:
        # Both also look right on a screen, so that the value alone would not tell.
        if found := odd_space(where.text):
            message += f'; it has {found[1]}: write a plain space, or nothing'
        elif where.kind == 'scalar' and re.match(r'-[^ \d.]', where.text):
            message += '; write a space after the dash'
        self.problems.append(Problem(where.line, where.column, name, message))

    def refuse_if_wrong(self) -> None:
        """
        Tell what is wrong.

        :raises FileRefused: with every mistake so far.
        """
        if self.problems:
            raise FileRefused(self.file, self.problems)

    def mapping(self, table: Table, value: Value, name: str) -> Any:
        """Return the dataclass that a mapping becomes; None where something is wrong with it."""
        if value.kind != 'mapping':
            fields = ', '.join(table.required or table.fields)
            self.wrong(
                value, name, f'{value} instead of a {table.noun}; write a mapping: {fields}'
            )
            return None
        before = len(self.problems)
        given = self.fields(value, f'{name}.' if name else '', table.fields)
        self.require(value, name, table)
        return table.made(**given) if len(self.problems) == before else None

    def require(self, mapping: Value, name: str, table: Table) -> None:
        """Notice the fields that a mapping lacks."""
        keys = {key.text for key, _ in mapping.pairs}
        for each in table.required:
            if each not in keys:
                place = f'{name}.{each}' if name else each
                needed = ' and '.join(table.required)
                self.wrong(mapping, place, f'missing; every {table.noun} needs {needed}')

    def fields(
        self, mapping: Value, prefix: str, allowed: Mapping[str, Field]
    ) -> dict[str, object]:
        """Return the values of a mapping by attribute name; wrong ones are left out."""
        seen: dict[str, int] = {}
        result: dict[str, object] = {}
        for key, value in mapping.pairs:
            if key.kind != 'scalar' or key.text not in allowed:
                hint = self.field_hint(key, allowed) or choice(key, allowed)
                self.wrong(key, prefix.rstrip('.'), f'{key} is no field; {hint}')
                continue
            name = prefix + key.text
            if key.text in seen:
                self.wrong(key, name, f'given again; it is already in line {seen[key.text]}')
                continue
            seen[key.text] = key.line
            field = allowed[key.text]
            checked = self.value(field, value, name)
            if checked is not None:
                result[field.attribute] = checked
        return result

    def value(self, field: Field, value: Value, name: str) -> object:
        """Return what a field holds; None where it is wrong."""
        if 'enum' in field.schema:
            return self._word(field, value, name)
        kind = field.schema.get('type')
        if kind is None:
            return self.plain(value, name)
        read = {
            'number': self._number,
            'boolean': self._truth,
            'string': self._text,
            'array': self._list,
            'object': self._mapping,
        }
        return read[kind](field, value, name)

    def item(self, field: Field, value: Value, name: str) -> object:
        """Return an item of a list; None where it is wrong."""
        if field.table is not None:
            return self.mapping(field.table, value, name)
        return self.value(replace(field, schema=field.schema['items']), value, name)

    def plain(self, value: Value, name: str) -> Any:
        """Return lists, mappings, numbers, truth values and texts as they stand there."""
        if value.kind == 'list':
            return [self.plain(item, f'{name}[{i}]') for i, item in enumerate(value.items)]
        if value.kind == 'mapping':
            return {key.text: self.plain(of, f'{name}.{key.text}') for key, of in value.pairs}
        if value.text == '' and not value.quoted:
            self.wrong(value, name, "nothing given; write '' for an empty text")
        if value.quoted or not (value.text in ('true', 'false') or _NUMBER.fullmatch(value.text)):
            return value.text
        if value.text in ('true', 'false'):
            return value.text == 'true'
        return int(value.text) if _WHOLE.fullmatch(value.text) else float(value.text)

    def _number(self, field: Field, value: Value, name: str) -> float | None:
        low, high = field.schema['minimum'], field.schema['maximum']
        allowed = f'allowed is {low:g} to {high:g} {field.unit}'.rstrip()
        if value.kind != 'scalar' or value.quoted or not _NUMBER.fullmatch(value.text):
            why = ' (a number without quotes)' if value.quoted else _number_hint(value, field.unit)
            self.wrong(value, name, f'{value} is not a number{why}; {allowed}')
            return None
        number = float(value.text)
        if not low <= number <= high:
            hint = self.range_hint(field, value)
            self.wrong(value, name, f'{value} is out of range; {allowed}{hint}')
            return None
        return number

    def field_hint(self, key: Value, allowed: Mapping[str, Field]) -> str:
        """Return what a key may have meant that is no field; nothing where unknown."""
        name, colon, value = key.text.partition(':')
        return f"write '{name}: {value}', with a space" if colon and name in allowed else ''

    def range_hint(self, field: Field, value: Value) -> str:  # noqa: ARG002
        """Return what a number may have meant that is out of range; nothing where unknown."""
        return ''

    def _truth(self, _: Field, value: Value, name: str) -> bool | None:
        if value.kind == 'scalar' and not value.quoted and value.text in ('true', 'false'):
            return value.text == 'true'
        near = {'yes': 'true', 'on': 'true', '1': 'true', 'no': 'false', 'off': 'false'}
        near |= {'0': 'false', 'true': 'true', 'false': 'false'}
        meant = near.get(value.text.lower()) if value.kind == 'scalar' else None
        hint = f'; did you mean {meant}?' if meant else ''
        self.wrong(value, name, f'{value} is not allowed; write true or false{hint}')
        return None

    def _word(self, field: Field, value: Value, name: str) -> str | None:
        words = field.schema['enum']
        if value.kind == 'scalar' and value.text in words:
            return value.text
        self.wrong(value, name, f'{value} is not allowed; {choice(value, words)}')
        return None

    def _text(self, field: Field, value: Value, name: str) -> object:
        if value.kind != 'scalar' or value.text == '':
            self.wrong(value, name, f'{value} instead of a text; {_text_hint(value, field)}')
            return None
        if field.parse is None:
            return value.text
        try:
            return field.parse(value.text)
        except ValueError as error:
            self.wrong(value, name, str(error))
            return None

    def _list(self, field: Field, value: Value, name: str) -> tuple[object, ...] | None:
        if value.kind != 'list':
            example = f"write one '{field.example}' a line"
            self.wrong(value, name, f'{value} instead of a list; {example}')
            return None
        least, most = field.schema['minItems'], field.schema['maxItems']
        if not least <= len(value.items) <= most:
            count = len(value.items)
            self.wrong(value, name, f'{count} given; allowed are {least} to {most}')
            if count > most:
                return None  # what is wrong in each of them would be too long a list
        read = [self.item(field, item, f'{name}[{i}]') for i, item in enumerate(value.items)]
        complete = tuple(entry for entry in read if entry is not None)
        return complete if least <= len(complete) == len(read) else None

    def _mapping(self, field: Field, value: Value, name: str) -> object:
        if field.table is not None:
            return self.mapping(field.table, value, name)
        if value.kind != 'mapping':
            self.wrong(value, name, f'{value} instead of a mapping; {field.description}')
            return None
        return self.plain(value, name)


def choice(value: Value, allowed: Iterable[str]) -> str:
    """Return what was meant, and what is allowed."""
    text = value.text if value.kind == 'scalar' else ''
    near = get_close_matches(text.lower()[:40], list(allowed), n=1, cutoff=0.5)
    names = ', '.join(allowed)
    return (f'did you mean {near[0]}? ' if near else '') + f'allowed: {names}'


def _text_hint(value: Value, field: Field) -> str:
    """Return how a placeholder in braces is written, which YAML takes for a mapping."""
    if len(value.pairs) == 1 and str(value.pairs[0][1]) == 'nothing':
        return f"write '{{{value.pairs[0][0].text}}}' in quotes"
    return field.description


def _number_hint(value: Value, unit: str) -> str:
    """Return what to write in the place of what is no number; the field has this unit."""
    text = value.text if value.kind == 'scalar' and len(value.text) <= _MOST_OF_A_NUMBER else ''
    if re.fullmatch(r'[-+]?\d+,\d+', text, re.ASCII):
        return f' (write {text.replace(",", ".")})'
    if re.fullmatch(r'[\u2010-\u2015\u2212]\d*\.?\d+', text, re.ASCII):
        return f' (write -{text[1:]}, with the minus sign of the keyboard)'
    measured = _MEASURED.fullmatch(text)
    if measured is None:
        return ''
    if unit and _SAME_UNIT.get(measured[2], measured[2]) != unit:
        return f' (write it in {unit}, without the unit)'
    return f' (write {measured[1]}, without the unit)'
