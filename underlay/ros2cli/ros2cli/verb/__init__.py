# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a verb of a command is."""

from __future__ import annotations

import argparse
from typing import Any

from ros2cli.plugin_system import Extension, named_extensions


class VerbExtension(Extension):
    """Base of a verb: `ros2 COMMAND VERB`.

    A package registers its verb of `ros2 topic` in the entry point group 'ros2topic.verb'.
    """

    def main(self, *, args: argparse.Namespace) -> int | str | None:
        raise NotImplementedError()


def get_verb_extensions(name: str) -> dict[str, Any]:
    """Map the names of the verbs of an entry point group to instances of them."""
    return named_extensions(name)
