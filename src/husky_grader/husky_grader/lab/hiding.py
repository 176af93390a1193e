# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A module of a workspace that hides one of ROS or of Python, which its programs import."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from importlib.util import find_spec
import os
from pathlib import Path
import re

from husky_grader.jail.folders import OWN_PACKAGES
from husky_grader.lab.programs import is_there

# What is raised where a module is not the one that was meant.
_OF_IMPORTS = re.compile(r': (ModuleNotFoundError: |ImportError: |AttributeError: .*\bmodule \')')
_QUOTED = re.compile(r"'([A-Za-z_]\w*)[\w.]*'")
_PLACE = re.compile(r'([A-Za-z_]\w*)\.py line ')


def hiding(error: str, built: Path, environment: Mapping[str, str]) -> str:
    """
    Return that a module which an error names hides another one; nothing if none does.

    :param error: with its place before it, see `diagnosis.crash`.
    :param built: where the workspace was built.
    :param environment: of its programs.
    """
    for name in _named(error):
        for folder in _folders(built, environment):
            is_own = is_there(folder / f'{name}.py') or is_there(folder / name)
            if is_own and _is_installed(name):
                whose = (folder / name).relative_to(built / 'install').parts[0]
                return (
                    f'package {whose} has a module {name} of its own, which hides the one that '
                    'is installed: rename it'
                )
    return ''


def _named(error: str) -> Iterator[str]:
    if found := _PLACE.match(error):
        yield found[1]
    if _OF_IMPORTS.search(error):
        yield from _QUOTED.findall(error)


def _folders(built: Path, environment: Mapping[str, str]) -> Iterator[Path]:
    """Yield the folders of the workspace in which its programs look for modules."""
    given = map(Path, environment.get('PYTHONPATH', '').split(':'))
    found = [folder for folder in given if folder.is_relative_to(built / 'install')]
    found += sorted((built / 'install').glob('*/lib/*'))  # where its programs lie
    for folder in found:
        if Path(os.path.realpath(folder)).is_relative_to(os.path.realpath(built)):
            yield folder


def _is_installed(name: str) -> bool:
    """Tell whether there is such a module besides; those of the lab are not for students."""
    with suppress(ImportError, ValueError):
        return name not in OWN_PACKAGES and find_spec(name) is not None
    return False
