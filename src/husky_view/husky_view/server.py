# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The web server of the view: its address, its end, and what is clicked on its pages."""

from collections.abc import Callable, Iterable
from contextlib import redirect_stdout
import io
from queue import SimpleQueue
from threading import Thread
import time
import warnings

from husky_runtime.web_address import AddressError, free_port, new_token
import viser

from husky_view.gate.admission import Admission
from husky_view.gate.gate import Gate
from husky_view.outgoing import use_thread_safe_buffers
from husky_view.picture.page import add_page_script
from husky_view.picture.tabs import Tabs

CLOSE_SEC = 0.5
MOST_ACTIONS, ACTIONS_SEC = 1000, 0.02


class PageServer(viser.ViserServer):
    """
    Serves an empty page behind a gate.

    :param names: under which the page may be asked for, beside those of this machine.
    :raises AddressError: if the address cannot be had, or a name or the token is none.
    """

    def __init__(self, host: str, port: int, *, title: str, names: Iterable[str] = ()) -> None:
        try:
            self._admission = Admission(new_token(), host=host, names=names)
        except ValueError as error:
            raise AddressError(str(error)) from error
        gate = Gate(self._admission, title=title)
        port = free_port(host, port)
        use_thread_safe_buffers()
        # A tab may be closed at any moment, also while it is told something.
        warnings.filterwarnings('ignore', 'Queued a .* on a closed connection', UserWarning)
        with gate.in_front(), redirect_stdout(io.StringIO()):  # viser prints a banner
            super().__init__(host=host, port=port, label=title, verbose=False)
        gate.control_of = self.gui._gui_input_handle_from_uuid.get
        self.gui.configure_theme(control_width='medium', show_logo=False, show_share_button=False)
        self.scene.set_up_direction('+z')
        add_page_script(self)
        self.tabs = Tabs(self)

    def clear(self) -> None:
        """Take everything off the page, and forget what was shown there."""
        self.gui.reset()
        self.scene.reset()
        for client in self.get_clients().values():
            client.scene.reset()  # what only one tab shows
        self.tabs.clear()

    @property
    def is_watched(self) -> bool:
        """Whether a tab is connected, also one that has not told of its camera yet."""
        return bool(self._websock_server._client_state_from_id)

    @property
    def address(self) -> str:
        """The URL of the page, with the token that opens it."""
        host = self.get_host()
        if host in ('127.0.0.1', '0.0.0.0', '::', '::1', ''):  # noqa: S104
            host = 'localhost'
        host = f'[{host}]' if ':' in host else host
        return f'http://{host}:{self.get_port()}/{self._admission.token}/'


def close_server(server: viser.ViserServer) -> None:
    """Close every page; may be called twice."""
    # viser waits up to 6 s for every page to close its connection, also for one that hangs.
    closing = Thread(target=server.stop, daemon=True)
    with redirect_stdout(io.StringIO()):
        closing.start()
        closing.join(CLOSE_SEC)


class ActionQueue:
    """Actions from the server's thread, run by the thread that owns everything else."""

    def __init__(self) -> None:
        self._urgent: SimpleQueue[Callable[[], object]] = SimpleQueue()
        self._queue: SimpleQueue[Callable[[], object]] = SimpleQueue()

    def put(self, action: Callable[[], object], *, urgent: bool = False) -> None:
        """
        Add an action; from any thread.

        Only an urgent one is never left out: others are where very many wait already.
        """
        if urgent:
            self._urgent.put(action)
        elif self._queue.qsize() < MOST_ACTIONS:
            self._queue.put(action)

    def run_urgent(self) -> None:
        """Run what is urgent of what was added."""
        while not self._urgent.empty():
            self._urgent.get()()

    def run(self) -> None:
        """Run what was added since the last call, as much as fits into a frame; urgent first."""
        end_sec = time.monotonic() + ACTIONS_SEC
        while time.monotonic() < end_sec:
            queue = self._queue if self._urgent.empty() else self._urgent
            if queue.empty():
                return
            queue.get()()
