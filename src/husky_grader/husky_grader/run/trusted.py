# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The grader's own programs that meet those of others on a network, each a process of its own."""

import resource
import sys

MEMORY_BYTES = 2_000_000_000  # several times what a run needs; what others send may be any amount


def trusted(module: str, *words: str) -> list[str]:
    """Return the command that runs one of them; name files by whole paths."""
    # `python -m` looks first where it starts, which may be a folder that somebody has handed in.
    return ['env', '-C', '/', sys.executable, '-m', module, *words]


def limit_memory() -> None:
    """Let this process end, not the machine, when others make it keep too much."""
    hard = resource.getrlimit(resource.RLIMIT_DATA)[1]
    most = MEMORY_BYTES if hard == resource.RLIM_INFINITY else min(MEMORY_BYTES, hard)
    resource.setrlimit(resource.RLIMIT_DATA, (most, hard))
