# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The steps that can be judged by looking at files: workspace and packages."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
import os
from pathlib import Path
import re
import xml.etree.ElementTree as ElementTree

from husky_course.printable import printable

from husky_grader.lab.finding import Finding, nothing
from husky_grader.rubric.steps import PackageStep, WorkspaceStep
from husky_grader.run.diagnosis import shortened

MAX_MANIFEST = 100_000  # bytes
PACKAGE_NAME = re.compile(r'[A-Za-z][\w-]*', re.ASCII)  # REP-149: no way to another folder
# colcon passes over a folder in which one of these lies, with all that is below it.
IGNORED = {'COLCON_IGNORE', 'AMENT_IGNORE', 'CATKIN_IGNORE'}
MOST_TOLD = 3  # folders that look like packages and are none
MOST_OF_A_NAME = 60  # characters
# A workspace that was packed without a folder around it has the name of the archive: Canvas adds
# "-1" to it when a student hands in again, a browser " (1)", Firefox "(1)", "Download ZIP" of
# GitHub the branch.
_ADDED = re.compile(r'(-\d+| ?\(\d+\)|-main|-master)$', re.ASCII)


def workspace_step(step: WorkspaceStep, workspace: Path) -> Finding:
    """Look at the workspace's name and its src folder."""
    if not (workspace / 'src').is_dir():
        return nothing(f'{workspace.name} has no folder src; packages live in it')
    names = [workspace.name]
    while (shorter := _ADDED.sub('', names[-1])) != names[-1]:
        names.append(shorter)
    if step.forms and not any(form.fits(name) for form in step.forms for name in names):
        return Finding('', defects={'name': f'named {workspace.name}; {asked(step.forms[0])}'})
    return Finding(f'{workspace.name} with a folder src')


def asked(what: object) -> str:
    return f'the lab asks for {what}'


def package_step(step: PackageStep, workspace: Path) -> Finding:
    """Look at a package's manifest; at the best one where several packages may be meant."""
    try:
        manifests = find_packages(workspace, step.package, step.package_with)
    except PackageMissing as error:
        return nothing(str(error))
    findings = [_manifest_finding(step, manifest) for manifest in manifests]
    return min(findings, key=lambda found: sum(map(step.cost_percent, found.defects)))


def _manifest_finding(step: PackageStep, manifest: Manifest) -> Finding:
    root, defects = manifest.root, {}
    given = {text_of(element) for element in root if element.tag.endswith('depend')}
    if missing := [wanted for wanted in step.dependencies if wanted not in given]:
        lines = ' '.join(f'<exec_depend>{wanted}</exec_depend>' for wanted in missing)
        defects['dependencies'] = f'package.xml lacks: {lines}'
    if step.build_type not in map(text_of, root.findall('export/build_type')):
        line = f'<export><build_type>{step.build_type}</build_type></export>'
        defects['build_type'] = f'package.xml lacks {line}'
    if todo := [element.tag for element in root if text_of(element).startswith('TODO')]:
        defects['todo'] = f'package.xml still says TODO: fill in its {" and ".join(todo)}'
    return Finding(f'package.xml of {manifest.name} is complete', defects=defects)


class PackageMissing(ValueError):
    """There is no such package; the message says what there is."""


@dataclass(frozen=True)
class Manifest:
    """A package.xml that could be read."""

    name: str
    folder: Path
    root: ElementTree.Element


def find_packages(workspace: Path, name: str, with_file: str) -> list[Manifest]:
    """
    Return the packages of the workspace that may be meant; where the name is given, it is one.

    :param with_file: the file that they have, where the name is not given.
    :raises PackageMissing: when there is none.
    """
    manifests = find_manifests(workspace)
    found = [
        manifest
        for manifest in manifests
        if manifest.name == name or (with_file and any(manifest.folder.glob(f'**/{with_file}')))
    ]
    if not found:
        what = name or f'a package with {with_file}'
        have = ', '.join(sorted(manifest.name for manifest in manifests)) or 'none'
        told = [f'{what} is not in src', f'packages there: {have}', *no_packages(workspace)]
        raise PackageMissing('; '.join(told))
    return found


def find_manifests(workspace: Path) -> list[Manifest]:
    """
    Return the manifests that can be read of the packages that colcon finds, in their order.

    It looks for none in a package, in hidden folders, or where a file says that it is to pass.
    """
    return [found for found in _found(workspace) if isinstance(found, Manifest)]


def no_packages(workspace: Path) -> list[str]:
    """Return of what looks like a package, and is none for colcon, why; of the first ones."""
    found = list(_found(workspace))
    told = [each for each in found if isinstance(each, str)]
    for outer in found:
        if isinstance(outer, Manifest):
            told += [
                f'{_shown(inner.parent, workspace)} is passed over: it lies in {outer.name}'
                for inner in sorted(outer.folder.glob('*/**/package.xml'))
            ]
    return told[:MOST_TOLD]


def _found(workspace: Path) -> Iterator[Manifest | str]:
    """Yield the manifests, and of what has none that colcon takes the reason."""
    for place, folders, files in os.walk(workspace / 'src'):
        folders[:] = sorted(name for name in folders if not name.startswith('.'))
        folder = Path(place)
        if marks := IGNORED.intersection((*folders, *files)):
            folders.clear()
            yield f'{_shown(folder, workspace)} is passed over: a {min(marks)} is in it'
        elif 'package.xml' in files:
            found = _read_manifest(folder / 'package.xml')
            if isinstance(found, Manifest):
                folders.clear()
                yield found
            elif found:
                yield f'{_shown(folder, workspace)} is no package: {found}'


def _shown(folder: Path, workspace: Path) -> str:
    return printable(folder.relative_to(workspace).as_posix())


def _read_manifest(path: Path) -> Manifest | str:
    """Return a manifest, or why it is none; nothing where it is no file."""
    # Never a pipe or a device: to read one may take for ever.
    if path.is_symlink() or not path.is_file():
        return ''
    try:
        with path.open('rb') as stream:
            text = stream.read(MAX_MANIFEST + 1)
        if len(text) > MAX_MANIFEST:
            return f'its package.xml is larger than {MAX_MANIFEST} bytes'
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, LookupError, ValueError, OSError) as error:
        # LookupError and ValueError: an encoding that Python does not know
        why = getattr(error, 'strerror', None) or error
        return f'its package.xml cannot be read: {shortened(printable(str(why)))}'
    name = (root.findtext('name') or '').strip()
    if not name:
        return 'its package.xml has no <name>'
    if not PACKAGE_NAME.fullmatch(name):
        shown = shortened(printable(name), MOST_OF_A_NAME)
        return f"its <name> is '{shown}': letters, digits and _ are allowed, a letter first"
    return Manifest(name, path.parent, root)


def text_of(element: ElementTree.Element) -> str:
    """Return the text of an element as ROS reads it: without the spaces around it."""
    return (element.text or '').strip()
