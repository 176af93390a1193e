# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files in Python."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from ..launch_description import LaunchDescription
from ..source_location import located_error, register_launch_file, traceback_location
from ..utilities.encoding import refuse_utf_16
from ..utilities.typing_file_path import FilePath


class InvalidPythonLaunchFileError(Exception):
    """Raised when a Python file is not a launch file."""


def load_python_launch_file_as_module(python_launch_file_path: FilePath) -> ModuleType:
    """Return the file as a module that no import finds."""
    path = str(python_launch_file_path)
    module = ModuleType('python_launch_file')
    module.__file__ = path
    register_launch_file(path)
    refuse_utf_16(path)
    code = compile(Path(path).read_bytes(), path, 'exec')
    exec(code, module.__dict__)
    return module


def get_launch_description_from_python_launch_file(
    python_launch_file_path: FilePath,
) -> LaunchDescription:
    """Return what ``generate_launch_description()`` of the file returns.

    :raises InvalidPythonLaunchFileError: there is no such function, or it returns something else.
    """
    path = str(python_launch_file_path)
    try:
        module = load_python_launch_file_as_module(path)
        generate = getattr(module, 'generate_launch_description', None)
        if generate is None:
            raise InvalidPythonLaunchFileError(
                f"launch file at '{path}' does not contain the required function "
                "'generate_launch_description()'"
            )
        description = generate()
    except SyntaxError as error:
        located_error(error, (error.filename or path, error.lineno or 1))
        raise
    except Exception as error:
        located_error(error, traceback_location(error.__traceback__))
        raise
    if not isinstance(description, LaunchDescription):
        raise InvalidPythonLaunchFileError(
            f"generate_launch_description() of '{path}' returns {description!r}, not a "
            'LaunchDescription'
        )
    return description
