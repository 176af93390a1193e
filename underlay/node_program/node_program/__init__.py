# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What programs share that are a node: signals, the end, and what is refused."""

from node_program.program import own_words, refuse, run_node, spin
from node_program.steps import in_steps, Spinner

__all__ = ['Spinner', 'in_steps', 'own_words', 'refuse', 'run_node', 'spin']
