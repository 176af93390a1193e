# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The page of a drive: first the live one, then the replay of the run, at the same address."""

from collections.abc import Mapping
from dataclasses import dataclass
import os
from pathlib import Path
import sys

from ament_index_python import get_resource, get_resources
from husky_runtime.browser import open_when_served
from husky_runtime.domains import Lock
from husky_runtime.supervise import run_to_end
from husky_runtime.web_address import new_token, reserve_port, TOKEN_VARIABLE

HOST, FIRST_PORT = '127.0.0.1', 8080
REPLAYS = 'husky_grader.replay'
"""Type of the resource in the ament index by which a package registers a program for replays."""


@dataclass(frozen=True)
class DrivePage:
    """
    Where the page of a drive is.

    :param opens: whether this desktop's browser is to open it.
    :param reservation: of its port, or a view that starts meanwhile would take it.
    """

    port: int
    token: str
    opens: bool
    reservation: Lock

    @property
    def environment(self) -> dict[str, str]:
        """What the programs of the page need in their environment."""
        return {TOKEN_VARIABLE: self.token}

    @property
    def launch_arguments(self) -> dict[str, str]:
        """The arguments of drive.launch.py."""
        return {
            'viewer': 'true',
            'viewer_port': str(self.port),
            'wait_for_tab': str(self.opens).lower(),
        }

    def open(self) -> None:
        """Open it in this desktop's browser, if it is to be, as soon as it is served."""
        if self.opens:
            open_when_served(f'http://localhost:{self.port}/{self.token}/')

    def replay(self, folder: Path, environment: Mapping[str, str]) -> None:
        """Play the run of a report's folder on it, until Ctrl-C; nothing where no package can."""
        for package in list(get_resources(REPLAYS))[:1]:
            program = get_resource(REPLAYS, package)[0].strip()
            command = ['ros2', 'run', package, program, str(folder), '--port', str(self.port)]
            run_to_end(command, {**environment, **self.environment}, ends_by_itself=False)


def drive_page(opens: bool | None) -> DrivePage:
    """
    Choose the address of a page.

    :param opens: whether a browser is to open it; None: on a desktop.
    :raises AddressError: if there is no free port.
    """
    token = new_token()
    port, reservation = reserve_port(HOST, FIRST_PORT)
    return DrivePage(port, token, _is_on_a_desktop() if opens is None else opens, reservation)


def is_at_a_terminal() -> bool:
    """Tell whether somebody can press Ctrl-C here; some services for CI have a terminal, too."""
    return sys.stdin.isatty() and sys.stdout.isatty() and not os.environ.get('CI')


def _is_on_a_desktop() -> bool:
    """Tell whether somebody sits at this machine's own screen."""
    given = os.environ.get
    screen = given('DISPLAY') or given('WAYLAND_DISPLAY')
    return is_at_a_terminal() and bool(screen) and not given('SSH_CONNECTION')
