# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The sandboxes that work on this machine, for tests that run in each of them."""

from collections.abc import Sequence
from functools import cache
import os

from husky_grader.jail import find_sandbox, NoSandbox, Sandbox, SANDBOXES
import psutil
import pytest


@cache
def _found() -> dict[str, Sandbox]:
    found, failures = {}, {}
    for name in SANDBOXES:
        try:
            found[name] = find_sandbox(name)
        except NoSandbox as failure:
            failures[name] = failure
    # One of these needs nothing that has to be installed; why it fails is seen at once.
    if not {'kernel', 'user'} & set(found):
        raise failures['kernel']
    return found


def _each(*names: str) -> pytest.MarkDecorator:
    found = [each for name, each in _found().items() if name in names]
    return pytest.mark.parametrize('sandbox', found, ids=[each.name for each in found])


_OF_NAMESPACES = ('bwrap', 'kernel')  # with no service or set-up of the user's own
_WITH_NETWORKS = (*_OF_NAMESPACES, 'podman', 'docker')  # and processes for each command

in_each_way = _each(*_WITH_NETWORKS, 'user', 'none')
in_each_sandbox = _each(*_WITH_NETWORKS, 'user')
in_each_way_with_processes = _each(*_WITH_NETWORKS, 'none')
in_each_with_network = _each(*_WITH_NETWORKS)
in_each_of_namespaces = _each(*_OF_NAMESPACES)
in_that_of_the_kernel = _each('kernel')


def as_ordinary_user(command: Sequence[str]) -> list[str]:
    """Return the command that runs another one without the rights of root."""
    # Root loses them in a namespace where it has another number.
    ordinary = ['unshare', '--map-user=1000', '--map-group=1000'] if os.geteuid() == 0 else []
    return [*ordinary, *command]


def running(mark: str) -> list[str]:
    """Return the programs that were started with a mark as their last word."""
    found = []
    for process in psutil.process_iter(['cmdline']):
        words = process.info['cmdline']
        if words and words[-1] == mark and psutil.pid_exists(process.pid):
            found.append(' '.join(words))
    return found
