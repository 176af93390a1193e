# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What Fast DDS prints besides a program's own output."""

import re

# Fast DDS 2.14 prints it to stdout where a node takes a port of shared memory at the moment in
# which another process, of whatever domain, lets go of it; it takes the next, and nothing is lost.
_PORT_RACE = re.compile(
    r'^.*RTPS_TRANSPORT_SHM.*Failed init_port .*open_and_lock_file failed.*\n', re.MULTILINE
)


def without_port_race(output: str) -> str:
    """Return what a program has printed without the harmless lines of Fast DDS."""
    return _PORT_RACE.sub('', output)
