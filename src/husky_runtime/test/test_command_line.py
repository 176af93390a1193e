# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Command lines: in which order words and options may stand, and what a person is told."""

from pathlib import Path
import resource
import shutil

from husky_runtime.command_line import BAD_INPUT, Parser, why
import pytest


@pytest.fixture
def parser() -> Parser:
    parser = Parser(prog='drive', allow_abbrev=False)
    parser.add_argument('words', nargs='*')
    parser.add_argument('--fast', action='store_true')
    parser.add_argument('--report')
    return parser


@pytest.mark.parametrize(
    ('line', 'words'),
    [
        ('a b --fast --report r', ['a', 'b']),
        ('--fast --report r a b', ['a', 'b']),
        ('a --fast b --report r', ['a', 'b']),
        ('a --fast --report r b c', ['a', 'b', 'c']),
        ('--fast a --report r b', ['a', 'b']),
        ('--fast --report r', []),
        ('--fast --report r -- -a', ['-a']),
    ],
)
def test_words_may_stand_on_both_sides_of_an_option(
    parser: Parser, line: str, words: list[str]
) -> None:
    options = parser.parse_in_any_order(line.split(), 'words')
    assert (options.words, options.fast, options.report) == (words, True, 'r')


def test_an_option_that_is_none_is_refused_wherever_it_stands(
    parser: Parser, capsys: pytest.CaptureFixture[str]
) -> None:
    for line in ('--slow a', 'a --slow', 'a --fast --slow b'):
        with pytest.raises(SystemExit) as ended:
            parser.parse_in_any_order(line.split(), 'words')
        assert ended.value.code == BAD_INPUT
        assert 'drive: unrecognized arguments: --slow' in capsys.readouterr().err


def test_an_option_that_is_the_name_of_a_file_is_none_or_both(
    parser: Parser,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path('--report=r').touch()
    with pytest.raises(SystemExit) as ended:  # what a shell makes of `drive --fast *`
        parser.parse_in_any_order(['--fast', '--report=r'], 'words')
    assert ended.value.code == BAD_INPUT
    assert "drive: '--report=r' is also the name of a file here" in capsys.readouterr().err
    assert parser.parse_in_any_order(['--fast', '--', '--report=r'], 'words').report is None
    assert parser.parse_in_any_order(['--fast', './--report=r'], 'words').report is None


def test_what_cannot_be_written_is_named_and_not_what_was_read(tmp_path: Path) -> None:
    (tmp_path / 'source').write_bytes(bytes(100_000))
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (30_000, before[1]))
    try:
        with pytest.raises(OSError) as caught:
            shutil.copyfile(tmp_path / 'source', tmp_path / 'copy')
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert why(caught.value) == f'{tmp_path}/copy: File too large'
