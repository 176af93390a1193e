# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which processes come from another, as the kernel tells it, or psutil."""

import os
import subprocess
import sys

from husky_runtime.descendants import pids_below
import pytest

# One that it starts by a thread starts another; each prints its number.
FAMILY = """
import os, subprocess, sys, threading
child = 'import os, subprocess; print(os.getpid(), flush=True); subprocess.run(["sh", "-c", "%s"])'
words = [sys.executable, '-c', child % 'echo $$; read _']
threading.Thread(target=subprocess.run, args=(words,)).start()
"""


@pytest.mark.parametrize('tells', [True, False], ids=['the kernel', 'psutil'])
def test_who_was_started_by_a_thread_or_a_child_is_found(
    tells: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not tells:
        monkeypatch.setattr('husky_runtime.descendants._tells_children', lambda: False)
    with subprocess.Popen(
        [sys.executable, '-c', FAMILY], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdin is not None
        told = [int(process.stdout.readline()) for _ in range(2)]
        assert pids_below(process.pid) == told
        assert {process.pid, *told} <= {*pids_below(os.getpid())}
        process.stdin.close()
    assert pids_below(process.pid) == []
