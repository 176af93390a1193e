# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why a module of a package of one's own is not found is told."""

from pathlib import Path

from husky_grader.lab.misplaced import misplaced
import pytest

MANIFEST = '<package><name>topic_demo</name></package>'
NOT_FOUND = "publisher line 33: ModuleNotFoundError: No module named '%s'"


@pytest.mark.parametrize(
    ('files', 'name', 'why'),
    [
        (
            ['topic_demo/__init__.py', 'publisher.py'],
            'topic_demo.publisher',
            'publisher.py lies beside src/topic_demo/topic_demo, move it into that',
        ),
        (
            ['topic_demo/publisher.py'],
            'topic_demo',
            'src/topic_demo/topic_demo has no __init__.py, so that its setup.py finds no package',
        ),
        (['topic_demo/__init__.py'], 'topic_demo.publishr', ''),
        (['topic_demo/__init__.py'], 'topic_demo', ''),
        (['topic_demo/publisher.py'], 'numpi', ''),
        (
            ['topic_demo/__init__.py', 'topic_demo/helper.py'],
            'helper',
            'it is a module of topic_demo: import topic_demo.helper',
        ),
    ],
)
def test_why_a_module_is_not_found_is_told(
    tmp_path: Path, files: list[str], name: str, why: str
) -> None:
    for file in ('package.xml', *files):
        path = tmp_path / 'src' / 'topic_demo' / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(MANIFEST)
    told = misplaced(NOT_FOUND % name, tmp_path)
    assert told.startswith(why)
    assert bool(told) == bool(why)


def test_a_module_in_utf_16_is_named(tmp_path: Path) -> None:
    error = 'publisher line 33: SyntaxError: source code string cannot contain null bytes'
    modules = tmp_path / 'src' / 'topic_demo' / 'topic_demo'
    modules.mkdir(parents=True)
    (modules.parent / 'package.xml').write_text(MANIFEST)
    (modules / '__init__.py').write_text('')
    assert misplaced(error, tmp_path) == ''
    (modules / 'publisher.py').write_text('def main(): pass', encoding='utf-16')
    told = 'src/topic_demo/topic_demo/publisher.py is saved as UTF-16 (Windows: Unicode), save it '
    assert misplaced(error, tmp_path) == f'{told}as UTF-8'
