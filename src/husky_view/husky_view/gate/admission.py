# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Who may use the page: whoever knows its token, from a page of its own, under a name of this server.

A browser carries any website's requests to this machine. Three things keep them out, each by
itself: the address ends in a token, which only the terminal tells; a websocket must come from the
page itself (RFC 6455, section 10.2, Origin); and the server answers to its own names only, or a
website could give this machine a name of its own (DNS rebinding).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
import hmac
from http import HTTPStatus
from ipaddress import ip_address
import socket
from urllib.parse import urlsplit


@dataclass(frozen=True)
class Refusal:
    """Why a request is refused."""

    status: HTTPStatus
    reason: str


class Admission:
    """
    Admits requests.

    The page may be asked for under every IP address, to which a browser goes without a name that
    somebody else could give, as localhost, and by the name of the machine.

    :param host: where the page is served.
    :param names: more names that the user allows, as of a proxy in front.
    :raises ValueError: if one of them is no name.
    """

    def __init__(self, token: str, *, host: str, names: Iterable[str] = ()) -> None:
        self.token = token
        self._allowed = frozenset(name.lower() for name in names)
        for name in self._allowed:
            if _name_in(name) != name:
                raise ValueError(
                    f'{name!r} is no name of a machine; write it as in lab.example.edu, without '
                    'http:// and without a port'
                )
        self._own = {'localhost', socket.gethostname().lower(), host.lower()} - {''}

    def refusal(self, path: str, hosts: Sequence[str], origins: Sequence[str]) -> Refusal | None:
        """
        Return why a request is refused, or None.

        :param path: what is asked for, with its query.
        :param hosts: every Host header.
        :param origins: every Origin header; programs that are no browser send none.
        """
        host = hosts[0] if len(hosts) == 1 else ''
        name = _name_in(host)
        if not self._is_ours(name):
            return Refusal(
                HTTPStatus.MISDIRECTED_REQUEST,
                f'This page is not served under the name {name!r}. If it is to be, start it with '
                'that name among its viewer_names, or --names of a replay.',
            )
        if len(origins) > 1 or any(not self._is_own_page(each, host) for each in origins):
            return Refusal(HTTPStatus.FORBIDDEN, 'This page is used from itself alone.')
        given = path.partition('?')[0].split('/')[1:2]
        if not given or not hmac.compare_digest(_bytes(given[0]), _bytes(self.token)):
            return Refusal(
                HTTPStatus.FORBIDDEN,
                'This page opens by its whole address, which ends in a token: the terminal in '
                'which it was started shows it.',
            )
        return None

    def _is_ours(self, name: str) -> bool:
        return name in self._own or name in self._allowed or _is_address(name)

    def _is_own_page(self, origin: str, host: str) -> bool:
        """Tell whether an origin is the page: at the host asked for, or at a name allowed."""
        # A proxy in front may ask under localhost for a page under a name that was allowed.
        scheme, _, place = origin.partition('://')
        if scheme not in ('http', 'https'):
            return False
        return place.lower() == host.lower() or _name_in(place) in self._allowed


def _name_in(host: str) -> str:
    """Return the name in `name:port`, in lower case; empty if there is none."""
    try:
        parts = urlsplit(f'//{host}')
        return parts.hostname or '' if parts.netloc == host and '@' not in host else ''
    except ValueError:
        return ''


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


def _bytes(text: str) -> bytes:
    return text.encode('utf-8', 'surrogateescape')
