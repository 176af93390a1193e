# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Open a page in this desktop's browser, as soon as it is served: `-m husky_runtime.browser`.

The browser may be started by that. It must outlive the program that wanted it, which ends whatever
it has started; so it is started by a process that is nobody's child any more.
"""

import os
import subprocess
import sys
import time
import urllib.error
import urllib.request
import webbrowser

PATIENCE_SEC = 60.0
POLL_SEC = 0.1

_PAGE = 'PLAYPEN_PAGE'  # environment variable: other users can read command lines
_LIBRARIES = 'LD_LIBRARY_PATH'


def open_when_served(address: str) -> None:
    """
    Open a page; returns at once.

    Call it before this process becomes the parent of orphans (`descendants.adopt_orphans`).
    """
    environment = {**os.environ, _PAGE: address}
    # A browser must not get the libraries that the wheels of ROS bring.
    paths = environment.pop(_LIBRARIES, '').split(':')
    if others := ':'.join(path for path in paths if not path.startswith(sys.prefix)):
        environment[_LIBRARIES] = others
    command = [sys.executable, '-m', __name__]
    # Python looks first where it starts, which may be a folder that somebody has handed in.
    subprocess.run(command, cwd='/', env=environment, stdin=subprocess.DEVNULL, check=False)


def main() -> int:
    address, wanted_by = os.environ.pop(_PAGE), os.getppid()
    if os.fork():
        return 0
    os.setsid()
    end_sec = time.monotonic() + PATIENCE_SEC
    while time.monotonic() < end_sec and _lives(wanted_by):
        try:
            with urllib.request.urlopen(address, timeout=PATIENCE_SEC):
                break
        except urllib.error.HTTPError:
            return 1  # another program is there
        except OSError:
            time.sleep(POLL_SEC)
    else:
        return 1
    quiet = os.open(os.devnull, os.O_WRONLY)  # browsers say much
    os.dup2(quiet, 1)
    os.dup2(quiet, 2)
    return 0 if webbrowser.open(address) else 1


def _lives(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except OSError:
        return False
    return True


if __name__ == '__main__':
    sys.exit(main())
