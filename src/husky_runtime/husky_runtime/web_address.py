# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where a page is served: a free port, and the token that its address ends in."""

import errno
import os
import re
import secrets
import socket

from husky_runtime.domains import Lock

PORTS_TRIED = 100
LAST_PORT = 65535

TOKEN_VARIABLE = 'HUSKY_VIEW_TOKEN'
"""Environment variable with the token to ask for, so that one page can take over from another."""

_TOKEN = re.compile(r'[A-Za-z0-9_-]{8,64}')
_TOKENS = 10**20
"""So many that nobody can try them all; of digits alone, for whoever types it on a phone."""


class AddressError(Exception):
    """A page cannot be served at the address asked for."""


def free_port(host: str, port: int) -> int:
    """
    Return the first free port from `port` on that nobody has reserved.

    A program that is given a token is the one for which its port is reserved.

    :raises AddressError: if the host is not one of this machine's, or every port is taken.
    """
    if not 0 <= port <= LAST_PORT:
        raise AddressError(f'port {port}: a port is from 1 to {LAST_PORT}')
    try:
        address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except OSError as error:
        raise AddressError(
            f'host {host!r}: {error.strerror}; 127.0.0.1 is this machine alone, '
            '0.0.0.0 lets others of the network look'
        ) from error
    last = min(port + PORTS_TRIED - 1, LAST_PORT)
    for candidate in range(port, last + 1):
        if TOKEN_VARIABLE not in os.environ and _is_reserved(candidate):
            continue
        with socket.socket(address[0], socket.SOCK_STREAM) as trial:
            trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                trial.bind((host, candidate))
            except OSError as error:
                if error.errno in (errno.EADDRINUSE, errno.EACCES, errno.EPERM):
                    continue
                raise AddressError(f'host {host!r}: {error.strerror}') from error
            return candidate
    raise AddressError(f'no free port from {port} to {last}; give another')


def reserve_port(host: str, port: int) -> tuple[int, Lock]:
    """
    Return the first free port from `port` on, and its reservation until it is served or given up.

    :raises AddressError: if the host is not one of this machine's, or every port is taken.
    """
    while True:
        port = free_port(host, port)
        try:
            return port, Lock(_reservation(port))
        except BlockingIOError:
            port += 1


def _is_reserved(port: int) -> bool:
    try:
        Lock(_reservation(port)).close()
    except BlockingIOError:
        return True
    return False


def _reservation(port: int) -> str:
    return f'husky_page_at_port_{port}'


def new_token() -> str:
    """
    Return the token of the environment, or else a new one.

    :raises AddressError: if that of the environment cannot stand in an address.
    """
    token = os.environ.get(TOKEN_VARIABLE) or f'{secrets.randbelow(_TOKENS):020}'
    if not _TOKEN.fullmatch(token):
        raise AddressError(
            f'{TOKEN_VARIABLE}={token!r}: letters, digits, _ and - are allowed, 8 to 64; leave it '
            'out for a new one'
        )
    return token
