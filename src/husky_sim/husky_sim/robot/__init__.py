# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The Husky: wheels, controller, contacts."""

from husky_sim.robot.husky import JOINTS

__all__ = ['JOINTS']
