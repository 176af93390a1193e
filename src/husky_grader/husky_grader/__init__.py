# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Judges runs: checks of courses, runs in process or live, scores, reports, whole classes."""
