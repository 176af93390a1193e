# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Rubrics: what a lab asks for, step by step, in a YAML file that is read and checked."""
