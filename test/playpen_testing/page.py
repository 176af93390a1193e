# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Expressions that find elements of the view's page."""

import json


def button(label: str) -> str:
    """Return an expression for the button that bears a label."""
    return (
        "[...document.querySelectorAll('button')]"
        f'.find((b) => b.textContent.trim() === {json.dumps(label)})'
    )


def labelled_input(label: str, kind: str = 'input') -> str:
    """Return an expression for the input that stands beside, or after, a label's text."""
    return (
        "(() => { const l = [...document.querySelectorAll('label')]"
        f'.find((l) => l.textContent.trim() === {json.dumps(label)}); '
        'if (!l) return null; const named = l.htmlFor && document.getElementById(l.htmlFor); '
        'if (named) return named; '
        f"for (let e = l; e; e = e.parentElement) {{ const i = e.querySelector('{kind}'); "
        'if (i) return i; } return null; })()'
    )


def number(key: str) -> str:
    """Return an expression for a figure of the panel, as text."""
    return f'(document.querySelector("[data-number={key}]") || {{}}).textContent'
