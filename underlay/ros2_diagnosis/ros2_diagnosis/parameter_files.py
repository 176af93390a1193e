# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why a node refuses a file of parameters, told by its line."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
from pathlib import Path
import re
from typing import Any

from ros2_diagnosis import nearest

_VALUES = 'ros__parameters'
_TAG = 'tag:yaml.org,2002:'
_KINDS = {'int': 'whole numbers', 'float': 'numbers', 'bool': 'true or false', 'str': 'texts'}
_NODE = re.compile(r'[\w/*]*')
_FORM = f'NODE: {_VALUES}: NAME: VALUE, each on a line of its own, two blanks deeper'


def why_refused(path: Path, *, only_there: bool = False) -> tuple[str, str] | None:
    """Say what is wrong with a file and what to do; None where nothing is, or it is not certain.

    :param only_there: it is no file of parameters; it need only be there.
    """
    if not path.is_file():
        there = path.parent.glob('*') if path.parent.is_dir() else ()
        near = nearest.hint(path.name, (each.name for each in there), at_most=0)
        return f'there is no such file in {path.absolute().parent}{near}', 'mend its path'
    if only_there:
        return None
    return next(_faults(path), None)


def _faults(path: Path) -> Iterator[tuple[str, str]]:
    import yaml  # it takes its time, and most programs are given no file

    try:
        text = path.read_text(encoding='utf-8')
        trees = list(yaml.compose_all(text))
    except OSError:
        return
    except UnicodeDecodeError:
        yield 'it is no UTF-8', 'save it as UTF-8'
        return
    except yaml.YAMLError as error:
        yield _why_no_yaml(error, text)
        return
    for tree in trees:
        if isinstance(tree, yaml.MappingNode):
            yield from _of_sections(tree)


def _why_no_yaml(error: Exception, text: str) -> tuple[str, str]:
    mark = getattr(error, 'problem_mark', None)
    line = mark.line if mark is not None else 0
    shown = dict(enumerate(text.splitlines())).get(line, '')
    if '\t' in shown[: len(shown) - len(shown.lstrip())]:
        return f'line {line + 1} begins with a tab', 'YAML takes blanks alone there: write two'
    why = getattr(error, 'problem', None) or ' '.join(str(error).split())
    return f'line {line + 1} is no YAML: {why}', f'write {_FORM}'


def _of_sections(tree: Any, section: str = '') -> Iterator[tuple[str, str]]:
    """Look at what names nodes: a value stands below `ros__parameters` alone."""
    for key, inner in tree.value:
        line = key.start_mark.line + 1
        if key.value == _VALUES and not section:
            yield f'line {line}: {_VALUES} stands below no node', f'write {_FORM}'
        elif key.value == _VALUES:
            yield from _of_values(key, inner)
        elif inner.id == 'mapping' and _NODE.fullmatch(str(key.value)):
            yield from _of_sections(inner, key.value)
        elif inner.id == 'mapping':
            yield (
                f'line {line}: {key.value} is no name of a node',
                'call the node by letters, digits and _ alone, here and where it is made',
            )
        elif nearest.names(section, [_VALUES]):
            yield f'line {line}: {key.value} stands below {section}', f'call that {_VALUES}'
        elif inner.value == '':
            yield f'line {line}: nothing stands below {key.value}', f'write {_FORM}'
        else:
            yield f'line {line}: {key.value} stands below no {_VALUES}', f'write {_FORM}'


def _of_values(key: Any, inner: Any) -> Iterator[tuple[str, str]]:
    line = inner.start_mark.line + 1
    if inner.id == 'mapping':
        for name, value in inner.value:
            if value.id == 'mapping':
                yield from _of_values(name, value)
            elif value.id == 'sequence':
                yield from _of_list(name, value.value)
            elif value.value == '' and value.style is None:
                at = f'line {name.start_mark.line + 1}'
                yield f'{at}: nothing stands behind {name.value}', "write a value, '' for no text"
    elif inner.value == '':
        yield f'line {key.start_mark.line + 1}: nothing stands below {key.value}', f'write {_FORM}'
    elif inner.id == 'scalar':
        blank = ', with a blank behind the colon' if ':' in inner.value else ''
        yield f'line {line}: {inner.value!r} is no NAME: VALUE', f'write {_FORM}{blank}'


def _of_list(name: Any, values: list[Any]) -> Iterator[tuple[str, str]]:
    """Find values of several types, where they are certainly so for rcl as well."""
    kinds = {each.tag.removeprefix(_TAG) for each in values}
    if len(kinds) < 2 or not kinds <= _KINDS.keys() or any(map(_may_be_another, values)):
        return
    at = f'line {name.start_mark.line + 1}'
    if kinds == {'int', 'float'}:
        yield f'{at}: {name.value} has whole numbers and others', 'write all with a point, as 1.0'
    else:
        shown = ' and '.join(kind for tag, kind in _KINDS.items() if tag in kinds)
        yield f'{at}: {name.value} has {shown}', 'write values of one type, texts in quotes'


def _may_be_another(value: Any) -> bool:
    """Tell whether rcl may read a value otherwise: 1e5 is no text for it, 12:30 no number."""
    if value.style is not None:
        return False
    if value.tag != f'{_TAG}str':
        return ':' in value.value or '_' in value.value
    with contextlib.suppress(ValueError):
        float(value.value)
        return True
    return value.value.lower() in ('y', 'n')
