# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The files by which the grader and its node in the graph of a program speak to each other."""

STEP_FILE = 'step.pickle'  # what is to be found out; of the grader alone, as the folder is
OVER_FILE = 'over'  # is there when the program has ended
FINDING_FILE = 'finding.json'
