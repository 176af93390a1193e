# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a command of `ros2` is, and how the commands and their verbs are found."""

from __future__ import annotations

import argparse
from collections.abc import Collection, Mapping, Sequence
import sys
from typing import Any

from entry_point_index import docstring, entry_points, load

from ros2cli.plugin_system import Extension, named_extensions
from ros2cli.verb import VerbExtension

# What a full ROS 2 has besides; each is refused with a line that says so.
_LEFT_OUT = {
    'ros2cli.command': ('control', 'plugin', 'security', 'test', 'trace'),
}  # fmt: skip
# What pages on newer releases show, and what does it in Jazzy.
_AFTER_JAZZY = {
    'ros2action.verb': {
        'echo': '`ros2 topic echo ACTION/_action/feedback` shows what a server tells',
        'find': '`ros2 action list -t` shows each action with its type',
    },
}
# What text programs make of two hyphens.
_LONG_DASHES = '\N{EN DASH}\N{EM DASH}'


class CommandExtension(Extension):
    """Base of a command: `ros2 COMMAND`.

    A package registers its command in the entry point group 'ros2cli.command'.
    """

    def main(
        self, *, parser: argparse.ArgumentParser, args: argparse.Namespace
    ) -> int | str | None:
        raise NotImplementedError()


class CommandWithVerbs(CommandExtension):
    """Base of a command that only finds its verbs."""

    VERB_GROUP = ''

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        add_subparsers_on_demand(parser, cli_name, '_verb', self.VERB_GROUP, required=False)

    def main(
        self, *, parser: argparse.ArgumentParser, args: argparse.Namespace
    ) -> int | str | None:
        verb: VerbExtension | None = getattr(args, '_verb', None)
        if verb is None:
            parser.print_help()
            return 0
        return verb.main(args=args)


def get_command_extensions(
    group_name: str, *, exclude_names: Collection[str] | None = None
) -> dict[str, Any]:
    """Map the names of the commands of an entry point group to instances of them."""
    return named_extensions(group_name, exclude_names=exclude_names)


class CommandLineParser(argparse.ArgumentParser):
    """A parser that knows the words that are left for it, and reads its help when it is shown."""

    words: Sequence[str] = ()
    target = ''  # of the extension whose docstring is the description
    below: Mapping[str, str] = {}  # the extensions that may be typed next, by name

    def parse_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> argparse.Namespace:
        parsed, left = self.parse_known_args(args, namespace)
        if left:
            meant = _meant(left, list(sys.argv[1:] if args is None else args), parsed)
            self.error(f'unrecognized arguments: {" ".join(left)}{meant}')
        return parsed

    def format_help(self) -> str:
        if self.target:
            self.description = _help(self.target)
        if self._subparsers is not None:
            width = max(map(len, self.below), default=0)
            self._subparsers.description = '\n'.join(
                f'{name:<{width}}  {_first_line(target)}' for name, target in self.below.items()
            )
        return super().format_help()


def add_subparsers_on_demand(
    parser: argparse.ArgumentParser,
    cli_name: str,
    dest: str,
    group_name: str,
    hide_extensions: Sequence[str] | None = None,
    required: bool = True,  # noqa: FBT001, FBT002 -- upstream's signature
    argv: Sequence[str] | None = None,
) -> Any:
    """Add a subparser for each extension of a group; import only the one that was typed.

    :param dest: where the namespace then holds the extension.
    """
    words = list(getattr(parser, 'words', sys.argv[1:]) if argv is None else argv)
    chosen = next((word for word in words if not word.startswith('-')), None)
    known = dict(sorted(entry_points(group_name).items()))
    if chosen is not None and chosen not in known:
        _refuse(parser, cli_name, group_name, chosen, list(known))
    kind = 'command' if dest == '_command' else 'verb'
    if isinstance(parser, CommandLineParser):
        hidden = hide_extensions or ()
        parser.below = {name: known[name] for name in known if name not in hidden}
    subparsers = parser.add_subparsers(
        title='Commands',
        description='',  # see format_help
        metavar=f'Call `{cli_name} <{kind}> -h` for more detailed usage.',
        required=required,
    )
    for name in known:
        subparser = subparsers.add_parser(
            name, formatter_class=argparse.RawDescriptionHelpFormatter
        )
        if name == chosen:
            if isinstance(subparser, CommandLineParser):
                subparser.words = words[words.index(name) + 1 :]
                subparser.target = known[name]
            extension = load(known[name])()
            subparser.set_defaults(**{dest: extension, f'{dest}_parser': subparser})
            extension.add_arguments(subparser, f'{cli_name} {name}')
    return subparsers


def _refuse(
    parser: argparse.ArgumentParser, cli_name: str, group: str, chosen: str, known: list[str]
) -> None:
    if chosen in _LEFT_OUT.get(group, ()):
        parser.exit(2, f'{cli_name} {chosen} is part of a full ROS 2 and left out here\n')
    if instead := _AFTER_JAZZY.get(group, {}).get(chosen):
        parser.exit(2, f'{cli_name} {chosen} came after Jazzy; {instead}\n')
    from ros2_diagnosis import nearest

    kind = 'command' if group == 'ros2cli.command' else 'verb'
    parser.error(f"'{chosen}' is no {kind} of {cli_name}{nearest.hint(chosen, known)}")


def _meant(left: Sequence[str], words: Sequence[str], parsed: argparse.Namespace) -> str:
    """Return a clause on what was meant by the words of a line for which nothing is there."""
    if any(word.count('{') != word.count('}') or word.endswith(':') for word in words):
        return '; a value in YAML stands between straight quotes: "{field: value}"'
    if long := next((word for word in words if word[0:1] in _LONG_DASHES), None):
        return f"; an option begins with hyphens: '--{long.lstrip(_LONG_DASHES + '-')}'"
    from ros2_diagnosis import nearest

    parser = getattr(parsed, '_verb_parser', getattr(parsed, '_command_parser', None))
    known = parser._option_string_actions if parser is not None else ()
    return nearest.hint(next((word for word in left if word[0:1] == '-'), ''), known, at_most=0)


def _help(target: str) -> str:
    try:
        return docstring(target)
    except Exception as error:
        # One package that cannot be imported must not take the other commands away.
        return f'cannot be loaded: {type(error).__name__}: {error}'


def _first_line(target: str) -> str:
    return _help(target).partition('\n')[0]
