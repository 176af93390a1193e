# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of a CMakeLists.txt, with their variables filled in (cmake-language(7))."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
import re

from colcon_core.python_install_path import get_python_install_path

_TOKEN = re.compile(
    r"""
    (?P<comment> \#\[(?P<equals>=*)\[ .*? \](?P=equals)\] | \#[^\n]* )
    | (?P<space> [\s;]+ )
    | (?P<open> \( )
    | (?P<close> \) )
    | \[(?P<more>=*)\[\n? (?P<bracket>.*?) \](?P=more)\]
    | "(?P<quoted> (?: \\. | [^"\\] )* )"
    | (?P<plain> (?: \\. | \$\{[^}]*\} | [^\s()\#"\\;] )+ )
    """,
    re.VERBOSE | re.DOTALL,
)
_GLOBS = (('GLOB',), ('GLOB_RECURSE',))
_VARIABLE = re.compile(r'\$\{(\w+)\}')
_ESCAPE = re.compile(r'\\(.)')


class CMakeListsError(ValueError):
    """What stands in a CMakeLists.txt cannot be done here; the message begins with the line."""


@dataclass(frozen=True)
class Command:
    """
    A command and where it stands.

    :param conditions: of the blocks if(...) that it is in, as they are written.
    """

    name: str
    arguments: tuple[str, ...]
    line: int
    conditions: tuple[str, ...]

    def refused(self, why: str) -> CMakeListsError:
        return CMakeListsError(f'CMakeLists.txt:{self.line}: {self.name}(...): {why}')


def _text_of(path: Path) -> str:
    data = path.read_bytes()
    if data.startswith((b'\xff\xfe', b'\xfe\xff')):  # of which CMake tells, too
        raise CMakeListsError('CMakeLists.txt is saved as UTF-16 (Windows): save it as UTF-8')
    return data.decode('utf-8-sig', errors='replace')  # CMake passes over a byte order mark


def read_commands(path: Path) -> Iterator[Command]:
    """
    Yield the commands of a file; set, list and file(GLOB) are done, not yielded.

    :raises CMakeListsError: if there is no such file, or it is not well-formed.
    """
    if not path.is_file():
        raise CMakeListsError('CMakeLists.txt: there is none; package.xml says ament_cmake')
    folder = str(path.parent)
    variables = {
        **dict.fromkeys(('CMAKE_CURRENT_SOURCE_DIR', 'CMAKE_SOURCE_DIR'), folder),
        **dict.fromkeys(('PROJECT_SOURCE_DIR', 'CMAKE_CURRENT_LIST_DIR'), folder),
        'CMAKE_INSTALL_PREFIX': '.',
        'PYTHON_INSTALL_DIR': str(python_folder()),  # ament_cmake_python's
    }
    conditions: list[str] = []
    for name, raw, line in _raw_commands(_text_of(path)):
        if name == 'if':
            conditions.append(' '.join(text for text, _ in raw))
            continue
        if name == 'endif':
            del conditions[-1:]
            continue
        arguments = tuple(_expanded(raw, variables))
        command = Command(name, arguments, line, tuple(conditions))
        if name == 'project':
            variables['PROJECT_NAME'] = arguments[0] if arguments else ''
        elif name == 'set' and arguments:
            if not conditions:
                variables[arguments[0]] = ';'.join(arguments[1:])
        elif name == 'list' and arguments[:1] == ('APPEND',) and len(arguments) > 1:
            before = variables.get(arguments[1], '')
            variables[arguments[1]] = ';'.join(filter(None, (before, *arguments[2:])))
        elif name == 'file' and arguments[:1] in _GLOBS and len(arguments) > 1:
            try:
                variables[arguments[1]] = ';'.join(_glob(path.parent, arguments[2:]))
            except (ValueError, NotImplementedError) as error:
                raise command.refused(f'{error}; allowed is msg/*.msg or the like') from None
        else:
            yield command


def python_folder() -> Path:
    """Return where in a prefix modules are: lib/python3.12/site-packages."""
    base = 'prefix'
    return Path(get_python_install_path('purelib', {'base': base})).relative_to(base)


def _raw_commands(text: str) -> Iterator[tuple[str, list[tuple[str, bool]], int]]:
    """Yield the name of each command, its arguments and whether each is quoted, and its line."""
    name, arguments, begin, depth, position = '', [], 0, 0, 0
    while position < len(text):
        token = _TOKEN.match(text, position)
        line = text.count('\n', 0, position) + 1
        if not token:
            raise CMakeListsError(f'CMakeLists.txt:{line}: {text[position]!r} is not closed')
        position = token.end()
        if token['open']:
            depth += 1
            if depth > 1:
                arguments.append(('(', False))
        elif token['close']:
            depth -= 1
            if depth == 0:
                yield name.lower(), arguments, begin
                name, arguments = '', []
            elif depth < 0:
                raise CMakeListsError(f"CMakeLists.txt:{line}: ')' closes nothing")
            else:
                arguments.append((')', False))
        elif depth == 0 and token['plain']:
            name, begin = token['plain'], line
        elif token['plain'] is not None:
            arguments.append((token['plain'], False))
        elif token['quoted'] is not None:
            arguments.append((token['quoted'], True))
        elif token['bracket'] is not None:
            arguments.append((token['bracket'], True))
    if depth:
        raise CMakeListsError(f"CMakeLists.txt:{begin}: {name}( has no ')'")


def _expanded(raw: list[tuple[str, bool]], variables: dict[str, str]) -> Iterator[str]:
    for text, quoted in raw:
        value = _VARIABLE.sub(lambda found: variables.get(found[1], ''), text)
        value = _ESCAPE.sub(r'\1', value)
        if quoted:
            yield value
        else:
            yield from filter(None, value.split(';'))


def _glob(folder: Path, arguments: tuple[str, ...]) -> list[str]:
    """Return what file(GLOB) finds, without its options, always from the package's folder."""
    skip = {'CONFIGURE_DEPENDS', 'RELATIVE', str(folder)}
    patterns = [argument for argument in arguments if argument not in skip]
    relative = [pattern.removeprefix(f'{folder}/') for pattern in patterns]
    return [
        str(path.relative_to(folder))
        for pattern in relative
        for path in sorted(folder.glob(pattern))
    ]
