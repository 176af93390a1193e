# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The view's page in a real browser without a screen, driven by Playwright."""

import base64
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
import io
import os
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image
from playwright.sync_api import Browser, BrowserType, expect, Locator, Page, sync_playwright

from playpen_testing.chromium import Program
from playpen_testing.waiting import wait_until

KEPT = os.environ.get('PLAYPEN_PICTURES')  # the folder for pictures that are to be kept, if any
FLAGS = (
    *('--disable-gpu', '--use-angle=swiftshader', '--disable-quic'),
    # Drawing without a graphics processor may take long, but it has not hung.
    '--disable-gpu-watchdog',
)
# What viser's own code makes Chromium say about itself, without harm.
HARMLESS = 'Unable to preventDefault inside passive event listener'

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
window.requestAnimationFrame = (draw) => setTimeout(() => soon(draw), 250);
"""
# Smooth edges take most of the time: only pictures to keep have them. These are not drawn seldom
# either, or what moves would stand elsewhere than its shadow.
_DRAW_ROUGHLY = """
const context = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, given) {
  return context.call(this, kind, {...given, antialias: false});
};
"""

_IS_CANVAS_LOST = """(() => {
  const canvas = document.querySelector('canvas');
  const drawing = canvas && canvas.getContext("webgl2");
  return Boolean(drawing && drawing.isContextLost());
})()"""
_PLACES = """() => {
  const all = [...document.querySelectorAll('button, [style*="cursor: pointer"]')];
  return all.map((each) => [each.textContent.trim(), each.getBoundingClientRect()])
    .map(([name, box]) => [name, [box.left + box.width / 2, box.top]]);
}"""
_IS_OPEN = """[...document.querySelectorAll('button')].some((each) =>
  each.textContent.trim() === 'Undo' && each.offsetParent &&
  !each.closest('[style*="will-change"]'))"""
_ASPHALT = np.array([75, 75, 77])

expect.set_options(timeout=30_000)

Place = tuple[float, float]


@contextmanager
def start_browser(program: Program) -> Iterator[Browser]:
    """Start a browser; it ends with this process, however that ends."""
    with sync_playwright() as playwright, launch(playwright.chromium, program, FLAGS) as browser:
        yield browser


def launch(chromium: BrowserType, program: Program, flags: Sequence[str]) -> Browser:
    # The libraries of the ROS wheels must not get into the browser.
    environment = {k: v for k, v in os.environ.items() if k != 'LD_LIBRARY_PATH'}
    return chromium.launch(
        executable_path=program.path, env={**environment, **program.environment}, args=flags
    )


def open_page(
    browser: Browser, url: str, width: int = 1000, height: int = 700, *, drawn: bool = False
) -> Page:
    """
    Open the view as another person would, with cookies and a memory of its own.

    :param drawn: whether its 3D scene is looked at; it stays empty otherwise.
    """
    page = browser.new_page(viewport={'width': width, 'height': height}, is_mobile=width < 600)
    page.set_default_timeout(60_000 if drawn else 30_000)
    if drawn and not KEPT:
        page.add_init_script(_DRAW_SELDOM + _DRAW_ROUGHLY)
    elif not drawn:
        page.add_init_script(_DRAW_NOTHING)
    page.goto(url, wait_until='commit')
    expect(number(page, 'time')).not_to_be_empty()
    if drawn:
        _wait_for_picture(page)
    return page


def button(page: Page, label: str) -> Locator:
    return page.get_by_role('button', name=label, exact=True)


def number(page: Page, key: str) -> Locator:
    """Return a figure of the panel."""
    return page.locator(f'[data-number={key}]')


def wait_for(page: Page, script: str) -> None:
    """Wait until a JavaScript expression is true."""
    page.wait_for_function(script, polling=50)  # a page that draws has few frames to poll in


def open_editor(page: Page) -> None:
    """
    Open the folder of waypoints, whole.

    While it grows, Playwright would scroll in it to what is not yet to be seen.
    """
    page.get_by_text('Waypoints', exact=True).click()
    wait_for(page, _IS_OPEN)


def places(page: Page) -> dict[str, Place]:
    """Return where on the page each button and the head of each folder is, in px."""
    found = list[tuple[str, Place]](page.evaluate(_PLACES))
    return {name: place for name, place in found if name}


def errors(page: Page) -> list[str]:
    """Return what a person would see as an error in the console."""
    said = [m.text for m in page.console_messages(filter='all') if m.type in ('error', 'assert')]
    said += map(str, page.page_errors(filter='all'))
    return [text for text in said if HARMLESS not in text]


def hide(page: Page, *, hidden: bool = True) -> None:
    """Let a page think that another tab is in front of it, as without a screen none ever is."""
    page.evaluate(
        """(value) => {
          Object.defineProperty(document, 'hidden', { value, configurable: true });
          document.dispatchEvent(new Event('visibilitychange'));
        }""",
        hidden,
    )


def drag(page: Page, begin: Place, end: Place) -> None:
    """Press the mouse at one place, move to another and release it there."""
    page.mouse.move(*begin)
    page.mouse.down()
    page.mouse.move(*end, steps=5)
    page.mouse.up()


def screenshot(page: Page) -> bytes:
    """Take a picture at once; Playwright's own waits for frames, of which a drawn page has few."""
    devtools = page.context.new_cdp_session(page)
    picture = devtools.send('Page.captureScreenshot')['data']
    devtools.detach()
    return base64.b64decode(picture)


def pixels_of(png: bytes) -> npt.NDArray[np.int_]:
    """Return rows, columns and the three colours of a picture."""
    return np.asarray(Image.open(io.BytesIO(png)).convert('RGB')).astype(int)


def asphalt(png: bytes) -> int:
    """Return how many pixels show asphalt."""
    return int((np.abs(pixels_of(png) - _ASPHALT).max(axis=2) < 20).sum())


def _wait_for_picture(page: Page) -> None:
    """
    Wait until the asphalt is drawn.

    Chromium may take the canvas away from a page that loads on a busy machine (a lost WebGL
    context, which it does not give back in time); a person would load the page again.
    """

    def is_drawn() -> bool:
        if page.evaluate(_IS_CANVAS_LOST):
            page.reload(wait_until='commit')
            expect(number(page, 'time')).not_to_be_empty()
        size = page.viewport_size
        assert size is not None
        return asphalt(screenshot(page)) > 0.05 * size['width'] * size['height']

    wait_until(is_drawn, timeout_sec=60.0, what=lambda: f'asphalt on the page; {errors(page)}')


def keep_still(page: Page, path: Path) -> None:
    """Keep a picture as soon as nothing moves any more, such as labels that come late."""
    pictures = [screenshot(page)]

    def is_still() -> bool:
        pictures.append(screenshot(page))
        return pictures[-1] == pictures[-2]

    wait_until(is_still, timeout_sec=60.0, what='a page on which nothing moves')
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(pictures[-1])
