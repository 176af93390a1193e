# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the system tests share: domains, processes, in-process nodes and waiting for facts."""
