# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Workspaces that are not built, not sourced, or changed since they were built."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
import os
from pathlib import Path
import re
import sys

from ros2_diagnosis import package_files, packages, programs, setup_py
from ros2_diagnosis.finding import Finding

_BUILT = 'colcon_build.rc'  # colcon writes it at the end of each build
_SETTINGS = ('setup.py', 'setup.cfg', 'package.xml')


def check_workspaces(folder: Path) -> Iterator[Finding]:
    """Look at the workspace that a folder lies in, and at those that are sourced."""
    here = packages.workspace_of(folder)
    if here is not None:
        if programs.nothing_runs_on(here):
            yield Finding(
                str(here),
                f'{programs.NOTHING_RUNS_HERE}, so that `ros2 run` finds no program',
                programs.MOVE,
            )
        yield from check_built_and_sourced(here)
    # Many packages are of one prefix and of one workspace, whose sources are many files.
    workspace_of, sources_in = cache(packages.workspace_of), cache(packages.sources_in)
    for package, prefix in packages.installed().items():
        workspace = workspace_of(prefix)
        if workspace is None:
            continue
        source = sources_in(workspace / 'src').get(package)
        yield from _check_changed(package, prefix, workspace, source)
        if source is not None and (workspace != here or not package_files.why_refused(source)):
            yield from _check_failed(package, prefix)


def print_hints(package: str) -> None:
    """Tell on stderr where a package that is about to run is not what its sources say."""
    prefix = packages.installed().get(package)
    if prefix is not None:
        for finding in (*_check_failed(package, prefix), *check_changed(package, prefix)):
            print(f'hint: {finding}', file=sys.stderr)


def why_left(package: str, program: Path) -> str | None:
    """Say that a program is of an older build, and has no entry point; None where it may start."""
    source = packages.source_of(package)
    workspace = packages.workspace_of(program)
    if source is None or workspace is None:
        return None
    built_in = packages.built_in(workspace, package)
    if built_in is not None and not built_in.exists():
        return '; '.join(map(str, _check_moved(package, workspace)))
    if packages.failure_of(workspace, package) is not None:
        return None
    declared = setup_py.declared_programs(source)
    if declared is None or program.name in declared:
        return None
    built = workspace / 'build' / package / _BUILT
    was_read = built.is_file() and (source / 'setup.py').stat().st_mtime <= built.stat().st_mtime
    if not was_read or b"'console_scripts'" not in program.read_bytes():
        return None
    return (
        f"'{program.name}' is left of an older build, {source / 'setup.py'} names it no more; "
        f'there is {", ".join(sorted(declared)) or "no other"}, and `rm {program}` takes it away'
    )


def check_built_and_sourced(workspace: Path) -> Iterator[Finding]:
    installed = packages.installed()
    found = sorted(packages.sources_in(workspace / 'src').items())
    refused = {name: package_files.why_refused(path) for name, path in found}
    for name in refused:
        for why in refused[name]:
            yield Finding(name, f'colcon cannot build it: {why}', f'then {_build(workspace)}')
    sources = [name for name in refused if not refused[name]]
    unbuilt = [name for name in sources if packages.built_prefix(workspace, name) is None]
    if unbuilt:
        yield Finding(
            ', '.join(unbuilt),
            f'not built yet in {workspace}, so that `ros2 run` does not find it',
            _build(workspace),
        )
    sourced = {prefix.resolve() for prefix in packages.prefixes()}
    unsourced = []
    for name in sources:
        built = packages.built_prefix(workspace, name)
        if built is None:
            continue
        if built.resolve() not in sourced:
            unsourced.append(name)
        elif installed[name].resolve() != built.resolve():
            yield Finding(
                name,
                f'that of {packages.workspace_of(installed[name]) or installed[name]} runs here, '
                f'because it was sourced after {workspace}',
                f'open a new terminal and {packages.how_to_source(workspace)} last, if you mean '
                'this one',
                serious=False,
            )
    if unsourced:
        yield Finding(
            ', '.join(unsourced),
            f'built in {workspace}, but not sourced in this terminal',
            packages.how_to_source(workspace),
        )


def _build(workspace: Path) -> str:
    return f'run `colcon build` in {workspace}, then {packages.how_to_source(workspace)}'


def _check_moved(package: str, workspace: Path) -> Iterator[Finding]:
    built_in = packages.built_in(workspace, package)
    if built_in is not None:
        yield Finding(
            package,
            f'it was built in {built_in}, and this workspace is another or was renamed, so that '
            'no build of it ends well',
            f'`rm -r {workspace}/build {workspace}/install`, run `colcon build` in {workspace}, '
            'then open a new terminal',
        )


def _check_failed(package: str, prefix: Path) -> Iterator[Finding]:
    workspace = packages.workspace_of(prefix)
    if workspace is None or packages.built_in(workspace, package) is not None:
        return
    failure = packages.failure_of(workspace, package)
    if failure is not None:
        why = failure.removeprefix(f'{package}: ')
        yield Finding(
            package,
            f'the last `colcon build` of it failed, so that an older one runs: {why}',
            f'mend that, then run `colcon build --packages-select {package}` in {workspace}',
        )


def check_changed(package: str, prefix: Path) -> Iterator[Finding]:
    """Compare the sources of a package with what was built of them."""
    workspace = packages.workspace_of(prefix)
    if workspace is not None:
        source = packages.source_in(workspace, package)
        yield from _check_changed(package, prefix, workspace, source)


def _check_changed(
    package: str, prefix: Path, workspace: Path, source: Path | None
) -> Iterator[Finding]:
    if source is None and workspace.name == 'src' and package in packages.sources_in(workspace):
        made = ' '.join(str(workspace / name) for name in ('build', 'install', 'log'))
        yield Finding(
            package,
            f'`colcon build` was called in {workspace}, and what that made runs here',
            f'`rm -r {made}`, run `colcon build` in {workspace.parent}, then open a new terminal',
        )
        return
    if source is None:
        yield from _check_orphaned(package, prefix, workspace)
        return
    if moved := [*_check_moved(package, workspace)]:
        yield from moved
        return
    if not package_files.is_of_cmake(source):
        yield from _check_setup_py(package, prefix, source, workspace)
    for link in prefix.glob('lib/python3*/site-packages/*.egg-link'):
        modules = Path(link.read_text().partition('\n')[0])
        sourced = map(Path, os.environ.get('PYTHONPATH', '').split(os.pathsep))
        if modules.name == package and modules.resolve() not in {p.resolve() for p in sourced}:
            yield Finding(
                package,
                'built with `--symlink-install` since this terminal was sourced, which looks for '
                'its modules elsewhere',
                packages.how_to_source(workspace),
            )
    changed = changed_file(package, prefix, source, workspace / 'build' / package)
    if changed is not None:
        yield Finding(
            package,
            f'{changed} has changed since the package was built, so that the old one runs',
            f'run `colcon build --packages-select {package}` in {workspace}',
        )


def _check_setup_py(
    package: str, prefix: Path, source: Path, workspace: Path
) -> Iterator[Finding]:
    for program in packages.undeclared_programs(source, package):
        yield Finding(
            package,
            f'{program}.py has a main(), but no entry point: `ros2 run` does not know it',
            packages.how_to_declare(source, package, program),
            serious=False,
        )
    for program, why in setup_py.broken_programs(source, package):
        yield Finding(
            package,
            f'{program} of setup.py cannot start: {why}',
            f'then run `colcon build --packages-select {package}` in {workspace}',
        )
    yield from _check_left_out(package, prefix, source, workspace)


def _check_left_out(
    package: str, prefix: Path, source: Path, workspace: Path
) -> Iterator[Finding]:
    """Name the folders of modules that a build does not copy, but that the package imports."""
    modules = source / package
    texts = [path.read_text(encoding='utf-8', errors='replace') for path in modules.rglob('*.py')]
    copies = list(prefix.glob(f'lib/python3*/site-packages/{package}'))
    for folder, remedy in setup_py.left_out(source, package).items():
        below = folder.relative_to(modules)
        name = re.escape('.'.join(below.parts))
        imported = re.compile(
            rf'import {package}\.{name}\b|from (?:{package})?\.{name}\b'
            rf'|from (?:{package}|\.) import .*\b{name}\b'
        )
        if any(not (copy / below).exists() for copy in copies) and any(
            map(imported.search, texts)
        ):
            yield Finding(
                package,
                f'{folder} is imported, but not installed',
                f'{remedy}, then run `colcon build --packages-select {package}` in {workspace}',
            )


def _check_orphaned(package: str, prefix: Path, workspace: Path) -> Iterator[Finding]:
    if prefix != workspace / 'install' / package:
        return
    # colcon looks everywhere below a workspace; that may be a home with very many folders.
    sources = packages.sources_in(workspace / 'src', depth=8)
    if sources and package not in sources | packages.sources_in(workspace, depth=3):
        yield Finding(
            package,
            f'an old build: {workspace} has no sources of it any more, as of a package that was '
            'renamed',
            f'`rm -r {prefix} {workspace / "build" / package}`, then open a new terminal',
        )


def changed_file(package: str, prefix: Path, source: Path, build: Path) -> Path | None:
    """Return the first file that differs from its installed copy; None where all is current."""
    left_out = setup_py.left_out(source, package)
    for folder, target in _copied_folders(package, prefix, source):
        for path in sorted(folder.rglob('*')):
            if not path.is_file() or '__pycache__' in path.parts or path.parent in left_out:
                continue
            copy = target / path.relative_to(folder)
            if copy.is_file():
                if copy.resolve() != path.resolve() and copy.read_bytes() != path.read_bytes():
                    return path
            elif path.suffix == '.py' and target.is_dir() and folder.name == package:
                return path
    built = build / _BUILT
    for name in _SETTINGS:
        path = source / name
        if path.is_file() and built.is_file() and path.stat().st_mtime > built.stat().st_mtime:
            return path
    return None


def _copied_folders(package: str, prefix: Path, source: Path) -> Iterator[tuple[Path, Path]]:
    for target in prefix.glob(f'lib/python3*/site-packages/{package}'):
        yield source / package, target
    share = prefix / 'share' / package
    for name in ('launch', 'config', 'worlds', 'urdf', 'params', 'msg', 'srv'):
        if (source / name).is_dir() and (share / name).is_dir():
            yield source / name, share / name
