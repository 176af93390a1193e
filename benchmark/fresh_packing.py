# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Let 200 fresh processes pack every message of the simulator, each over memory of another byte.

In each, the middleware must read what was packed, in every field, and the bytes must be those of
every other process. Prints how many did so; exit status 1 unless all.

Run it with:  ./lab exec python benchmark/fresh_packing.py [--processes 200]
"""

from __future__ import annotations

import argparse
from collections import Counter
from hashlib import sha256
import os
import subprocess
import sys

from husky_sim.messages.layouts import packed_messages
from husky_sim.messages.packed_message import prove

DIGITS = 64


def digest() -> str:
    """Return the digest of all bytes that this process packs."""
    for message in packed_messages():
        prove(message)
    return sha256(b''.join(map(bytes, packed_messages()))).hexdigest()


def pack(byte: int) -> str:
    """Return the digest of all bytes, or what was wrong."""
    # glibc fills memory with this byte's complement before it hands it out.
    environment = {**os.environ, 'MALLOC_PERTURB_': str(byte)}
    done = subprocess.run(
        [sys.executable, __file__, '--here'], env=environment, capture_output=True, text=True
    )
    return (done.stdout if done.returncode == 0 else done.stderr).strip()


def main() -> int:
    """Print what the processes had."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--processes', type=int, default=200)
    parser.add_argument('--here', action='store_true', help='pack once, in this process')
    given = parser.parse_args()
    if given.here:
        print(digest())
        return 0
    count = given.processes
    had = Counter(pack(number % 255 + 1) for number in range(count))
    for what, times in had.most_common():
        print(f'{times} of {count}: {what}')
    return int(any(len(what) != DIGITS for what in had) or len(had) > 1)


if __name__ == '__main__':
    sys.exit(main())
