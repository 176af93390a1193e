# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A real browser without a screen, driven over the Chrome DevTools Protocol.

https://chromedevtools.github.io/devtools-protocol/ names the methods.
"""

import base64
import itertools
import json
import os
from pathlib import Path
import signal
import subprocess
import threading
from types import TracebackType
from typing import Any
import urllib.request

from websockets.sync.client import ClientConnection, connect

from playpen_testing.chromium import Program
from playpen_testing.waiting import wait_until

FLAGS = (
    *('--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run'),
    *('--disable-background-networking', '--disable-component-update', '--disable-sync'),
    *('--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage'),
    *('--disable-extensions', '--mute-audio', '--remote-debugging-port=0'),
)
# What viser's own code makes Chromium say about itself, without harm.
HARMLESS = ('Unable to preventDefault inside passive event listener',)
START_SEC = 30.0
ANSWER_SEC = 30.0


class Browser:
    """One page of one browser, in a profile of its own."""

    def __init__(self, program: Program, profile: Path, *, width: int, height: int) -> None:
        # The libraries of the ROS wheels must not get into the browser.
        environment = {k: v for k, v in os.environ.items() if k != 'LD_LIBRARY_PATH'}
        environment |= program.environment
        self._child = subprocess.Popen(
            [
                *(program.path, *FLAGS, f'--user-data-dir={profile}'),
                *(f'--window-size={width},{height}', 'about:blank'),
            ],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        self.errors: list[str] = []
        self._numbers = itertools.count(1)
        self._answers: dict[int, dict[str, Any]] = {}
        self._socket: ClientConnection | None = None
        self._reader = threading.Thread(target=self._read, daemon=True)
        try:
            self._open(profile / 'DevToolsActivePort')
            self.resize(width, height)
        except BaseException:
            self.close()
            raise

    def _open(self, port_file: Path) -> None:
        wait_until(
            lambda: port_file.exists() and port_file.read_text().count('\n') > 0,
            timeout_sec=START_SEC,
            what='a browser that starts',
        )
        port = int(port_file.read_text().split()[0])
        with urllib.request.urlopen(f'http://127.0.0.1:{port}/json', timeout=10.0) as answer:
            pages = json.load(answer)
        url = next(page['webSocketDebuggerUrl'] for page in pages if page['type'] == 'page')
        self._socket = connect(url, max_size=None)
        self._reader.start()
        for domain in ('Runtime', 'Log', 'Page'):
            self.call(f'{domain}.enable')

    def _read(self) -> None:
        assert self._socket is not None
        for text in self._socket:
            message = json.loads(text)
            if 'id' in message:
                self._answers[message['id']] = message
            else:
                self._notice(message)

    def _notice(self, message: dict[str, Any]) -> None:
        """Keep what a person would see as an error in the console."""
        method, params = message['method'], message.get('params', {})
        if (
            method == 'Runtime.exceptionThrown'
            or (method == 'Runtime.consoleAPICalled' and params['type'] in ('error', 'assert'))
            or (method == 'Log.entryAdded' and params['entry']['level'] == 'error')
        ):
            text = json.dumps(params)[:500]
            if not any(words in text for words in HARMLESS):
                self.errors.append(text)

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        """
        Call a method of the protocol and return its result.

        :raises AssertionError: if the browser refuses or does not answer.
        """
        assert self._socket is not None
        number = next(self._numbers)
        self._socket.send(json.dumps({'id': number, 'method': method, 'params': params}))
        wait_until(lambda: number in self._answers, timeout_sec=ANSWER_SEC, what=f'{method}')
        answer = self._answers.pop(number)
        assert 'error' not in answer, f'{method}: {answer["error"]}'
        result: dict[str, Any] = answer['result']
        return result

    def run(self, script: str) -> Any:
        """Return what a JavaScript expression comes to in the page; true for an element."""
        wrapped = (
            f'(async () => {{ const r = await ({script}); return r instanceof Node || r; }})()'
        )
        result = self.call(
            'Runtime.evaluate', expression=wrapped, returnByValue=True, awaitPromise=True
        )
        assert 'exceptionDetails' not in result, result['exceptionDetails']
        return result['result'].get('value')

    def resize(self, width: int, height: int) -> None:
        """Make the page as large as a window, or a phone's screen."""
        self.call(
            'Emulation.setDeviceMetricsOverride',
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=width < 600,
        )

    def draw_nothing(self) -> None:
        """
        Let the pages to come do everything but draw their 3D scene.

        Without a graphics processor drawing takes all that the machine has, and what is tested
        may be something else.
        """
        self.call(
            'Page.addScriptToEvaluateOnNewDocument',
            source="for (const name of ['drawElements', 'drawArrays', 'drawElementsInstanced',"
            " 'drawArraysInstanced', 'drawRangeElements', 'clear', 'blitFramebuffer'])"
            ' WebGL2RenderingContext.prototype[name] = () => {};',
        )

    def visit(self, url: str) -> None:
        """Go to a page."""
        self.call('Page.navigate', url=url)

    def wait_for(self, script: str, *, timeout_sec: float = 30.0, what: str = '') -> Any:
        """Return what the script comes to, as soon as that is true in JavaScript's sense."""
        found: list[Any] = []

        def fact() -> bool:
            found[:] = [self.run(script)]
            return bool(found[0])

        wait_until(fact, timeout_sec=timeout_sec, what=what or f'{script} on the page')
        return found[0]

    def mouse(self, kind: str, x: float, y: float) -> None:
        """Press, move or release the left button: mousePressed, mouseMoved, mouseReleased."""
        button = 'none' if kind == 'mouseMoved' else 'left'
        self.call(
            'Input.dispatchMouseEvent',
            type=kind,
            x=x,
            y=y,
            button=button,
            buttons=0 if kind == 'mouseReleased' else 1,
            clickCount=1,
        )

    def click_at(self, x: float, y: float) -> None:
        """Click somewhere on the page, in pixels."""
        self.call('Input.dispatchMouseEvent', type='mouseMoved', x=x, y=y)
        self.mouse('mousePressed', x, y)
        self.mouse('mouseReleased', x, y)

    def middle_of(self, element: str) -> tuple[float, float]:
        """Return the middle of an element, given as an expression, once a click would hit it."""
        where = f"""(async () => {{
          const place = () => {{
            const e = {element};
            if (!e) return null;
            e.scrollIntoView({{block: 'nearest'}});
            const r = e.getBoundingClientRect(), x = r.x + r.width / 2, y = r.y + r.height / 2;
            const hit = document.elementFromPoint(x, y);
            return hit && (e.contains(hit) || hit.contains(e)) ? [x, y] : null;
          }};
          const first = place();
          await new Promise((resolve) => setTimeout(resolve, 150));
          const then = place();
          return first && then && first[0] === then[0] && first[1] === then[1] ? then : null;
        }})()"""
        x, y = self.wait_for(where, what=f'a place to click on {element}')
        return x, y

    def click(self, element: str) -> None:
        """Click an element that a JavaScript expression gives, as a person does."""
        self.click_at(*self.middle_of(element))

    def drag(self, begin: tuple[float, float], end: tuple[float, float]) -> None:
        """Press the mouse at one place, move to another and release it there."""
        self.call('Input.dispatchMouseEvent', type='mouseMoved', x=begin[0], y=begin[1])
        self.mouse('mousePressed', *begin)
        for part in (0.1, 0.4, 0.7, 1.0, 1.0):
            x, y = (b + part * (e - b) for b, e in zip(begin, end, strict=True))
            self.call(
                'Input.dispatchMouseEvent', type='mouseMoved', x=x, y=y, button='left', buttons=1
            )
        self.mouse('mouseReleased', *end)

    def type_into(self, element: str, text: str) -> None:
        """Replace what an input holds."""
        self.click(element)
        self.run(f'({element}).select() || true')
        self.call('Input.insertText', text=text)

    def key(self, kind: str, key: str) -> None:
        """Press or release a key: keyDown, keyUp."""
        self.call('Input.dispatchKeyEvent', type=kind, key=key, code=key)

    def screenshot(self, path: Path) -> bytes:
        """Take a picture of the page and keep it."""
        data = base64.b64decode(self.call('Page.captureScreenshot', format='png')['data'])
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        return data

    def close(self) -> None:
        """End the browser; may be called twice."""
        if self._socket is not None:
            self._socket.close()
        if self._child.poll() is None:
            os.killpg(self._child.pid, signal.SIGKILL)
        self._child.wait()
        if self._reader.is_alive():
            self._reader.join(5.0)

    def __enter__(self) -> 'Browser':
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
