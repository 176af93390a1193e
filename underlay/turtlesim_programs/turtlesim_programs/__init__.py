# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the package turtlesim runs; the package itself has the interfaces."""
