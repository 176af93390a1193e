# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A module of a student's package that its programs do not find: where it lies, or what lacks."""

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
    package = missing and next(
        (each for each in find_manifests(workspace) if each.name == missing[1]), None
    )
    if not (missing and package):
        return ''
    modules = package.folder / package.name
    there = modules.relative_to(workspace).as_posix()
    if missing[2] and not (modules / (file := f'{missing[2]}.py')).exists():
        beside = package.folder / file
        return f'{file} lies beside {there}, move it into that' if beside.is_file() else ''
    if modules.is_dir() and not (modules / '__init__.py').exists():
        return f'{there} has no __init__.py, so that its setup.py finds no package: make one'
    return ''
