# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Many files at once: worker processes, results of earlier calls, tables."""
