# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is written down of a simulation while it runs."""

from husky_sim.recording.recorder import loose_bodies, MOVED, RunRecorder

__all__ = ['MOVED', 'RunRecorder', 'loose_bodies']
