# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The sandboxes that work on this machine, for tests that run in each of them."""

from functools import cache

from husky_grader.jail import find_sandbox, NoSandbox, Sandbox, SANDBOXES
import pytest


@cache
def _found() -> dict[str, Sandbox]:
    found = {}
    for name in SANDBOXES:
        try:
            found[name] = find_sandbox(name)
        except NoSandbox:
            # This one needs nothing that has to be installed; why it fails is seen at once.
            if name == 'kernel':
                raise
    return found


def _each(*names: str) -> pytest.MarkDecorator:
    found = [each for name, each in _found().items() if name in names]
    return pytest.mark.parametrize('sandbox', found, ids=[each.name for each in found])


in_each_way = _each('bwrap', 'podman', 'docker', 'kernel', 'none')
in_each_sandbox = _each('bwrap', 'podman', 'docker', 'kernel')
in_each_of_namespaces = _each('bwrap', 'kernel')  # with no service or set-up of the user's own
