# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a command and leave nothing of what it started: `-m husky_runtime.supervise COMMAND`."""

from __future__ import annotations

import os
import sys

from husky_runtime.children import run_to_end
from husky_runtime.start import INTERRUPTED, run


def main() -> int:
    status = run_to_end(sys.argv[1:], os.environ)
    return 128 - status if status < 0 else status


def program() -> int:
    return run(lambda: main, interrupted=INTERRUPTED)


if __name__ == '__main__':
    sys.exit(main())
