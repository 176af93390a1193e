# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Start, spin and end programs of the lab; settings, DDS domains and child processes."""
