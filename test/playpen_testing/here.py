# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run the main() of a program in the process of the tests, which has loaded ROS already."""

from __future__ import annotations

from collections.abc import Callable
import gc
import importlib
import signal

import pytest

from playpen_testing.fast_dds import without_port_race
from playpen_testing.forks import Ended

_HANDLED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def run_here(capfd: pytest.CaptureFixture[str], module: str, *words: str) -> Ended:
    """
    Run the main() of a module to its end, as its program does; its nodes are real ones.

    What it changes of the process (handlers of signals, collections of garbage) is set back.
    """
    main: Callable[[], int] = importlib.import_module(module).main
    capfd.readouterr()
    handlers = {number: signal.getsignal(number) for number in _HANDLED}
    collections = gc.get_threshold()
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.setattr('sys.argv', [module.rpartition('.')[2], *words])
        try:
            status = main()
        except SystemExit as ended:  # argparse's
            assert isinstance(ended.code, int), ended.code
            status = ended.code
        finally:
            gc.set_threshold(*collections)
            for number, handler in handlers.items():
                signal.signal(number, handler)
    out, err = capfd.readouterr()
    return Ended(status, without_port_race(out), err)
