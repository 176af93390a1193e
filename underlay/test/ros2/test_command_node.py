# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node of a command: a wait ends when its time is over, and so does its own end."""

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


# As Fast DDS of the wheels does at times, see ros2cli/ending.py: it holds Python's lock for ever.
NEVER_ENDS = """
import sys
from ros2cli.cli import main
from ros2cli.node.direct import CommandNode
CommandNode._destroy = lambda self: sum(range(10**12))
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.usefixtures('domain')
@pytest.mark.parametrize(
    ('words', 'status', 'said'),
    [
        (('topic', 'echo', '/silence', 'std_msgs/msg/String', '--timeout', '0.1'), 0, []),
        (
            ('action', 'send_goal', '/none', 'turtlesim/action/RotateAbsolute', '{}', '-t', '0.1'),
            1,
            ["No action server for '/none' within 0.1 s"],
        ),
    ],
)
def test_a_participant_that_never_ends_holds_no_command_up(
    words: tuple[str, ...], status: int, said: list[str]
) -> None:
    command = [sys.executable, '-c', NEVER_ENDS, *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=15)
    # Tests beside this one run nodes in other domains.
    told = [line for line in done.stderr.splitlines() if not line.startswith('hint: domain ')]
    assert (done.returncode, told) == (status, said)
