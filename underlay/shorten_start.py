#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let programs start sooner: fewer folders to look for libraries in, fewer modules to load.

The wheels put libraries into a dozen folders. Each program that starts where these stand in
LD_LIBRARY_PATH, bash and git too, looks into all of them for each of its libraries. Links to all
in lib, where the others are, make that one folder.

ros_wheels_bootstrapper executes Python anew where LD_LIBRARY_PATH is not set yet. Every Python
imports it, and with it pathlib, re and urllib; afterwards only one that has something to do.

The logger of rclpy asks `inspect` in which file it was called. That looks as well for the module
and for the lines around the call: with the first line that a node logs, after where each module
that is loaded lies, thousands of files. The code of the caller knows its file by itself.

setuptools asks importlib.metadata for entry points at each command of a setup.py, a dozen times in
what colcon has it do for a package, and each time the files of all that is installed are read: a
quarter of the processor's time. They are read once for each sys.path.
"""

from __future__ import annotations

import os
from pathlib import Path
import sysconfig

_IMPORT = 'import ros_wheels_bootstrapper'
# The condition is its own, and its first line of code.
_IMPORT_WHERE_NEEDED = (
    "import os; os.environ.get('_ROS_WHEELS_BOOTSTRAP_COMPLETE') or "
    "__import__('ros_wheels_bootstrapper')"
)
_SEARCHED = 'inspect.getframeinfo(frame).filename'
_KNOWN = 'frame.f_code.co_filename'
_COMMANDS = ('command/egg_info.py', 'command/sdist.py')
_METADATA = '_importlib import metadata\n'
_ASKED = 'metadata.entry_points('
_ANSWER = """
import functools


@functools.lru_cache(maxsize=1)
def _entry_points_on(_path):
    return metadata.entry_points()


def entry_points(**params):
    return _entry_points_on(tuple(sys.path)).select(**params)
"""


def main() -> None:
    site = Path(sysconfig.get_path('purelib'))
    link_libraries(site, Path(sysconfig.get_path('data')) / 'lib')
    load_where_needed(site / 'ros_wheels_bootstrapper.pth')
    take_known_files(site / 'rclpy' / 'impl' / 'rcutils_logger.py')
    read_entry_points_once(site / 'setuptools')


def link_libraries(site: Path, lib: Path) -> None:
    """Link in one folder to the libraries of all; part of each name is a hash of what it holds."""
    for library in sorted(site.glob('ros_*.libs/*')):
        link = lib / library.name
        link.unlink(missing_ok=True)
        link.symlink_to(os.path.relpath(library, lib))


def load_where_needed(start: Path) -> None:
    """Change the line by which Python imports the bootstrapper, if it is the one known here."""
    if start.is_file() and start.read_text(encoding='utf-8').strip() == _IMPORT:
        start.write_text(f'{_IMPORT_WHERE_NEEDED}\n', encoding='utf-8')


def take_known_files(logger: Path) -> None:
    """Let a logger take the file of a caller from its code."""
    text = logger.read_text(encoding='utf-8')
    if _SEARCHED in text:
        logger.write_text(text.replace(_SEARCHED, _KNOWN), encoding='utf-8')


def read_entry_points_once(setuptools: Path) -> None:
    """Let setuptools keep the entry points that it has read, if it is the one known here."""
    source = setuptools / '_importlib.py'
    texts = {
        file: file.read_text(encoding='utf-8')
        for file in (setuptools / name for name in ('dist.py', *_COMMANDS))
    }
    if not all(_METADATA in text and _ASKED in text for text in texts.values()):
        return  # another, or one that keeps them already
    source.write_text(source.read_text(encoding='utf-8') + _ANSWER, encoding='utf-8')
    for file, text in texts.items():
        text = text.replace(_METADATA, '_importlib import entry_points, metadata\n')
        file.write_text(text.replace(_ASKED, 'entry_points('), encoding='utf-8')


if __name__ == '__main__':
    main()
