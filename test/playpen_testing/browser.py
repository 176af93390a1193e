# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A real browser without a screen: one for all tests, as its start takes a while."""

from functools import partial
import os
from pathlib import Path
import signal
import subprocess
from types import TracebackType

from husky_runtime.parent_death import die_with_parent

from playpen_testing.chromium import Program
from playpen_testing.devtools import DevTools
from playpen_testing.page import number
from playpen_testing.tab import Tab
from playpen_testing.waiting import wait_until

FLAGS = (
    *('--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run'),
    *('--disable-background-networking', '--disable-component-update', '--disable-sync'),
    *('--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage'),
    *('--disable-extensions', '--mute-audio', '--remote-debugging-port=0'),
    # Drawing without a graphics processor may take long, but it has not hung.
    '--disable-gpu-watchdog',
)
START_SEC = 30.0


class Browser:
    """A browser with a profile of its own; it ends with the thread that starts it."""

    def __init__(self, program: Program, profile: Path) -> None:
        # The libraries of the ROS wheels must not get into the browser.
        environment = {k: v for k, v in os.environ.items() if k != 'LD_LIBRARY_PATH'}
        environment |= program.environment
        self._tabs: list[Tab] = []
        self._tools: DevTools | None = None
        self._child = subprocess.Popen(
            [program.path, *FLAGS, f'--user-data-dir={profile}', 'about:blank'],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
            preexec_fn=partial(die_with_parent, signal.SIGKILL),
        )
        try:
            self._address = self._connect(profile / 'DevToolsActivePort')
        except BaseException:
            self.close()
            raise

    def _connect(self, port_file: Path) -> str:
        wait_until(
            lambda: port_file.exists() and port_file.read_text().count('\n') > 0,
            timeout_sec=START_SEC,
            what='a browser that starts',
        )
        port, path = port_file.read_text().split()
        self._tools = DevTools(f'ws://127.0.0.1:{port}{path}', lambda _: None)
        return f'ws://127.0.0.1:{port}/devtools/page'

    def open(self, url: str, width: int = 1000, height: int = 700, *, drawn: bool = False) -> Tab:
        """Open the view in a tab; unless drawn, its 3D scene stays empty."""
        tools = self._tools
        assert tools is not None
        # As if every tab were another person's: with cookies and a memory of its own.
        person = tools.call('Target.createBrowserContext')['browserContextId']
        target = tools.call('Target.createTarget', url='about:blank', browserContextId=person)
        tab = Tab(
            f'{self._address}/{target["targetId"]}',
            width=width,
            height=height,
            drawn=drawn,
            dispose=lambda: tools.call('Target.disposeBrowserContext', browserContextId=person),
        )
        self._tabs.append(tab)
        tab.visit(url)
        tab.wait_for(number('time'), what='the panel of the view')
        if drawn:
            tab.wait_for_picture()
        return tab

    def close_tabs(self) -> None:
        """Close all tabs; may be called twice."""
        while self._tabs:
            self._tabs.pop().close()

    def close(self) -> None:
        """End the browser; may be called twice."""
        if self._tools is not None:
            self.close_tabs()
            self._tools.close()
            self._tools = None
        if self._child.poll() is None:
            os.killpg(self._child.pid, signal.SIGKILL)
        self._child.wait()

    def __enter__(self) -> 'Browser':
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
