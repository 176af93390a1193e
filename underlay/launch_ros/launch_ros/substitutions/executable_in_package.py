# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Executables of packages."""

from __future__ import annotations

import difflib
import os
from pathlib import Path

from launch.frontend import expose_substitution
from launch.launch_context import LaunchContext
from launch.logging import get_logger
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import MarkupArguments
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from ros2_diagnosis import programs, stand_ins

from .find_package import FindPackagePrefix


@expose_substitution('exec-in-pkg')
class ExecutableInPackage(FindPackagePrefix):
    """Becomes the path of an executable of a package."""

    _arguments = MarkupArguments(
        'executable', 'package', of='exec-in-pkg substitution', error=AttributeError
    )

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        super().__init__(package)
        self.executable = normalize_to_list_of_substitutions(executable)

    def describe(self) -> str:
        package = ' + '.join(sub.describe() for sub in self.package)
        executable = ' + '.join(sub.describe() for sub in self.executable)
        return f'ExecInPkg(pkg={package}, exec={executable})'

    def perform(self, context: LaunchContext) -> str:
        executable = perform_substitutions(context, self.executable)
        package = perform_substitutions(context, self.package)
        folder = Path(super().perform(context)) / 'lib' / package
        path = folder / executable
        if path.is_file() and os.access(path, os.X_OK):
            why = programs.why_unrunnable(path)
            if why is not None:  # a prefix may yet run it
                get_logger('launch_ros').warning(f"executable '{path}' cannot be run: {why}")
            return str(path)
        known = _executables(folder)
        near = difflib.get_close_matches(executable, known, 1)
        if why := programs.why_not_executable(path):
            hint = why
        elif instead := stand_ins.hint_of_missing_part(package, executable):
            hint = instead
        elif not folder.is_dir():
            hint = 'the package has none (is it built? does its setup.cfg name the folder?)'
        else:
            hint = f"is '{near[0]}' meant?" if near else f'there are: {", ".join(known) or "none"}'
        raise SubstitutionFailure(
            f"executable '{executable}' not found on the libexec directory '{folder}': {hint}"
        )


def _executables(folder: Path) -> list[str]:
    if not folder.is_dir():
        return []
    return sorted(
        entry.name for entry in folder.iterdir() if entry.is_file() and os.access(entry, os.X_OK)
    )
