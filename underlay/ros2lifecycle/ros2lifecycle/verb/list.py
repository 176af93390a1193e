# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, remote_nodes
from ros2cli.node.direct import command_node

from ros2lifecycle import api, verb


class ListVerb(verb.VerbExtension):
    """Output a list of available transitions."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        remote_nodes.add_arguments(parser)
        arguments.add_flags(parser, {'-a --all': 'Display all existing transitions'})

    def main(self, *, args: argparse.Namespace) -> None:
        name = verb.find_node(args)
        ask = api.call_get_transition_graph if args.all else api.call_get_available_transitions
        with command_node(args) as node:
            transitions = ask(node=node, states={name: None})[name]
        if isinstance(transitions, Exception):
            raise transitions
        for each in transitions:
            print(f'- {each.transition.label} [{each.transition.id}]')
            print(f'\tStart: {each.start_state.label}')
            print(f'\tGoal: {each.goal_state.label}')
