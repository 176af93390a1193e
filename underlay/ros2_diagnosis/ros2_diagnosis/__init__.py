# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Faults about which ROS itself is silent: what is wrong, why, and what mends it."""


class PackageError(LookupError):
    """Raised where a package, or an executable of one, is not there; says why and what to do."""
