# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What programs share that are a node: signals, the end, and what is refused."""

from node_program.program import own_words, refuse, run_node, spin

__all__ = ['own_words', 'refuse', 'run_node', 'spin']
