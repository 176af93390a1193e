# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Expressions that find elements of the view's page, and what a picture of it tells."""

import io
import json

import numpy as np
from PIL import Image


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


def is_blank(png: bytes) -> bool:
    """Tell whether the scene, left of the panel, shows hardly anything."""
    pixels = np.asarray(Image.open(io.BytesIO(png)).convert('RGB')).astype(int)
    height, width = pixels.shape[:2]
    scene = pixels[height // 4 : -height // 8, : width * 6 // 10]
    colors = np.unique(scene.reshape(-1, 3) // 16, axis=0)
    return len(colors) < 20
