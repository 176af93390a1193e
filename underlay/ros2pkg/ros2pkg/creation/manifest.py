# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The package.xml of a new package (REP-149)."""

from __future__ import annotations

from xml.sax.saxutils import escape, quoteattr

from ros2pkg.creation.package import NewPackage

_SCHEMA = 'http://download.ros.org/schema/package_format{}.xsd'


def manifest(package: NewPackage) -> str:
    """Write the manifest."""
    schema = _SCHEMA.format(package.package_format)
    groups = [
        [('buildtool_depend', name) for name in package.buildtool_dependencies],
        [('depend', name) for name in package.dependencies],
        [('test_depend', name) for name in package.test_dependencies],
    ]
    lines = [
        '<?xml version="1.0"?>',
        f'<?xml-model href="{schema}" schematypens="http://www.w3.org/2001/XMLSchema"?>',
        f'<package format="{package.package_format}">',
        f'  <name>{package.name}</name>',
        f'  <version>{package.version}</version>',
        f'  <description>{escape(package.description)}</description>',
        f'  <maintainer email={quoteattr(package.maintainer_email)}>'
        f'{escape(package.maintainer_name)}</maintainer>',
        f'  <license>{escape(package.license)}</license>',
    ]
    for group in groups:
        if group:
            lines.append('')
            lines.extend(f'  <{tag}>{escape(name)}</{tag}>' for tag, name in group)
    lines += [
        '',
        '  <export>',
        f'    <build_type>{package.build_type}</build_type>',
        '  </export>',
        '</package>',
    ]
    return '\n'.join(lines) + '\n'
