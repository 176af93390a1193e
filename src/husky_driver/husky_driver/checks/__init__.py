# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of what the driver receives: implausible messages, obstacles, a robot that is held."""

from husky_driver.checks.bump import Bump
from husky_driver.checks.plausibility import no_rotation, OdometryCheck

__all__ = ['Bump', 'OdometryCheck', 'no_rotation']
