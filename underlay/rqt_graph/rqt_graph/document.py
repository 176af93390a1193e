# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The document of a page: what all pages share, with the parts of one."""

from __future__ import annotations

from pathlib import Path

_DOCUMENT = Path(__file__).with_name('page.html')


def fill(**parts: str) -> bytes:
    """Put the parts of a page into the document.

    :param parts: `title`; `file`, the name to save as; `controls` and `legend`, in HTML;
        `functions`, in JavaScript: `query()` for the address of events, `describe(news)` for the
        status, and `begin()`.
    """
    text = _DOCUMENT.read_text(encoding='utf-8')
    for name, part in parts.items():
        text = text.replace(f'@{name}@', part)
    return text.encode()
