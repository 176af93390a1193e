# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A page of a program, in the browser of this computer, that is told of every change."""

from live_page.server import (
    KEEP_ALIVE_SEC,
    LivePage,
    open_on_a_desktop,
    PageHandler,
    Query,
    read_port,
    serve_somewhere,
)

__all__ = [
    'KEEP_ALIVE_SEC',
    'LivePage',
    'PageHandler',
    'Query',
    'open_on_a_desktop',
    'read_port',
    'serve_somewhere',
]
