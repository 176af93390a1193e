# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A jail in which a student's build and nodes run as somebody else.

    sandbox = find_sandbox()
    with Jail(sandbox, folder) as jail:
        jail.run(['colcon', 'build'], log=log, within_sec=300.0)
"""

from husky_grader.jail.find import find_sandbox, SANDBOXES
from husky_grader.jail.jail import Jail
from husky_grader.jail.limits import Limits
from husky_grader.jail.process import JailedProcess
from husky_grader.jail.removal import remove
from husky_grader.jail.sandbox import MissingSandbox, NoSandbox, Sandbox
from husky_grader.jail.turn import own_turn

__all__ = [
    'SANDBOXES',
    'Jail',
    'JailedProcess',
    'Limits',
    'MissingSandbox',
    'NoSandbox',
    'Sandbox',
    'find_sandbox',
    'own_turn',
    'remove',
]
