# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A tab of a browser: what a person sees in it and does with it."""

import base64
from collections.abc import Callable
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from playpen_testing.devtools import DevTools
from playpen_testing.page import number
from playpen_testing.waiting import wait_until

# What viser's own code makes Chromium say about itself, without harm.
HARMLESS = ('Unable to preventDefault inside passive event listener',)

# Without a graphics processor, drawing takes all that the machine has. Where what is tested is
# something else, pages do everything but draw their 3D scene; and where the scene itself is looked
# at, a few pictures a second are enough.
_DRAW_NOTHING = """
for (const name of ['drawElements', 'drawArrays', 'drawElementsInstanced', 'drawArraysInstanced',
    'drawRangeElements', 'clear', 'blitFramebuffer'])
  WebGL2RenderingContext.prototype[name] = () => {};
"""
_DRAW_SELDOM = """
const soon = window.requestAnimationFrame.bind(window);
window.requestAnimationFrame = (draw) => setTimeout(() => soon(draw), 100);
"""

_IS_CANVAS_LOST = """(() => {
  const canvas = document.querySelector('canvas');
  const drawing = canvas && canvas.getContext("webgl2");
  return Boolean(drawing && drawing.isContextLost());
})()"""
_ASPHALT = np.array([75, 75, 77])


class Tab:
    """
    One page.

    :param url: of its DevTools.
    :param drawn: whether its 3D scene is looked at.
    :param dispose: called once to close it.
    """

    def __init__(
        self, url: str, *, width: int, height: int, drawn: bool, dispose: Callable[[], object]
    ) -> None:
        self.errors: list[str] = []
        self._dispose: Callable[[], object] | None = dispose
        self._tools = DevTools(url, self._notice)
        self.call = self._tools.call
        for domain in ('Runtime', 'Log', 'Page'):
            self.call(f'{domain}.enable')
        self.call('Emulation.setFocusEmulationEnabled', enabled=True)
        self.call(
            'Page.addScriptToEvaluateOnNewDocument',
            source=_DRAW_SELDOM if drawn else _DRAW_NOTHING,
        )
        self.resize(width, height)

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

    def wheel(self, x: float, y: float, pixels: float) -> None:
        """Turn the wheel of the mouse, towards oneself if positive."""
        self.call('Input.dispatchMouseEvent', type='mouseWheel', x=x, y=y, deltaX=0, deltaY=pixels)

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

    def wait_for_picture(self) -> None:
        """
        Wait until the asphalt is drawn.

        Chromium may take the canvas away from a page that loads on a busy machine (a lost WebGL
        context, which it does not give back in time); a person would load the page again.
        """

        def is_drawn() -> bool:
            if self.run(_IS_CANVAS_LOST):
                self.call('Page.reload')
                self.wait_for(number('time'), what='the panel of the view, loaded again')
            png = base64.b64decode(self.call('Page.captureScreenshot', format='png')['data'])
            pixels = np.asarray(Image.open(io.BytesIO(png)).convert('RGB')).astype(int)
            return bool((np.abs(pixels - _ASPHALT).max(axis=2) < 20).mean() > 0.05)

        wait_until(is_drawn, timeout_sec=60.0, what=lambda: f'asphalt on the page; {self.errors}')

    def still(self, path: Path) -> bytes:
        """Take a picture as soon as nothing moves any more, such as labels that come late."""
        pictures = [self.screenshot(path)]

        def is_still() -> bool:
            pictures.append(self.screenshot(path))
            return pictures[-1] == pictures[-2]

        wait_until(is_still, timeout_sec=60.0, what='a page on which nothing moves')
        return pictures[-1]

    def crash(self) -> None:
        """End the page's process, so that it cannot even say goodbye."""
        self._tools.send('Page.crash')

    def close(self) -> None:
        """Close the page; may be called twice."""
        dispose, self._dispose = self._dispose, None
        if dispose is not None:
            dispose()
        self._tools.close()
