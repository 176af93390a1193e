# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from dataclasses import dataclass

from husky_runtime.node_parser import NodeParser
from husky_runtime.settings import setting, settings_of
import pytest


@dataclass(frozen=True, kw_only=True)
class Settings:
    file: str = setting('', 'File to read; empty: none.')
    pace: float = setting(1.5, 'How fast.', 0.1, 2.0, or_zero=True)
    seed: int = setting(0, 'Seed of the noise.', 0, 9)
    start: tuple[float, ...] = setting((0.0, 1.0), 'Where it starts.')
    a_name_that_is_rather_long: bool = setting(True, 'Whether it is.')
    floor: str = setting('dry', 'How the tyres grip: dry, wet.', choices=('dry', 'wet'))


@pytest.fixture
def parser(monkeypatch: pytest.MonkeyPatch) -> NodeParser:
    monkeypatch.setenv('COLUMNS', '64')
    return NodeParser('node', 'Do what it does.', settings_of(Settings), more='And more.')


def test_help_tells_each_parameter_its_default_and_what_is_allowed(
    parser: NodeParser, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        parser.parse_args(['--help'])
    assert ended.value.code == 0
    assert capsys.readouterr().out == (
        'usage: node [-h]\n'
        '\n'
        'Do what it does.\n'
        '\n'
        'options:\n'
        '  -h, --help  show this help message and exit\n'
        '\n'
        'parameters, each as -p NAME:=VALUE behind --ros-args:\n'
        '  file                  File to read; empty: none\n'
        '  pace                  How fast (0 or a number from 0.1 to 2;\n'
        '                        default: 1.5)\n'
        '  seed                  Seed of the noise (a whole number from\n'
        '                        0 to 9; default: 0)\n'
        '  start                 Where it starts (default: [0.0, 1.0])\n'
        '  a_name_that_is_rather_long\n'
        '                        Whether it is (default: true)\n'
        '  floor                 How the tyres grip: dry, wet (default:\n'
        '                        dry)\n'
        '\n'
        'And more.\n'
    )


def test_another_word_is_refused_in_one_line(
    parser: NodeParser, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        parser.parse_args(['word'])
    assert ended.value.code == 2
    assert capsys.readouterr().err == 'node: unrecognized arguments: word; see node --help\n'
