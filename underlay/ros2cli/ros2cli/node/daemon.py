# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Start, stop and ask the daemon (`ros2cli.daemon`)."""

from __future__ import annotations

import argparse
from collections.abc import Callable
import errno
import os
import select
import subprocess
import sys
from typing import Any
from xmlrpc.client import ServerProxy

from ros2cli import daemon
from ros2cli.helpers import get_ros_domain_id, wait_for

_ENDPOINTS = ('get_publishers_info_by_topic', 'get_subscriptions_info_by_topic')


class DaemonNode:
    """The daemon's node from here: its methods are those of `DirectNode` that look at the graph.

    Tuples come as lists.
    """

    def __init__(self, args: Any) -> None:
        self._args = args
        self._proxy = ServerProxy(daemon.get_xmlrpc_server_url(), allow_none=True)
        self._methods: list[str] = []

    @property
    def connected(self) -> bool:
        """Ask whether the daemon is there, and what it can answer."""
        try:
            listed: Any = self._proxy.system.listMethods()
        except (ConnectionRefusedError, ConnectionResetError):
            return False
        self._methods = [name for name in listed if not name.startswith('system.')]
        return True

    @property
    def methods(self) -> list[str]:
        return self._methods

    def __enter__(self) -> DaemonNode:
        self._proxy.__enter__()
        return self

    def __exit__(self, *error: Any) -> None:
        self._proxy.__exit__(*error)

    def __getattr__(self, name: str) -> Any:
        remote: Callable[..., Any] = getattr(self._proxy, name)
        if name not in _ENDPOINTS:
            return remote
        from ros2cli.marshal import endpoint_info  # takes rclpy

        return lambda *arguments: [endpoint_info(each) for each in remote(*arguments)]


def is_daemon_running(args: Any) -> bool:
    with DaemonNode(args) as node:
        return node.connected


def shutdown_daemon(args: Any, timeout: float | None = None) -> bool:
    """Stop the daemon; False where there is none.

    :param timeout: how many seconds to wait for its end; None: not at all.
    :raises RuntimeError: it did not end in time.
    """
    with DaemonNode(args) as node:
        if not node.connected:
            return False
        node.system.shutdown()
    if timeout is not None and not wait_for(lambda: not is_daemon_running(args), timeout):
        raise RuntimeError(f'the daemon has not ended within {timeout:g} s')
    return True


def spawn_daemon(
    args: Any,  # noqa: ARG001 -- upstream's signature
    timeout: float | None = None,
    debug: bool = False,
) -> bool:
    """Start the daemon; False where there is one.

    The socket is bound here and handed over, so that of two who start it only one does.

    :param timeout: how many seconds to wait until it takes questions; None: not at all.
    :param debug: let it write to this terminal.
    :raises RuntimeError: it ended, or was not ready in time.
    """
    try:
        server = daemon.make_xmlrpc_server()
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            return False
        raise
    ready, tell = os.pipe()
    try:
        process = _start(server.socket.fileno(), tell, debug=debug)
    finally:
        os.close(tell)
        server.server_close()
    try:
        if timeout is not None:
            _wait_until_ready(process, ready, timeout)
    finally:
        os.close(ready)
    return True


# Python would look in the working directory first, where a student may have a queue.py.
_PROGRAM = (
    'import sys; sys.path[:] = filter(None, sys.path); import ros2cli.daemon as it; it.main()'
)


def _start(listening: int, tell: int, *, debug: bool) -> subprocess.Popen[bytes]:
    output = None if debug else subprocess.DEVNULL
    inherited = (listening, tell)
    return subprocess.Popen(
        [
            *(sys.executable, '-c', _PROGRAM),
            *('--ros-domain-id', str(get_ros_domain_id())),
            *('--inherited', *map(str, inherited)),
        ],
        stdin=subprocess.DEVNULL,
        stdout=output,
        stderr=output,
        pass_fds=inherited,
        start_new_session=not debug,
    )


def _wait_until_ready(process: subprocess.Popen[bytes], ready: int, timeout: float) -> None:
    readable, _, _ = select.select([ready], [], [], timeout if timeout >= 0 else None)
    if not readable:
        process.terminate()
        raise RuntimeError(f'the daemon was not ready within {timeout:g} s')
    if not os.read(ready, 16):
        raise RuntimeError(f'the daemon ended with status {process.wait()}')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add nothing: upstream has no option of the daemon here."""
