# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The daemon: a process that answers what the graph holds, by XML-RPC, as upstream's does.

Commands of this installation do not ask it; verbs of other packages may, by `NodeStrategy`.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
import contextlib
import functools
import os
import socket
import time
from typing import Any
import uuid
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

from ros2cli.helpers import get_ros_domain_id

_BASE_PORT = 11511
_IDLE_TIMEOUT_SEC = 2 * 60 * 60
_POLL_SEC = 0.2
_LONGEST_QUESTION = 100_000  # bytes
_QUESTIONS = (
    'get_name',
    'get_namespace',
    'get_node_names_and_namespaces',
    'get_node_names_and_namespaces_with_enclaves',
    'get_topic_names_and_types',
    'get_service_names_and_types',
    'get_action_names_and_types',
    'get_publisher_names_and_types_by_node',
    'get_publishers_info_by_topic',
    'get_subscriber_names_and_types_by_node',
    'get_subscriptions_info_by_topic',
    'get_service_names_and_types_by_node',
    'get_client_names_and_types_by_node',
    'get_action_server_names_and_types_by_node',
    'get_action_client_names_and_types_by_node',
    'count_publishers',
    'count_subscribers',
    'count_clients',
    'count_services',
)


class RequestHandler(SimpleXMLRPCRequestHandler):
    """Answers the programs of this computer; a page of a browser may send, but is refused."""

    rpc_paths = ('/ros2cli/',)
    timeout = 1.0  # seconds; who says nothing must not keep the others waiting

    def do_POST(self) -> None:  # noqa: N802 -- the name is http.server's
        host = self.headers.get('Host', '').rpartition(':')[0]
        length = self.headers.get('Content-Length', '')
        if 'Origin' in self.headers or host not in ('127.0.0.1', 'localhost'):
            self.send_error(403, 'not for web pages')
        elif not length.isdecimal() or int(length) > _LONGEST_QUESTION:
            self.send_error(413, f'a question has at most {_LONGEST_QUESTION} bytes')
        else:
            super().do_POST()


class Server(SimpleXMLRPCServer):
    """Listens on the port of the domain, which is thereby taken.

    :param inherited: the listening socket of the process that started this one, instead of an own.
    """

    allow_reuse_address = True

    def __init__(self, inherited: socket.socket | None = None) -> None:
        super().__init__(
            get_address(),
            requestHandler=RequestHandler,
            logRequests=False,
            allow_none=True,
            bind_and_activate=inherited is None,
        )
        if inherited is not None:
            self.socket.close()
            self.socket = inherited
            self.server_address = inherited.getsockname()


def get_port() -> int:
    return _BASE_PORT + get_ros_domain_id()


def get_address() -> tuple[str, int]:
    return '127.0.0.1', get_port()


def get_xmlrpc_server_url(address: tuple[str, int] | None = None) -> str:
    host, port = address or get_address()
    return f'http://{host}:{port}{RequestHandler.rpc_paths[0]}'


def make_xmlrpc_server() -> Server:
    """Listen on the port of the domain.

    :raises OSError: another one does (errno.EADDRINUSE).
    """
    return Server()


def serve(
    server: Server,
    *,
    timeout: float = _IDLE_TIMEOUT_SEC,
    on_ready: Callable[[], None] = lambda: None,
) -> None:
    """Answer until somebody asks for the end or nobody has asked for `timeout` seconds."""
    import rclpy

    from ros2cli import marshal
    from ros2cli.node.direct import DirectNode

    asked = time.monotonic()
    stopped = False

    def told(function: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(function)
        def answer(*arguments: Any) -> Any:
            nonlocal asked
            asked = time.monotonic()
            print(f'{function.__name__}({", ".join(map(repr, arguments))})')
            return marshal.plain(function(*arguments))

        return answer

    def stop() -> None:
        nonlocal stopped
        print('shutdown was asked for')
        stopped = True

    settings = argparse.Namespace(
        node_name_suffix=f'_daemon_{get_ros_domain_id()}_{uuid.uuid4().hex}',
        start_type_description_service=False,
    )
    on_ready()  # a question waits from now on until the node knows the others
    with DirectNode(settings) as node:
        server.register_introspection_functions()
        for name in _QUESTIONS:
            server.register_function(told(getattr(node, name)), name)
        server.register_function(stop, 'system.shutdown')
        server.timeout = _POLL_SEC
        print(f'Serving XML-RPC on {get_xmlrpc_server_url()}', flush=True)
        while rclpy.ok() and not stopped and time.monotonic() < asked + timeout:
            server.handle_request()


def main(*, argv: Sequence[str] | None = None) -> None:
    """Serve the domain of the environment."""
    parser = argparse.ArgumentParser(prog='_ros2_daemon')
    parser.add_argument(
        '--ros-domain-id', metavar='N', type=int, help='The domain, to be seen in lists'
    )
    parser.add_argument('--rmw-implementation', help='The middleware, to be seen in lists')
    parser.add_argument(
        '--timeout',
        metavar='N',
        type=int,
        default=_IDLE_TIMEOUT_SEC,
        help='End after N seconds without a question (default: %(default)s)',
    )
    parser.add_argument(
        '--inherited',
        metavar='N',
        nargs=2,
        type=int,
        help='The descriptors of the listening socket, and of the pipe to tell on that it serves',
    )
    args = parser.parse_args(argv)
    listening, ready = args.inherited or (None, None)

    def on_ready() -> None:
        if ready is not None:
            with contextlib.suppress(BrokenPipeError):  # nobody waits for it
                os.write(ready, b'ready')
            os.close(ready)

    with Server(None if listening is None else socket.socket(fileno=listening)) as server:
        serve(server, timeout=args.timeout, on_ready=on_ready)
