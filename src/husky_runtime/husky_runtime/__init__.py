# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How programs of the lab start, spin and end; DDS domains and child processes."""
