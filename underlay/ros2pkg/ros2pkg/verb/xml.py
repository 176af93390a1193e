# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from xml.etree import ElementTree

from ros2cli import arguments
from ros2cli.errors import CommandError

from ros2pkg import verb


class XmlVerb(verb.VerbExtension):
    """Output the XML of the package manifest or a specific tag."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_package(parser, help='The package name')
        parser.add_argument('-t', '--tag', help='The XML tag to output, e.g. version')

    def main(self, *, args: argparse.Namespace) -> None:
        manifest = verb.share_of(args.package_name) / 'package.xml'
        try:
            text = manifest.read_text(encoding='utf-8')
        except OSError as error:
            raise CommandError(
                f"Package XML manifest not found: '{manifest}' cannot be read: {error.strerror}"
            ) from None
        if args.tag is None:
            print(text, end='')
            return
        try:
            root = ElementTree.fromstring(text)
        except ElementTree.ParseError as error:
            raise CommandError(f"'{manifest}' is no XML: {error}") from None
        found = [element.text or '' for element in root.findall(args.tag)]
        if not found:
            raise CommandError(
                f"XML tag not found: the manifest of '{args.package_name}' has no '{args.tag}'"
            )
        for value in found:
            print(value)
