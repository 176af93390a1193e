# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node of a command: a wait ends when its time is over."""

from __future__ import annotations

import subprocess
import sys

import pytest

# The less time a wait has, the likelier it is over while the next step is prepared. A wait that
# does not end holds its process for ever, so it has one of its own.
WAITS = """
from ros2cli.node.direct import command_node
with command_node() as node:
    for number in range(500):
        print(number, flush=True)
        assert not node.spin_until(lambda: False, number % 100 * 1e-7)
    assert node.spin_until(lambda: True, 0.0)
print('all')
"""


@pytest.mark.usefixtures('domain')
def test_a_wait_that_is_over_while_it_is_prepared_ends() -> None:
    with subprocess.Popen(
        [sys.executable, '-c', WAITS], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as process:
        try:
            out, _ = process.communicate(timeout=30)
        except subprocess.TimeoutExpired:
            process.kill()
            pytest.fail(f'wait {process.communicate()[0].split()[-1]} of 500 does not end')
    assert out.endswith('all\n'), out
