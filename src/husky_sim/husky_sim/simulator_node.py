# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator's node, for programs that run it with a pace and a referee of their own."""

from husky_sim.ros.node import SimulatorNode, Trial
from husky_sim.ros.pace import Pace, Periods, POLL_SEC

__all__ = ['POLL_SEC', 'Pace', 'Periods', 'SimulatorNode', 'Trial']
