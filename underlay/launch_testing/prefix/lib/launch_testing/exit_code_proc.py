# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""End with exit status 1, after a line, without one or by an exception: a process to test."""

import sys

if __name__ == '__main__':
    if '--silent' not in sys.argv:
        if '--exception' in sys.argv:
            raise RuntimeError('Process had a pretend error')
        print('Exiting with a code')
    sys.exit(1)
