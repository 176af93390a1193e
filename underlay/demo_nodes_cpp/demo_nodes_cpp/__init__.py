# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What of a package in C++ pages on parameters cannot do without, in Python."""
