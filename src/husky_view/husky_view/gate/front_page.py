# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The page that a browser loads: viser's, with our title."""

from html import escape
from pathlib import Path

import viser


def front_page(title: str) -> bytes:
    """Return viser's page, which is one file, under a title."""
    file = Path(viser.__file__).parent / 'client' / 'build' / 'index.html'
    head, found, rest = file.read_text(encoding='utf-8').partition('<title>Viser</title>')
    title_html = f'<title>{escape(title)}</title><script>{_KEEP_ADDRESS}</script>' * bool(found)
    return f'{head}{title_html}{rest}'.encode()


_KEEP_ADDRESS = (
    'history.replaceState = () => {};'  # viser would write a second address behind ours
)
