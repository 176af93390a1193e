# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""One page on a whole class: points, steps, common mistakes, and the way to each report."""

from collections.abc import Sequence
from pathlib import Path
from urllib.parse import quote

from markupsafe import Markup

from husky_grader.graded import Graded
from husky_grader.outputs.class_summary import as_points, summarize
from husky_grader.outputs.histogram import histogram
from husky_grader.outputs.student_page import PAGE
from husky_grader.report.page import rendered

STYLE = Path(__file__).with_name('class.css')
_TEMPLATE = Path(__file__).with_name('class.html.jinja')


def class_page(
    everyone: Sequence[Graded], *, title: str, notes: Sequence[str] = (), files: Sequence[str] = ()
) -> str:
    """
    Return the page as HTML text; it links to the page of each student in a folder of their id.

    :param notes: what concerns the whole class, a line each.
    :param files: names of what lies beside the page.
    """
    summary = summarize(everyone)
    points = [one.points for one in summary.graded]
    drawn = points and summary.most > 0.0
    return rendered(
        _TEMPLATE,
        [STYLE],
        title=title,
        everyone=everyone,
        summary=summary,
        sandboxes=sorted({one.sandbox for one in summary.graded if one.sandbox}),
        histogram=Markup(histogram(points, summary.most, summary.quartiles)) if drawn else '',
        notes=notes,
        noted=[one for one in everyone if one.notes or one.submission.late],
        files=files,
        points=as_points,
        href=lambda one: f'{quote(one.submission.id)}/{PAGE}',
    )
