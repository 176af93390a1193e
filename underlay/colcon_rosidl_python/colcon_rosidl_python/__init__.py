# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Builds packages of ament_cmake that need no compiler: interfaces and files."""
