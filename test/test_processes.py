# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests start, and how they read it."""

import subprocess
import sys

from playpen_testing.processes import Child, find_line
import pytest

SAYS = 'import sys; sys.stdout.write("one\\ntwo\\n"); sys.stderr.write(sys.stdin.read())'


def test_what_was_read_ahead_of_a_line_is_not_lost() -> None:
    pipe = subprocess.PIPE
    with Child([sys.executable, '-u', '-c', SAYS], stdin=pipe, stdout=pipe, stderr=pipe) as child:
        assert child.stdout is not None
        find_line(child.stdout, 'one')
        assert child.communicate('three\n', timeout=20.0) == ('two\n', 'three\n')
        assert child.communicate(timeout=20.0) == ('two\n', 'three\n')
    assert child.returncode == 0


def test_one_that_goes_on_may_be_waited_for_again() -> None:
    with Child(['sleep', '60'], stdout=subprocess.PIPE) as child:
        with pytest.raises(subprocess.TimeoutExpired):
            child.communicate(timeout=0.1)
        child.kill()
        assert child.communicate(timeout=20.0) == ('', '')
