# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The simulator beside a student's program, as a process of its own: it offers what a robot does.

With the true pose, the collisions and `reset` a program could tell what it is to find out.
"""

import sys

from husky_sim.simulator_node import FreePace, main, Trial

if __name__ == '__main__':
    sys.exit(main(trial=Trial(lambda periods: FreePace(periods, 1.0), lambda: None)))
