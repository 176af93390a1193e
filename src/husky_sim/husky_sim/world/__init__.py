# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""World files, and what stands in them."""

from husky_sim.world.fixed_frames import CLEARPATH_FRAMES, FIXED_FRAMES, Frame
from husky_sim.world.urdf import urdf_of
from husky_sim.world.world import default_worlds, load_world, World

__all__ = [
    'CLEARPATH_FRAMES',
    'FIXED_FRAMES',
    'Frame',
    'World',
    'default_worlds',
    'load_world',
    'urdf_of',
]
