# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The steps that can be judged by looking at files: workspace and packages."""

from dataclasses import dataclass
from pathlib import Path
import re
import xml.etree.ElementTree as ElementTree

from husky_grader.lab.finding import Finding, nothing
from husky_grader.rubric.steps import PackageStep, WorkspaceStep

MAX_MANIFEST = 100_000  # bytes
PACKAGE_NAME = re.compile(r'[A-Za-z][\w-]*', re.ASCII)  # REP-149: no way to another folder


def workspace_step(step: WorkspaceStep, workspace: Path) -> Finding:
    """Look at the workspace's name and its src folder."""
    if not (workspace / 'src').is_dir():
        return nothing(f'{workspace.name} has no folder src; packages live in it')
    if step.forms and not any(form.fits(workspace.name) for form in step.forms):
        return Finding('', defects={'name': f'named {workspace.name}; {asked(step.forms[0])}'})
    return Finding(f'{workspace.name} with a folder src')


def asked(what: object) -> str:
    return f'the lab asks for {what}'


def package_step(step: PackageStep, workspace: Path) -> Finding:
    """Look at a package's manifest."""
    try:
        manifest = find_package(workspace, step.package, step.package_with)
    except PackageMissing as error:
        return nothing(str(error))
    root, defects = manifest.root, {}
    given = {element.text for element in root if element.tag.endswith('depend')}
    if missing := [wanted for wanted in step.dependencies if wanted not in given]:
        lines = ' '.join(f'<exec_depend>{wanted}</exec_depend>' for wanted in missing)
        defects['dependencies'] = f'package.xml lacks: {lines}'
    if root.findtext('export/build_type') != step.build_type:
        line = f'<export><build_type>{step.build_type}</build_type></export>'
        defects['build_type'] = f'package.xml lacks {line}'
    if todo := [element.tag for element in root if (element.text or '').startswith('TODO')]:
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


def find_package(workspace: Path, name: str, with_file: str) -> Manifest:
    """
    Return a package of the workspace.

    :param with_file: the file that it has, where its name is not given.
    :raises PackageMissing: when there is none.
    """
    manifests = find_manifests(workspace)
    for manifest in manifests:
        if manifest.name == name or (with_file and any(manifest.folder.glob(f'**/{with_file}'))):
            return manifest
    what = name or f'a package with {with_file}'
    have = ', '.join(sorted(manifest.name for manifest in manifests)) or 'none'
    raise PackageMissing(f'{what} is not in src; packages there: {have}')


def find_manifests(workspace: Path) -> list[Manifest]:
    """Return the manifests that can be read, in the order of their folders."""
    found = []
    for path in sorted((workspace / 'src').glob('**/package.xml')):
        # Never a pipe or a device: to read one may take for ever.
        if path.is_symlink() or not path.is_file():
            continue
        try:
            with path.open('rb') as stream:
                root = ElementTree.fromstring(stream.read(MAX_MANIFEST))
        except (ElementTree.ParseError, LookupError, ValueError, OSError):
            continue  # LookupError and ValueError: an encoding that Python does not know
        name = (root.findtext('name') or '').strip()
        if PACKAGE_NAME.fullmatch(name):
            found.append(Manifest(name, path.parent, root))
    return found
