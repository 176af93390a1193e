# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Send and receive UDP datagrams of a multicast group, to try a network without ROS."""

from __future__ import annotations

import socket

DEFAULT_GROUP = '225.0.0.1'
DEFAULT_PORT = 49150
_LONGEST_DATAGRAM = 4096


def send(
    data: bytes, *, group: str = DEFAULT_GROUP, port: int = DEFAULT_PORT, ttl: int | None = None
) -> None:
    """Send one datagram; `ttl`: how many networks it may cross (None: as the system has it)."""
    with open_sender(ttl) as sender:
        sender.sendto(data, (group, port))


def receive(
    *, group: str = DEFAULT_GROUP, port: int = DEFAULT_PORT, timeout: float | None = None
) -> tuple[bytes, tuple[str, int]]:
    """Wait for one datagram; return what it holds and the address and port of its sender.

    :param timeout: in seconds; None waits for ever.
    :raises TimeoutError: nothing came.
    """
    with open_receiver(group, port) as receiver:
        receiver.settimeout(timeout)
        data, sender = receiver.recvfrom(_LONGEST_DATAGRAM)
        return data, sender


def open_sender(ttl: int | None = None) -> socket.socket:
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM, socket.IPPROTO_UDP)
    if ttl is not None:
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
    return sender


def open_receiver(group: str = DEFAULT_GROUP, port: int = DEFAULT_PORT) -> socket.socket:
    """Open a socket that has joined a group; others on this computer may do the same."""
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM, socket.IPPROTO_UDP)
    try:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        receiver.bind(('', port))
        membership = socket.inet_aton(group) + socket.inet_aton('0.0.0.0')  # any interface
        receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    except OSError:
        receiver.close()
        raise
    return receiver
