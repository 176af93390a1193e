# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys

from lifecycle_msgs.msg import Transition, TransitionDescription
from ros2cli import remote_nodes
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node

from ros2lifecycle import api, verb


class SetVerb(verb.VerbExtension):
    """Trigger lifecycle state transition."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        remote_nodes.add_arguments(parser)
        parser.add_argument('transition', help='The lifecycle transition: its label or its id')

    def main(self, *, args: argparse.Namespace) -> None:
        name = verb.find_node(args)
        with command_node(args) as node:
            known = api.call_get_available_transitions(node=node, states={name: None})[name]
            if isinstance(known, Exception):
                raise known
            transition = _chosen(known, args.transition)
            success = api.call_change_states(node=node, transitions={name: transition})[name]
        if success is True:
            print('Transitioning successful')
        else:
            # As upstream has it, the exit status tells nothing of this.
            print(success or 'Transitioning failed', file=sys.stderr)


def _chosen(known: list[TransitionDescription], text: str) -> Transition:
    transitions = [each.transition for each in known]
    for spelling in (lambda each: each.label, lambda each: str(each.id)):
        for transition in transitions:
            if spelling(transition) == text:
                return transition
    listed = ''.join(f'\n- {each.label} [{each.id}]' for each in transitions)
    raise CommandError(f'Unknown transition requested, available ones are:{listed}')
