# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of the tree of frames, in files or live in the browser."""
