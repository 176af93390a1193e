# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A jail where root may make no namespaces: the tests of jails once more, as in a container."""

from pathlib import Path
import subprocess
import sys

from playpen_testing.container import in_container
import pytest

SUBJECTS = ('', '_attacks', '_graph', '_watch')
FILES = [Path(__file__).with_name(f'test_jail{subject}.py') for subject in SUBJECTS]
FIND = 'from husky_grader.jail import find_sandbox; print(find_sandbox().name)'


def test_in_a_container_another_user_is_found() -> None:
    found = subprocess.run(
        in_container([sys.executable, '-c', FIND]), capture_output=True, text=True
    )
    assert found.stdout == 'user\n', found.stderr


@pytest.mark.timeout(180)
def test_a_jail_of_another_user_holds() -> None:
    tests = [sys.executable, '-m', 'pytest', '-k', 'user', *map(str, FILES)]
    done = subprocess.run(in_container(tests), capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    assert ' passed' in done.stdout
