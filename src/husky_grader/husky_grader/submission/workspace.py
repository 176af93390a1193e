# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Find the workspace, or the waypoint file, in what was unpacked, and give it its place."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
import shutil
from typing import Literal

from husky_grader.folder_names import folder_names
from husky_grader.submission.kinds import (
    HEAD_BYTES,
    is_called_archive,
    is_called_yaml,
    kind_of,
)
from husky_grader.submission.limits import BUILT, COPY, FOLDERS_OF_COLCON, IGNORED, Refused
from husky_grader.submission.tree import common_start, Parts, PASSABLE, shown, TreeWriter

_MANIFEST = 'package.xml'
_HAND_IN = (
    'hand in the workspace, with your packages in src, or the waypoint file alone where one is '
    'asked for'
)
_MOST_SHOWN = 5
# What people hand in beside a waypoint file, as a report, and what repositories have.
_DOCUMENTS = ('.pdf', '.txt', '.md', '.doc', '.docx', '.odt', '.png', '.jpg', '.jpeg', '.svg')
_DOCUMENT = 'license'
_MADE = {COPY, BUILT, *FOLDERS_OF_COLCON}


@dataclass(frozen=True)
class Workspace:
    """What was handed in, unpacked: plain files and folders only."""

    path: Path  # the workspace, with src in it; or the waypoint file
    kind: Literal['workspace', 'waypoints']
    handed: Literal['workspace', 'packages', 'package', 'file']  # how much of it they gave
    notes: tuple[str, ...] = ()  # what was left out, a line each


@dataclass(frozen=True)
class _Root:
    """The folder in a tree that is taken, and what it becomes."""

    parts: Parts
    handed: Literal['workspace', 'packages', 'package']


def settle(tree: TreeWriter, staging: Path, folder: Path, name: str) -> Workspace:
    """
    Move the workspace out of what was written; an older one of its name is replaced.

    :param staging: where the tree was written.
    :param folder: where the workspace gets its place.
    :param name: of the workspace, where the tree has no folder of its own around it.
    :raises Refused: when there is none, more than one, or what is neither file nor folder in it.
    """
    if not tree.others and (alone := _file_alone(tree.files)) is not None:
        beside = [parts for parts in tree.files if parts is not alone]
        notes = (f'left out beside {shown(alone)}: {_listed(sorted(beside))}',) if beside else ()
        return replace(_settle_file(alone, staging, folder), notes=notes)
    tools = _made_by_tools(tree)
    root = _find_root(tree, tools)
    for parts, what in tree.others.items():
        if _left_out(parts, root, tools) is None:
            raise _not_plain(parts, what)
    places = (_left_out(parts, root, tools) for parts in tree.files)
    left = sorted({each for each in places if each is not None})
    for each in left:
        if each[: len(root.parts)] == root.parts:
            shutil.rmtree(staging.joinpath(*each))
    place = _place(folder, root.parts[-1] if root.parts else name)
    if root.handed == 'workspace':
        target = place
    else:
        target = place / 'src' / (place.name if root.handed == 'package' else '')
        target.parent.mkdir(parents=True)
        for made in (place, target.parent):
            made.chmod(PASSABLE)
    staging.joinpath(*root.parts).rename(target)
    notes = (f'left out: {_listed(left)}',) if left else ()
    return Workspace(place, 'workspace', root.handed, notes)


def _file_alone(files: Sequence[Parts]) -> Parts | None:
    """Return the only file, or the only waypoint file where all others are documents or hidden."""
    if len(files) == 1:
        return files[0] if files[0][-1] != _MANIFEST else None
    others = [parts for parts in files if not _is_document(parts)]
    return others[0] if len(others) == 1 and is_called_yaml(others[0][-1]) else None


def _is_document(parts: Parts) -> bool:
    name = parts[-1].lower()
    hidden = any(part.startswith('.') for part in parts)
    return hidden or name == _DOCUMENT or name.endswith(_DOCUMENTS)


def _settle_file(parts: Parts, staging: Path, folder: Path) -> Workspace:
    path = staging.joinpath(*parts)
    with path.open('rb') as file:
        kind = kind_of(file.read(HEAD_BYTES), path.name)
    if kind in ('zip', 'tar'):
        raise Refused(f'only another archive is in it, {shown(parts)}; hand in that one')
    if kind != 'yaml':
        raise Refused(f'only {shown(parts)} is in it; {_HAND_IN}')
    place = _place(folder, path.name)
    path.rename(place)
    return Workspace(place, 'waypoints', 'file')


def _made_by_tools(tree: TreeWriter) -> list[Parts]:
    """
    Return the folders that colcon and this grader have made and marked, outermost first.

    Beside src, and in src, where colcon was called there.
    """
    marked = [parts[:-1] for parts in tree.files if parts[-1] == IGNORED]
    return sorted((parts for parts in marked if parts and parts[-1] in _MADE), key=len)


def _find_root(tree: TreeWriter, made: Sequence[Parts]) -> _Root:
    """
    Return where the packages lie: beside each other in src, or without it.

    :param made: folders of tools.
    """
    packages = [
        parts[:-1]
        for parts in tree.files
        if parts[-1] == _MANIFEST and not (_is_built(parts) or _made_around(parts, made))
    ]
    if not packages:
        for parts, what in tree.others.items():
            raise _not_plain(parts, what)
        raise Refused(f'no package in it (no {_MANIFEST}), but: {_instead(tree)}')
    roots = sorted({parts[: parts.index('src')] for parts in packages if 'src' in parts})
    if len(roots) > 1:
        raise Refused(f'{len(roots)} workspaces in it: {_listed(roots)}; hand in one')
    if roots:
        return _Root(roots[0], 'workspace')
    if () in packages:
        return _Root((), 'package')
    return _Root(common_start([parts[:-1] for parts in packages]), 'packages')


def _instead(tree: TreeWriter) -> str:
    """Return what is there in the place of packages, and what to do."""
    archives = sorted(parts for parts in tree.files if is_called_archive(parts[-1]))
    if archives:
        alone = 'hand in that one'
        several = 'hand in one; a whole class is given unpacked, or as the export that it was'
        return f'{_listed(archives)}; {several if len(archives) > 1 else alone}'
    depth = len(common_start([parts[:-1] for parts in tree.files])) if tree.files else 0
    found = sorted({parts[: depth + 1] for parts in tree.files})
    return f'{_listed(found)}; {_HAND_IN}'


def _is_built(parts: Parts) -> bool:
    """Tell whether something lies in what colcon has made beside src."""
    outside = parts[: parts.index('src')] if 'src' in parts else parts
    return any(part in FOLDERS_OF_COLCON for part in outside)


def _made_around(parts: Parts, made: Sequence[Parts]) -> Parts | None:
    """Return the outermost folder of a tool in which something lies, if it does."""
    return next((folder for folder in made if parts[: len(folder)] == folder), None)


def _left_out(parts: Parts, root: _Root, made: Sequence[Parts]) -> Parts | None:
    """Return the folder with which something is left out, if it is."""
    return _made_around(parts, made) if _is_kept(parts, root) else _outermost(parts, root)


def _is_kept(parts: Parts, root: _Root) -> bool:
    """Tell whether something is in the root, and in no folder that colcon has made there."""
    below = parts[len(root.parts) :]
    made_by_colcon = len(below) > 1 and below[0] in FOLDERS_OF_COLCON
    return parts[: len(root.parts)] == root.parts and not made_by_colcon


def _outermost(parts: Parts, root: _Root) -> Parts:
    """Return the folder nearest to the root's that has only what is left out."""
    common = len(common_start([parts, root.parts]))
    return parts[: common + 1]


def _not_plain(parts: Parts, what: str) -> Refused:
    return Refused(f'{shown(parts)} is {shown((what,))}; hand in files and folders only')


def _listed(paths: Sequence[Parts]) -> str:
    names = [shown(parts) or '.' for parts in paths[:_MOST_SHOWN]]
    more = [f'{len(paths) - _MOST_SHOWN} more'] if len(paths) > _MOST_SHOWN else []
    return ', '.join([*names, *more]) or 'nothing'


def _place(folder: Path, name: str) -> Path:
    """
    Return the place for what has a name, after one that an earlier call has left there is gone.

    It is never that of the file which keeps colcon out of the folder.
    """
    (free,) = folder_names([Path(name)], taken=[IGNORED])
    place = folder / free
    if place.is_dir():
        shutil.rmtree(place)
    return place
