# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Hold a new network namespace, with its loopback interface up, while somebody reads the output.

A program, `python -I -S loopback.py`, that imports nothing of ours: it has to start quickly.
Programs of DDS pass over an interface that is not marked for multicast, as lo is at first.
"""

import fcntl
import os
import select
import socket
import struct

# <linux/sockios.h> and <linux/if.h>
_SIOCGIFFLAGS, _SIOCSIFFLAGS = 0x8913, 0x8914
_IFF_UP, _IFF_MULTICAST = 0x1, 0x1000
_REQUEST = '16sh22x'  # struct ifreq of netdevice(7): name, flags


def _raise_loopback() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as control:
        asked = fcntl.ioctl(control, _SIOCGIFFLAGS, struct.pack(_REQUEST, b'lo', 0))
        flags = struct.unpack(_REQUEST, asked)[1] | _IFF_UP | _IFF_MULTICAST
        fcntl.ioctl(control, _SIOCSIFFLAGS, struct.pack(_REQUEST, b'lo', flags))


if __name__ == '__main__':
    _raise_loopback()
    os.write(1, b'ready\n')
    reader = select.poll()
    reader.register(1, 0)  # reports POLLERR, unasked, when nobody can read any more
    reader.poll()
