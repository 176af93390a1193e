# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong in a definition of a message, service or action, in a line each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import contextlib
from difflib import get_close_matches
import io
import keyword
import math
from pathlib import Path
import re

from lark.exceptions import LarkError
from rosidl_adapter import parser
from rosidl_parser.parser import get_ast_from_idl_string

SEPARATORS = {'.msg': 0, '.srv': 1, '.action': 2}
NUMBERS = tuple(name for name in parser.PRIMITIVE_TYPES if name not in ('time', 'duration'))

_FIELD_NAME = 'small letters, digits and single underscores, beginning with a letter'
_CONSTANT_NAME = 'capital letters, digits and single underscores, beginning with a letter'
_OF_C = {'double': 'float64', 'short': 'int16', 'long': 'int64'}
_OF_ROS_1 = {'time': 'builtin_interfaces/Time', 'duration': 'builtin_interfaces/Duration'}

Known = Callable[[str, str], str]
"""Says what is wrong with a message's package and name; nothing where such a message is."""


def mistakes(package: str, folder: Path, path: Path, known: Known) -> Iterator[str]:
    """
    Yield what is wrong in a definition, each with file and line.

    :param path: of the definition, in the package's folder.
    """
    if path.name.endswith(','):
        yield 'CMakeLists.txt: CMake parts files by blanks: take the comma behind the name away'
        return
    if not (folder / path).is_file():
        yield f'{path}: there is no such file; CMakeLists.txt names it'
        return
    try:
        text = (folder / path).read_bytes().decode('utf-8')
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b'\n') + 1
        yield f'{path}:{line}: this is not UTF-8: save the file in that encoding'
        return
    if text.startswith('\ufeff'):
        yield f'{path}:1: the file begins with a byte order mark: save it as UTF-8 without one'
        return
    conflict = re.search('^<{7} ', text, re.MULTILINE)
    if conflict is not None:
        line = text.count('\n', 0, conflict.start()) + 1
        yield (
            f'{path}:{line}: a merge conflict of git begins here: keep one of its two sides, and '
            'remove the lines that begin with <<<<<<<, ======= and >>>>>>>'
        )
        return
    if not parser.is_valid_message_name(path.stem):
        yield (
            f'{path}: {path.stem!r} is no name of an interface: allowed are letters and digits, '
            'beginning with a capital letter, as in AddTwoInts'
        )
    elif path.suffix == '.idl':
        yield from _mistakes_of_idl(path, text)
    elif path.suffix in SEPARATORS:
        yield from _mistakes_of_lines(package, path, text, known)
    else:
        yield f'{path}: allowed are .msg, .srv, .action and .idl'


def _mistakes_of_idl(path: Path, text: str) -> Iterator[str]:
    if path.parent.name not in ('msg', 'srv', 'action'):
        yield f'{path}: a .idl stands in a folder msg, srv or action, which says what it defines'
    try:
        get_ast_from_idl_string(text)
    except LarkError as error:
        last = text.count('\n') + 1
        line = getattr(error, 'line', last)
        why = str(error).splitlines()[0].partition('. Expected')[0]
        yield f'{path}:{line if line > 0 else last}: this is no IDL: {why}'
        return
    other = re.search(r'\b(?:w?char|long\s+double)\b', _without_comments(text))
    if other:
        line = text[: other.start()].count('\n') + 1
        yield f'{path}:{line}: {other[0]} is no type of ROS: use uint8, string or double'


def _without_comments(text: str) -> str:
    """Return IDL with its comments and texts blank, every character in its place."""
    return re.sub(
        r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\])*"',
        lambda found: re.sub(r'[^\n]', ' ', found[0]),
        text,
        flags=re.DOTALL,
    )


def _mistakes_of_lines(package: str, path: Path, text: str, known: Known) -> Iterator[str]:
    names: dict[str, int] = {}
    separators = 0
    for number, line in enumerate(text.splitlines(), 1):
        if line == parser.SERVICE_REQUEST_RESPONSE_SEPARATOR:
            separators += 1
            names.clear()
            continue
        try:
            found = _read_line(package, path.stem, line)
            if found is None:
                continue
            kind, name = found
            if name in names:
                raise ValueError(f'{name!r} stands in line {names[name]} already: rename one')
            if keyword.iskeyword(name):
                raise ValueError(f'{name!r} is a word of Python: choose another name')
            _check_type(kind, known)
            names[name] = number
        except ValueError as error:
            yield f'{path}:{number}: {error}'
    wanted = SEPARATORS[path.suffix]
    if separators != wanted:
        parts = ('fields', 'request, ---, response', 'goal, ---, result, ---, feedback')[wanted]
        yield f'{path}: {separators} lines of ---, not {wanted}: a {path.suffix} has {parts}'


def _read_line(package: str, stem: str, line: str) -> tuple[parser.Type, str] | None:
    """
    Return type and name of the field or constant that a line declares.

    :raises ValueError: if a line declares none, and is not empty.
    """
    code = line.replace('\t', ' ').partition('#')[0].strip()
    if not code:
        return None
    kind, _, rest = code.partition(' ')
    is_constant = '=' in rest
    name = rest.strip().partition('=' if is_constant else ' ')[0].strip()
    if line[0] in ' \t':
        raise ValueError(f'{code!r} does not begin at the margin: take the spaces away')
    if not name:
        raise ValueError(f"{code!r} is no field: write TYPE NAME, as in 'int64 num'")
    if is_constant and not parser.is_valid_constant_name(name):
        value = rest.partition('=')[2].strip()
        raise ValueError(
            f'{name!r} is no name of a constant: allowed are {_CONSTANT_NAME}; a default has '
            f'no =: {f"{kind} {name} {value}"!r}'
        )
    if not is_constant and not parser.is_valid_field_name(name):
        raise ValueError(f'{name!r} is no name of a field: allowed are {_FIELD_NAME}')
    _check_words(kind)
    try:
        with contextlib.redirect_stderr(io.StringIO()):
            spec = parser.parse_message_string(package, stem, code)
    except parser.InvalidResourceName:
        raise ValueError(_no_type(kind)) from None
    except (parser.InvalidSpecification, parser.InvalidValue, TypeError, ValueError) as error:
        raise ValueError(f'{code!r}: {" ".join(str(error).split())}') from None
    except NotImplementedError:
        raise ValueError(f'{code!r}: only numbers, bool and text have defaults') from None
    if spec.constants:
        kind_of_value, value = parser.Type(spec.constants[0].type), spec.constants[0].value
    else:
        kind_of_value, value = spec.fields[0].type, spec.fields[0].default_value
    for number in value if isinstance(value, list) else [value]:
        if isinstance(number, float) and not math.isfinite(number):
            raise ValueError(f'{code!r}: {number} cannot be written in IDL: use a finite number')
    return kind_of_value, name


def _check_words(kind: str) -> None:
    base = re.split(r'[\[<]', kind)[0]
    if base in _OF_ROS_1:
        raise ValueError(f'{base} is of ROS 1: use {_OF_ROS_1[base]}')
    bounds = re.fullmatch(r'[\w/]*(<=[1-9]\d*)?(\[(?:<=)?[1-9]\d*\]|\[\])?', kind)
    if not bounds or (bounds[1] and base not in ('string', 'wstring')):
        raise ValueError(
            f'{kind!r}: allowed are TYPE, TYPE[], TYPE[3], TYPE[<=3], and string<=10 for text'
        )


def _no_type(kind: str) -> str:
    base = re.split(r'[\[<]', kind)[0]
    close = get_close_matches(base.lower(), NUMBERS, 1, 0.5)
    if base in _OF_C:
        close = [_OF_C[base]]
    elif full := re.fullmatch(r'(\w+)/msg/(\w+)', base):  # as programs write it
        close = ['/'.join(full.groups())]
    hint = f'did you mean {close[0]}? ' if close else ''
    return (
        f'{base!r} is no type: {hint}allowed are {", ".join(NUMBERS)}, messages of this package '
        'as Num, and those of others as geometry_msgs/Point'
    )


def _check_type(kind: parser.Type, known: Known) -> None:
    if not kind.is_primitive_type():
        why = known(kind.pkg_name, kind.type)
        if why and kind.type == 'Header' and kind.pkg_name != 'std_msgs':
            raise ValueError('Header alone is of ROS 1: use std_msgs/Header')
        if why:
            close = get_close_matches(kind.type.lower(), NUMBERS, 1, 0.7)
            hint = f'; did you mean {close[0]}?' if close else ''
            raise ValueError(f'{kind.type}: {why}{hint}')
