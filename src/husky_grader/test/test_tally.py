# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from io import StringIO

from husky_grader.tally import Tally


def test_a_tally_counts_to_the_last_file() -> None:
    stream = StringIO()
    tally = Tally(30, stream, '', bar=False)
    for number in range(30):
        tally.add(f's{number} 100.0')
    assert stream.getvalue().splitlines()[-1] == '30 of 30  s29 100.0'
    assert len(stream.getvalue().splitlines()) == 10
