# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The words of a node that are not for ROS, and help that tells of its parameters, which are."""

import argparse
from collections.abc import Iterable, Iterator
import shutil
import textwrap

from husky_runtime.command_line import Parser
from husky_runtime.settings import Setting

_ASIDE = 24 * ' '  # where argparse begins what it says of an option
_LEAST_WIDTH = 50


class NodeParser(Parser):
    """Parses what `remove_ros_args` leaves; behind --ros-args stand the parameters."""

    def __init__(self, prog: str, about: str, settings: Iterable[Setting], more: str = '') -> None:
        """
        Make a parser without options of its own.

        :param settings: every parameter of the node.
        :param more: the end of the help.
        """
        super().__init__(
            prog=prog,
            description=about,
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        self._settings = tuple(settings)
        self._more = more

    def format_help(self) -> str:
        """Return the help; lines are as long as the terminal allows."""
        parts = (super().format_help(), '\n'.join(self._parameters()), self._more)
        return '\n'.join(f'{part.rstrip()}\n' for part in parts if part)

    def _parameters(self) -> Iterator[str]:
        width = max(shutil.get_terminal_size().columns - 2, _LEAST_WIDTH)
        yield 'parameters, each as -p NAME:=VALUE behind --ros-args:'
        for each in self._settings:
            begin = f'  {each.name}'
            text = _told(each)
            told = textwrap.fill(text, width, initial_indent=_ASIDE, subsequent_indent=_ASIDE)
            if len(begin) < len(_ASIDE) - 1:
                yield begin + told[len(begin) :]
            else:
                yield f'{begin}\n{told}'


def _told(setting: Setting) -> str:
    """Return what a setting is, which values are allowed, and which it has if none is given."""
    aside = [setting.allowed] if setting.has_range else []
    default = setting.default
    if isinstance(default, bool):
        aside.append(f'default: {str(default).lower()}')
    elif default not in ('', ()):
        aside.append(f'default: {list(default) if isinstance(default, tuple) else default}')
    words = setting.description.rstrip('.')
    return f'{words} ({"; ".join(aside)})' if aside else words
