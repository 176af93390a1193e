# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from http.server import HTTPServer, SimpleHTTPRequestHandler
from pathlib import Path
from threading import Thread

from husky_runtime.browser import open_when_served
from playpen_testing.waiting import wait_until
import pytest


def test_no_module_of_the_folder_it_is_called_from_is_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen, browser, theirs = (tmp_path / name for name in ('seen', 'browser', 'theirs'))
    browser.write_text(f'#!/bin/sh\necho "$1" >"{seen}.part"\nmv "{seen}.part" "{seen}"\n')
    browser.chmod(0o700)
    monkeypatch.setenv('BROWSER', str(browser))
    for module in ('husky_runtime', 'webbrowser', 'subprocess'):
        (tmp_path / f'{module}.py').write_text(f'import os\nos.mkdir({str(theirs)!r})\n')
    monkeypatch.chdir(tmp_path)
    with HTTPServer(('localhost', 0), SimpleHTTPRequestHandler) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        address = f'http://localhost:{server.server_port}/'
        open_when_served(address)
        wait_until(lambda: seen.exists() or theirs.exists(), timeout_sec=20.0, what='the browser')
        server.shutdown()
    assert not theirs.exists()
    assert seen.read_text() == f'{address}\n'
