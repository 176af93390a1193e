# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A module of a student's package that its programs do not find, or that is no UTF-8: which."""

import codecs
from pathlib import Path
import re

from husky_course.files import first_bytes

from husky_grader.lab.file_steps import find_manifests

_MISSING = re.compile(
    r"ModuleNotFoundError: No module named '([A-Za-z_]\w*)(?:\.([A-Za-z_]\w*))?'", re.ASCII
)

_NULL_BYTES = 'source code string cannot contain null bytes'
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def misplaced(error: str, workspace: Path) -> str:
    """
    Return why a module that an error names was not loaded; nothing where that is not known.

    :param error: see `diagnosis.crash`.
    """
    packages = find_manifests(workspace)
    if _NULL_BYTES in error:  # Python does not say in which file
        return next(filter(None, (_in_utf_16(each.folder, workspace) for each in packages)), '')
    missing = _MISSING.search(error)
    if missing is None:
        return ''
    package = next((each for each in packages if each.name == missing[1]), None)
    if package is None:
        name = missing[1]
        owner = next((p for p in packages if (p.folder / p.name / f'{name}.py').is_file()), None)
        return f'it is a module of {owner.name}: import {owner.name}.{name}' if owner else ''
    modules = package.folder / package.name
    there = modules.relative_to(workspace).as_posix()
    if missing[2] and not (modules / (file := f'{missing[2]}.py')).exists():
        beside = package.folder / file
        return f'{file} lies beside {there}, move it into that' if beside.is_file() else ''
    if modules.is_dir() and not (modules / '__init__.py').exists():
        return f'{there} has no __init__.py, so that its setup.py finds no package: make one'
    return ''


def _in_utf_16(folder: Path, workspace: Path) -> str:
    for path in sorted(folder.rglob('*.py')):
        if path.is_file() and first_bytes(path, 2) in _UTF_16:
            name = path.relative_to(workspace).as_posix()
            return f'{name} is saved as UTF-16 (Windows: Unicode), save it as UTF-8'
    return ''
