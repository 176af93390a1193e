# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A module of a student's package that its programs do not find: where it is, or what lacks."""

from pathlib import Path
import re

from husky_grader.lab.file_steps import find_manifests

_MISSING = re.compile(
    r"ModuleNotFoundError: No module named '([A-Za-z_]\w*)(?:\.([A-Za-z_]\w*))?'", re.ASCII
)


def misplaced(error: str, workspace: Path) -> str:
    """
    Return why a module that an error names was not installed; nothing where that is not known.

    :param error: see `diagnosis.crash`.
    """
    missing = _MISSING.search(error)
    if missing is None:
        return ''
    packages = find_manifests(workspace)
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
