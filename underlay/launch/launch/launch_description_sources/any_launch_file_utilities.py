# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files of any kind."""

from __future__ import annotations

from collections.abc import Callable
import errno
import functools
from pathlib import Path

from ..frontend import Parser
from ..invalid_launch_file_error import InvalidLaunchFileError
from ..launch_description import LaunchDescription
from .frontend_launch_file_utilities import get_launch_description_from_frontend_launch_file
from .python_launch_file_utilities import get_launch_description_from_python_launch_file

__all__ = ['InvalidLaunchFileError', 'get_launch_description_from_any_launch_file']


def get_launch_description_from_any_launch_file(
    launch_file_path: str, *, parser: type[Parser] = Parser
) -> LaunchDescription:
    """Return the description of a launch file in Python, XML or YAML.

    The name says which it is; where it does not, each is tried.

    :param parser: of the markup languages.
    :raises InvalidLaunchFileError: it cannot be read.
    :raises FileNotFoundError: there is no such file.
    """
    path = str(launch_file_path)
    if not Path(path).is_file():
        # A missing file is no file of a wrong format.
        raise FileNotFoundError(errno.ENOENT, 'there is no such launch file', path)
    loaders: list[Callable[[str], LaunchDescription]] = [
        get_launch_description_from_python_launch_file,
        functools.partial(get_launch_description_from_frontend_launch_file, parser=parser),
    ]
    known = True
    if path.endswith('.py'):
        loaders = loaders[:1]
    elif Parser.is_filename_valid(path):
        loaders = loaders[1:]
    else:
        known = False
    errors: list[Exception] = []
    for loader in loaders:
        try:
            return loader(path)
        except InvalidLaunchFileError as error:
            errors.extend(error._likely_errors)
        except Exception as error:
            errors.append(error)
    extension = Path(path).suffix[1:] if known else ''
    raise InvalidLaunchFileError(extension, likely_errors=errors)
