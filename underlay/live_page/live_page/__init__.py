# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A page of a program, in the browser of this computer, that is told of every change.

`live_page.server` has the page itself: a program loads it where it shows one.
"""

from live_page.start import open_on_a_desktop, read_port, serve_somewhere

__all__ = ['open_on_a_desktop', 'read_port', 'serve_somewhere']
