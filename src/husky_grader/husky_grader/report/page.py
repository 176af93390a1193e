# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A page of HTML that needs no network and no script, in the look of all reports."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from husky_course.printable import printable
from markupsafe import Markup

if TYPE_CHECKING:
    from jinja2 import Environment

_STYLE = Path(__file__).with_name('report.css')


def rendered(template: Path, styles: Sequence[Path] = (), **values: object) -> str:
    """
    Return the page that a template of jinja makes; it gets the style of all reports as `style`.

    :param styles: more of it.
    """
    style = ''.join(path.read_text(encoding='utf-8') for path in (_STYLE, *styles))
    return _environment(template.parent).get_template(template.name).render(style=Markup(style), **values)


@cache
def _environment(folder: Path) -> Environment:
    # It takes its time, and who hands pages to workers makes none.
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    # Names come from others: control characters are shown, HTML is escaped.
    return Environment(
        loader=FileSystemLoader(folder),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        finalize=lambda value: printable(value) if type(value) is str else value,
    )
