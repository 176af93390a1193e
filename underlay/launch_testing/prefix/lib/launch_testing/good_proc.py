# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Count the seconds until Ctrl-C: a process to test."""

import itertools
import sys
import time

if __name__ == '__main__':
    if sys.argv[1:]:
        print(f'Called with arguments {sys.argv[1:]}')
    print('Starting Up')
    try:
        for loop in itertools.count():
            print(f'Loop {loop}')
            time.sleep(1.0)
    except KeyboardInterrupt:
        print('Shutting Down')
