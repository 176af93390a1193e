# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A substitution that cannot become text."""


class SubstitutionFailure(RuntimeError):
    """Raised when the text of a substitution cannot be had."""
