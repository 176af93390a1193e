# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What was handed in: found in files, folders and exports, and unpacked into workspaces."""

from husky_grader.submission.find import find_submissions
from husky_grader.submission.limits import Limits, Refused
from husky_grader.submission.submission import Submission
from husky_grader.submission.unpack import digest_of, unpack
from husky_grader.submission.workspace import Workspace

__all__ = [
    'Limits',
    'Refused',
    'Submission',
    'Workspace',
    'digest_of',
    'find_submissions',
    'unpack',
]
