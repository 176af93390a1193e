# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of the log files of one launch."""

from __future__ import annotations

import datetime
import os
from pathlib import Path
import socket
import tempfile
import warnings


def logging_directory() -> Path:
    """Return $ROS_LOG_DIR, else $ROS_HOME/log, else ~/.ros/log."""
    folder = os.environ.get('ROS_LOG_DIR')
    if not folder:
        folder = str(Path(os.environ.get('ROS_HOME') or '~/.ros') / 'log')
    return Path(os.path.normpath(Path(folder).expanduser()))


def make_unique_log_dir(*, base_path: Path) -> Path:
    """Make a folder named after the time, the host and this process."""
    while True:
        stamp = datetime.datetime.now().strftime('%Y-%m-%d-%H-%M-%S-%f')
        folder = base_path / f'{stamp}-{socket.gethostname()}-{os.getpid()}'
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            if not base_path.is_dir():
                raise
        else:
            return folder


def _link_latest(folder: Path) -> None:
    link = folder.parent / 'latest'
    try:
        if link.is_symlink():
            link.unlink()
        link.symlink_to(folder, target_is_directory=True)
    except FileExistsError:
        return  # another launch was quicker, or it is a folder of the user's
    except OSError as error:
        warnings.warn(f'Cannot create a symlink to latest log directory: {error}', stacklevel=2)


def new_log_folder() -> Path:
    """Make the folder, in the temporary folder where the proper one cannot be written."""
    base = logging_directory()
    try:
        folder = make_unique_log_dir(base_path=base)
    except OSError as error:
        folder = make_unique_log_dir(base_path=Path(tempfile.gettempdir()) / 'ros-log')
        warnings.warn(
            f'cannot write logs below {base} ({error.strerror}): they go to {folder}; set '
            'ROS_LOG_DIR to a folder you may write',
            stacklevel=2,
        )
        return folder
    _link_latest(folder)
    return folder
