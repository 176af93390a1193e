# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of topics: folders with files and a metadata.yaml, as rosbag2 writes them."""
