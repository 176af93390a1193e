# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of the log files of one launch."""

from __future__ import annotations

import contextlib
import datetime
import os
from pathlib import Path
import socket


def logging_directory() -> str:
    """Return $ROS_LOG_DIR, else $ROS_HOME/log, else ~/.ros/log."""
    folder = os.environ.get('ROS_LOG_DIR')
    if not folder:
        folder = str(Path(os.environ.get('ROS_HOME') or '~/.ros') / 'log')
    return os.path.normpath(Path(folder).expanduser())


def make_unique_log_dir(*, base_path: str) -> str:
    """Make a folder named after the time, the host and this process."""
    base = Path(base_path)
    while True:
        stamp = datetime.datetime.now().strftime('%Y-%m-%d-%H-%M-%S-%f')
        folder = base / f'{stamp}-{socket.gethostname()}-{os.getpid()}'
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            if not base.is_dir():
                raise
        else:
            return str(folder)


def renew_latest_log_dir(*, log_dir: str) -> bool:
    """Make 'latest' beside a folder a link to it; return False where it is something else."""
    link = Path(log_dir).parent / 'latest'
    if link.is_symlink():
        link.unlink(missing_ok=True)
    elif link.exists():
        return False
    with contextlib.suppress(FileExistsError):  # another launch was quicker
        link.symlink_to(log_dir, target_is_directory=True)
    return True
