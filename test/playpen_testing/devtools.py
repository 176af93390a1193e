# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A connection to a browser, or to one of its tabs, over the Chrome DevTools Protocol.

https://chromedevtools.github.io/devtools-protocol/ names the methods.
"""

from collections.abc import Callable
import contextlib
import itertools
import json
import threading
from typing import Any

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from playpen_testing.waiting import wait_until

ANSWER_SEC = 30.0


class DevTools:
    """
    Calls methods and hears events.

    :param notice: called with every event, on a thread of its own.
    """

    def __init__(self, url: str, notice: Callable[[dict[str, Any]], None]) -> None:
        self._notice = notice
        self._numbers = itertools.count(1)
        self._answers: dict[int, dict[str, Any]] = {}
        self._socket = connect(url, max_size=None, ping_interval=None)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        with contextlib.suppress(ConnectionClosed):  # a tab that is closed hangs up
            for text in self._socket:
                message = json.loads(text)
                if 'id' in message:
                    self._answers[message['id']] = message
                else:
                    self._notice(message)

    def send(self, method: str, **params: Any) -> int:
        """Call a method whose answer nobody waits for; returns the number of the call."""
        number = next(self._numbers)
        self._socket.send(json.dumps({'id': number, 'method': method, 'params': params}))
        return number

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        """
        Call a method of the protocol and return its result.

        :raises AssertionError: if the browser refuses or does not answer.
        """
        number = self.send(method, **params)
        wait_until(lambda: number in self._answers, timeout_sec=ANSWER_SEC, what=f'{method}')
        answer = self._answers.pop(number)
        assert 'error' not in answer, f'{method}: {answer["error"]}'
        result: dict[str, Any] = answer['result']
        return result

    def close(self) -> None:
        """Hang up; may be called twice."""
        with contextlib.suppress(ConnectionClosed):
            self._socket.close()
        self._reader.join(5.0)
