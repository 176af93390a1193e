# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Get ready, work and end, a second each: a process to test."""

import sys
import time

if __name__ == '__main__':
    print('Starting Up')
    time.sleep(1.0)
    print('Ready')
    if sys.argv[1:]:
        print(f'Called with arguments {sys.argv[1:]}')
    if '--exception' in sys.argv:
        raise RuntimeError('Process had a pretend error')
    try:
        print('Emulating Work')
        time.sleep(1.0)
        print('Done')
    except KeyboardInterrupt:
        pass
    print('Shutting Down')
