# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Judges runs: check of a course, rehearsal, score, live runs, classes, reports."""
