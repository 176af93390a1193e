# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Starts the programs of this package so that they can be interrupted at any moment.

It takes Python a second to import what they need. Until then nothing is open, so that on an
interrupt the process just goes, where Python would print from amid which import it was torn.
"""

from importlib import import_module
import os
import signal
import sys
from typing import NoReturn

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


def _run(module: str) -> int:
    for number in _SIGNALS:
        signal.signal(number, _leave)
    try:
        return int(import_module(module).main())
    finally:
        # While Python takes itself apart, an interrupt would kill it.
        for number in _SIGNALS:
            signal.signal(number, signal.SIG_IGN)


def _leave(*_: object) -> NoReturn:
    os._exit(0)  # an exception would come up in any import


def main() -> int:
    """Run the simulator."""
    return _run('husky_sim.node')


def replay() -> int:
    """Replay a run."""
    return _run('husky_sim.view.replay')


def view() -> int:
    """Show a running simulator."""
    return _run('husky_sim.view.live')


if __name__ == '__main__':
    sys.exit(main())
