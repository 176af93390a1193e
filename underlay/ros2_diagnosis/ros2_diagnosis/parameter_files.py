# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why a node refuses a file of parameters, told by its line."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ros2_diagnosis import nearest

_VALUES = 'ros__parameters'
_NUMBERS = {'tag:yaml.org,2002:int', 'tag:yaml.org,2002:float'}
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
        tree = yaml.compose(text)
    except OSError:
        return
    except UnicodeDecodeError:
        yield 'it is no UTF-8', 'save it as UTF-8'
        return
    except yaml.YAMLError as error:
        yield _why_no_yaml(error, text)
        return
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
        elif inner.id == 'mapping':
            yield from _of_sections(inner, key.value)
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
            elif value.id == 'sequence' and {each.tag for each in value.value} == _NUMBERS:
                yield (
                    f'line {name.start_mark.line + 1}: {name.value} has whole numbers and others',
                    'write all with a point, as 1.0',
                )
    elif inner.value == '':
        yield f'line {key.start_mark.line + 1}: nothing stands below {key.value}', f'write {_FORM}'
    elif inner.id == 'scalar':
        blank = ', with a blank behind the colon' if ':' in inner.value else ''
        yield f'line {line}: {inner.value!r} is no NAME: VALUE', f'write {_FORM}{blank}'
