# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""World files, and what stands in them."""

from husky_sim.world.world import default_worlds, load_world, World

__all__ = ['World', 'default_worlds', 'load_world']
