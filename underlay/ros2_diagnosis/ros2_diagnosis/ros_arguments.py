# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Words behind a program that ROS refuses by its grammar, or passes over without a word."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import itertools
from pathlib import Path
import re
import sys

from ros2_diagnosis import nearest, packages, parameter_files
from ros2_diagnosis.finding import Finding

_BEGIN, _END = '--ros-args', '--'
_PARAMETER = ('-p', '--param')
_REMAP = ('-r', '--remap')
_WITH_VALUE = {
    *(*_PARAMETER, *_REMAP, '--params-file', '-e', '--enclave', '--log-level'),
    *('--log-config-file', '--log-file-name'),
}
_SWITCHES = {
    f'--{turn}-{logs}'
    for turn in ('enable', 'disable')
    for logs in ('rosout-logs', 'stdout-logs', 'external-lib-logs')
}
_FILES = {'--params-file', '--log-config-file'}
_ASSIGNS = re.compile(r'[\w~/.:*]+:=.*', re.DOTALL)
_NAME = re.compile(r'[A-Za-z_]\w*')
# Behind no --ros-args rcl still takes these, with a warning (`rcl_parse_arguments`).
_TAKEN_FOR_A_NAME = re.compile(r'.*:=[~/]{0,2}[A-Za-z_][\w/]*')
_NEVER_A_PARAMETER = ('__', '/', '~')
_SAY_IT_THEMSELVES = ('husky_runtime', 'node_program')


def print_hints(package: str, program: str, words: Sequence[str]) -> None:
    """Tell on stderr what is wrong with the words behind a program that is about to run."""
    for finding in itertools.islice(refused(words), 1):  # a node ends at the first
        print(f'hint: {finding}', file=sys.stderr)
    if is_of_a_student(package):
        for finding in passed_over(f'ros2 run {package} {program}', words):
            print(f'hint: {finding}', file=sys.stderr)


def passed_over(command: str, words: Sequence[str]) -> Iterator[Finding]:
    """
    Find what looks like a parameter or another name, but stands behind no --ros-args.

    :param command: what the words stand behind.
    """
    for option, word in zip(['', *words], _for_the_program(words), strict=False):
        if word is None or not (_ASSIGNS.fullmatch(word) or option == '--params-file'):
            continue
        if option in (*_PARAMETER, *_REMAP, '--params-file'):
            shown, mend = f'{option} {word}', f'`{command} {_BEGIN} {option} {word}`'
        else:
            shown = word
            mend = f'`{_BEGIN} -r {word}`'
            if not word.startswith(_NEVER_A_PARAMETER):
                mend = f'`{_BEGIN} -p {word}` for a parameter, {mend} for another name'
        why = f'ROS takes parameters and other names behind {_BEGIN} alone'
        if option != '--params-file' and _TAKEN_FOR_A_NAME.fullmatch(word):
            why = f'without {_BEGIN} ROS takes this for another name, and never for a parameter'
        yield Finding(shown, why, f'write {mend}')


def refused(words: Sequence[str]) -> Iterator[Finding]:
    """Find that at which a node ends when it reads its words behind --ros-args."""
    for option, value in _options(words):
        if option not in _WITH_VALUE:
            yield from _unknown(option)
        elif value is None:
            yield Finding(option, 'nothing stands behind it', f'write {_form(option)}')
        elif option in _FILES:
            why = parameter_files.why_refused(Path(value), only_there=option != '--params-file')
            if why is not None:
                yield Finding(f'{option} {value}', *why)
        elif option in (*_PARAMETER, *_REMAP):
            yield from _wrong_rule(option, value)


def is_of_a_student(package: str) -> bool:
    """Return whether a package is built here and has no programs that refuse words themselves."""
    source = packages.source_of(package)
    if source is None:
        return False
    manifest = (source / 'package.xml').read_text(encoding='utf-8', errors='replace')
    return not any(f'>{name}<' in manifest for name in _SAY_IT_THEMSELVES)


def _for_the_program(words: Sequence[str]) -> Iterator[str | None]:
    """Yield each word that is not for ROS, None for one that is."""
    for_ros = False
    for word in words:
        if word == (_END if for_ros else _BEGIN):
            for_ros = not for_ros
            yield None
        else:
            yield None if for_ros else word


def _options(words: Sequence[str]) -> Iterator[tuple[str, str | None]]:
    """Yield each option that is for ROS with its value, None where it has or takes none."""
    for_ros = False
    rest = iter(words)
    for word in rest:
        if word == (_END if for_ros else _BEGIN):
            for_ros = not for_ros
        elif for_ros and word in _WITH_VALUE:
            yield word, next(rest, None)
        elif for_ros and word not in _SWITCHES and word != _BEGIN:
            yield word, None


def _unknown(word: str) -> Iterator[Finding]:
    if _ASSIGNS.fullmatch(word):
        to_what = '-r' if word.startswith(_NEVER_A_PARAMETER) else '-p'
        mend = f'write `{to_what} {word}`'
        if to_what == '-p':
            mend += f' for a parameter, `-r {word}` for another name'
        yield Finding(word, 'no option stands before it', mend)
    else:
        near = nearest.hint(word, _WITH_VALUE | _SWITCHES, at_most=0) if word[:1] == '-' else ''
        apart = f'what is for the program itself stands before {_BEGIN}, or behind {_END}'
        yield Finding(word, 'ROS has no such option', near.removeprefix('; ') or apart)


def _form(option: str) -> str:
    if option in _PARAMETER:
        return f'`{option} NAME:=VALUE`'
    return f'`{option} OLD:=NEW`' if option in _REMAP else f'its value, as `{option} VALUE`'


def _wrong_rule(option: str, value: str) -> Iterator[Finding]:
    shown = f'{option} {value}'
    old, assigned, new = value.partition(':=')
    if not assigned:
        name, equals, rest = value.partition('=')
        right = f'`{option} {name.rstrip(": ")}:={rest}`' if equals and name and rest else ''
        mend = right or f'{_form(option)}, in one word without blanks'
        yield Finding(shown, 'there is no := in it', f'write {mend}')
    elif not new:
        yield Finding(shown, 'nothing stands behind :=', f'write {_form(option)}')
    elif option in _PARAMETER and new.startswith('[') and not new.rstrip().endswith(']'):
        mend = f"write the whole in quotes, `{option} '{old}:=[A, B]'`"
        yield Finding(shown, 'the list has no end: the shell cuts it at each blank', mend)
    elif option in _REMAP:
        kind = old.rpartition(':')[2]
        if kind == '__ns' and not new.startswith('/'):
            yield Finding(
                shown, 'a namespace begins with /', f'write `{option} {old}:=/{new.strip("/")}`'
            )
        elif kind in ('__node', '__name') and _NAME.fullmatch(new) is None:
            near = re.sub(r'^(?=\d)', '_', re.sub(r'\W', '_', new.strip('/')))
            yield Finding(
                shown,
                'the name of a node is made of letters, digits and _, with no digit first',
                f'write `{option} {old}:={near}`',
            )
        elif any(letter in new for letter in '-. '):
            near = re.sub(r'[-. ]', '_', new)
            yield Finding(
                shown,
                f'{new!r} is no name for ROS, which takes letters, digits, _ and /',
                f'write `{option} {old}:={near}`',
            )
