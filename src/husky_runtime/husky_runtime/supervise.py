# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a command and leave nothing of what it started: `-m husky_runtime.supervise COMMAND`."""

from collections.abc import Mapping, Sequence
import contextlib
import os
import signal
import sys

import psutil

from husky_runtime.children import ChildProcess
from husky_runtime.descendants import (
    adopt_orphans,
    descendants,
    end_processes,
    FIRM_SEC,
    HURRIED_FIRM_SEC,
)
from husky_runtime.shared_memory import clean_shared_memory
from husky_runtime.start import discard_unread, INTERRUPTED, run

END_WITHIN_SEC = 1.0  # the one child of a run has a record to close
POLL_SEC = 0.02


def run_to_end(
    command: Sequence[str],
    environment: Mapping[str, str],
    *,
    ends_by_itself: bool = True,
    reads: bool = False,
) -> int:
    """
    Run a command until it ends, and everything that it has started with it.

    :param ends_by_itself: of one that does not, Ctrl-C is the end, and no interruption.
    :param reads: it has the standard input of this process.
    :returns: its exit status; minus the number of the signal that ended it.
    :raises SystemExit: when a signal has asked this process to end, with 128 and its number.
    """
    adopt_orphans()
    asked: list[int] = []
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    stops: list[int] = []
    before = {
        number: signal.signal(number, lambda number, _: asked.append(number))
        for number in numbers
        # Under nohup the run goes on when its terminal is closed.
        if number != signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN
    }
    before[signal.SIGTSTP] = signal.getsignal(signal.SIGTSTP)
    if before[signal.SIGTSTP] is signal.SIG_DFL:
        signal.signal(signal.SIGTSTP, lambda number, _: stops.append(number))
    firm_sec = FIRM_SEC
    try:
        child = ChildProcess(command, environment, reads=reads)
        while not asked and not child.wait(POLL_SEC):
            if stops:
                stops.clear()  # before: a Ctrl-Z soon after `fg` is another one
                _stop_with_descendants()
        if asked:
            discard_unread()
            firm_sec = HURRIED_FIRM_SEC
        first = signal.SIGINT if signal.SIGINT in asked else signal.SIGTERM
        child.end(first, within_sec=END_WITHIN_SEC, firm_sec=firm_sec)
    finally:
        end_processes(descendants(), firm_sec=firm_sec)
        clean_shared_memory()
        for number, handler in before.items():
            signal.signal(number, handler)
    if asked and (ends_by_itself or asked[0] != signal.SIGINT):
        print('\ninterrupted', file=sys.stderr)
        raise SystemExit(128 + asked[0])
    return child.exit_code or 0


def _stop_with_descendants() -> None:
    """
    Stop as Ctrl-Z asks, until `fg` or `bg`, with everything that this process has started.

    That is in sessions of its own, where the terminal's signals do not reach it.
    """
    started = descendants()
    for process in started:
        with contextlib.suppress(psutil.Error):
            process.suspend()
    handler = signal.signal(signal.SIGTSTP, signal.SIG_DFL)
    signal.raise_signal(signal.SIGTSTP)  # it returns when this process is continued
    signal.signal(signal.SIGTSTP, handler)
    for process in started:
        with contextlib.suppress(psutil.Error):
            process.resume()


def main() -> int:
    status = run_to_end(sys.argv[1:], os.environ, reads=True)  # pytest's debugger does
    return 128 - status if status < 0 else status


def program() -> int:
    return run(lambda: main, interrupted=INTERRUPTED)


if __name__ == '__main__':
    sys.exit(main())
