# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Installed packages, their executables and files, and why one cannot be found."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
import os
from pathlib import Path
import re

from ros2_diagnosis import nearest, package_files, PackageError, programs, setup_py, stand_ins

LAUNCH_SUFFIXES = (
    '.launch.py', '.launch.xml', '.launch.yaml', '.launch.yml',
    '_launch.py', '_launch.xml', '_launch.yaml', '_launch.yml',
)  # fmt: skip

_INDEX = 'share/ament_index/resource_index/packages'
_PROGRAM = re.compile(r'^def main\(', re.MULTILINE)
_NOT_COPIED = re.compile(r"error: can't copy '(.+)': doesn't exist or not a regular file")
_PACKAGE_NAME = re.compile(r'<name>\s*([^<\s]+)\s*</name>')


def prefixes() -> list[Path]:
    return [Path(p) for p in os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep) if p]


def installed() -> dict[str, Path]:
    """Map every package on AMENT_PREFIX_PATH to the first prefix that has it."""
    found: dict[str, Path] = {}
    for prefix in prefixes():
        try:
            names = sorted(path.name for path in (prefix / _INDEX).iterdir())
        except OSError:
            continue
        for name in names:
            if not name.startswith('.'):
                found.setdefault(name, prefix)
    return found


def prefix_of(package: str, program: str = '') -> Path:
    """Return the prefix of a package.

    :param program: the one of the package that is wanted, where it is known.
    :raises PackageError: it is not there; the message says why and what to do.
    """
    known = installed()
    if package not in known:
        raise PackageError(f"Package '{package}' not found: {why_missing(package, program)}")
    return known[package]


def share_of(package: str, program: str = '') -> Path:
    return prefix_of(package, program) / 'share' / package


def executables(package: str, program: str = '') -> list[Path]:
    """List the executables of a package in the order of their paths.

    :param program: the one that is wanted, where it is known.
    """
    folder = prefix_of(package, program) / 'lib' / package
    found: list[Path] = []
    for root, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith('.'))
        found.extend(
            Path(root, name) for name in sorted(files) if os.access(Path(root, name), os.X_OK)
        )
    return found


def find_executable(package: str, name: str) -> Path:
    """Return the executable of a package.

    :raises PackageError: there is none of this name, or more than one.
    """
    known = executables(package, name)
    matching = [path for path in known if path.name == name]
    if len(matching) == 1:
        return matching[0]
    if matching:
        choices = ', '.join(str(path) for path in matching)
        raise PackageError(
            f"Multiple executables named '{name}' in package '{package}': {choices}; "
            'call one of them by its path'
        )
    if why := programs.why_not_executable(prefix_of(package, name) / 'lib' / package / name):
        raise PackageError(f"No executable found: package '{package}' has '{name}', but {why}")
    source = source_of(package)
    if source is not None and package_files.is_of_cmake(source):
        if why := _why_not_of_cmake(source, package, name, {path.name for path in known}):
            raise PackageError(f'No executable found: {why}')
        source = None  # a setup.py that is left there counts for nothing
    if source is not None and _declares(source, name):
        why = package_files.why_not_run(source, package) or (
            f"but package '{package}' was built before that; run `colcon build --packages-select "
            f'{package}` in {_workspace_of_built(package, source)}'
        )
        raise PackageError(
            f"No executable found: '{name}' is declared in {source / 'setup.py'}, {why}"
        )
    stem = name.removesuffix('.py')
    if source is not None and stem in undeclared_programs(source, package):
        raise PackageError(
            f'No executable found: {source / package / stem}.py has a main(), but no entry point; '
            f'{how_to_declare(source, package, stem)}'
        )
    lost = setup_py.misplaced(source, package, stem) if source is not None else None
    if source is not None and lost is not None:
        raise PackageError(
            f'No executable found: {lost} is not in {source / package}, that of the programs: '
            f'move it there, and {how_to_declare(source, package, stem)}'
        )
    if instead := stand_ins.hint_of_missing_part(package, name):
        raise PackageError(f"No executable found: package '{package}' has no '{name}': {instead}")
    if not known:
        raise PackageError(
            f"No executable found: package '{package}' has none; a Python node needs a line "
            "under 'console_scripts' in its setup.py, then `colcon build`"
        )
    raise PackageError(
        f"No executable found: package '{package}' has no '{name}'"
        f'{nearest.hint(name, (path.name for path in known))}'
    )


def _why_not_of_cmake(source: Path, package: str, name: str, known: set[str]) -> str | None:
    script = f'{name.removesuffix(".py")}.py'
    found = None if script in known else next(iter(sorted(source.rglob(script))), None)
    if found is None:
        return None
    workspace = _workspace_of_built(package, source)
    build = f'run `colcon build --packages-select {package}` in {workspace}'
    text = (source / 'CMakeLists.txt').read_text(encoding='utf-8', errors='replace')
    if script in text:
        return f'{found} is not installed yet: {build}'
    return (
        f'{found} is not installed: write install(PROGRAMS {found.relative_to(source)} '
        f'DESTINATION lib/${{PROJECT_NAME}}) in {source / "CMakeLists.txt"}, which alone counts '
        f'where package.xml says ament_cmake, {build}, and `ros2 run {package} {script}`'
    )


def launch_files(share: Path) -> list[Path]:
    """List what looks like a launch file below a folder."""
    return [
        p for p in sorted(share.rglob('*')) if p.name.endswith(LAUNCH_SUFFIXES) and p.is_file()
    ]


def why_not_installed(package: str, name: str) -> str | None:
    """Say why a file of the sources of a package is not in its share; None where there is none."""
    source = source_of(package)
    found = sorted(path for path in source.rglob('*') if path.name == name) if source else []
    return _how_to_install(package, source, found[0]) if source and found else None


def why_not_in_share(path: Path) -> str | None:
    """Say why a file is not in the share of a package whose sources have it; None for others."""
    for prefix in prefixes():
        with contextlib.suppress(ValueError):  # it is not below that
            package, *below = path.relative_to(prefix / 'share').parts
            source = source_of(package) if below else None
            if source is not None and source.joinpath(*below).is_file():
                return _how_to_install(package, source, source.joinpath(*below))
    return None


def _how_to_install(package: str, source: Path, found: Path) -> str:
    folder = found.parent.relative_to(source)
    workspace = _workspace_of_built(package, source)
    build = f'run `colcon build --packages-select {package}` in {workspace}'
    if package_files.is_of_cmake(source) or not (source / 'setup.py').is_file():
        line = f'install(DIRECTORY {folder} DESTINATION share/${{PROJECT_NAME}})'
        return f'{found} is not installed: write {line} in CMakeLists.txt, and {build}'
    if re.search(rf"""['"/]{re.escape(str(folder))}['"/]""", _setup_of(source)):
        return f'{found} is not installed yet: {build}'
    line = f"('share/{package}/{folder}', glob('{folder}/*'))"
    return (
        f'{found} is not installed: add {line} to data_files in {source / "setup.py"}, `from '
        f'glob import glob` at its top, and {build}'
    )


def why_missing(package: str, program: str = '') -> str:
    """Say why a package is not on AMENT_PREFIX_PATH, and what to do.

    :param program: the one of the package that is wanted, where it is known.
    """
    if not prefixes():
        return 'AMENT_PREFIX_PATH is empty: no ROS is sourced in this terminal'
    workspace = workspace_of(Path.cwd())
    if workspace is not None:
        why = why_unbuilt(workspace, package)
        if why is not None:
            return why
        if built_prefix(workspace, package) is not None:
            return (
                f'it is built in {workspace}, but not sourced in this terminal; '
                f'run {how_to_source(workspace)}'
            )
    instead = stand_ins.hint(package, program)
    if instead:
        return instead
    elsewhere = next(_workspaces_at_home_with(package), None)
    if elsewhere is not None:
        return (
            f'it is built in {elsewhere}, but not sourced in this terminal; '
            f'run {how_to_source(elsewhere)}'
        )
    near = nearest.hint(package, installed(), at_most=0)
    if near:
        return f'no such package is sourced or installed{near}'
    return (
        'it is neither sourced nor installed; `ros2 pkg list` shows what is, and a workspace of '
        'your own needs `colcon build` and `source install/setup.bash`'
    )


# Workspaces


def how_to_source(workspace: Path) -> str:
    """Return the command that sources a workspace in the shell that has started this program."""
    try:
        shell = Path(f'/proc/{os.getppid()}/comm').read_text().strip()
    except OSError:
        shell = 'bash'
    setup = workspace / 'install' / 'setup.bash'
    if shell == 'zsh':
        return f'`source {setup.with_suffix(".zsh")}`'
    if shell == 'fish':  # for which colcon makes no set-up files
        return f'`bash -c "source {setup} && exec fish"`'
    return f'`source {setup}`'


def _workspaces_at_home_with(package: str) -> Iterator[Path]:
    """Yield the workspaces that lie in the home folder, as in tutorials, and have a package."""
    with contextlib.suppress(OSError, RuntimeError):  # RuntimeError: there is no home
        for folder in sorted(Path.home().iterdir()):
            if (folder / 'install' / 'setup.bash').is_file() and built_prefix(folder, package):
                yield folder


def why_unbuilt(workspace: Path, package: str) -> str | None:
    """Say why a package in the src of a workspace is not built; None where it is, or not there."""
    source = source_in(workspace, package)
    if source is None:
        return None
    build = (
        f'run `colcon build --packages-select {package}` in {workspace}, then '
        f'{how_to_source(workspace)}'
    )
    refused = package_files.why_refused(source)
    if refused:
        return f'it is in {source}, but colcon cannot build it: {"; ".join(refused)}; then {build}'
    if built_prefix(workspace, package) is not None:
        return None
    ignored = _ignored(source, workspace)
    if ignored is not None:
        return (
            f'it is in {source}, but colcon passes over it for {ignored}; remove that and {build}'
        )
    failure = failure_of(workspace, package)
    if failure is not None:
        return f'it is in {source}, but `colcon build` failed: {failure}; mend that, and {build}'
    return f'it is in {source}, but not built; {build}'


def _ignored(source: Path, workspace: Path) -> Path | None:
    for folder in (source, *source.parents):
        for name in ('COLCON_IGNORE', 'AMENT_IGNORE'):
            if (folder / name).exists():
                return folder / name
        if folder == workspace:
            return None
    return None


def failure_of(workspace: Path, package: str) -> str | None:
    """Say why the last build of a package failed, None where it did not."""
    try:
        status = (workspace / 'build' / package / 'colcon_build.rc').read_text().strip()
        log = workspace / 'log' / 'latest_build' / package / 'stderr.log'
        text = log.read_text(encoding='utf-8', errors='replace')
    except OSError:
        return None
    said = [line.strip() for line in text.split('\n') if line.strip()]
    if status == '0' or not said:
        return None
    if said[-1].startswith('subprocess.CalledProcessError') and 'get_setup_information' in text:
        source = source_in(workspace, package)
        return f'setup.py ends with an error, which `python3 setup.py --name` in {source} shows'
    copied = _NOT_COPIED.fullmatch(said[-1])
    if copied is not None and Path(copied[1]).is_symlink():  # --symlink-install leaves it there
        build = workspace / 'build' / package
        return (
            f'{copied[1]} leads to a file that was renamed or removed; `rm -r {build}` clears it'
        )
    return said[-1]


def workspace_of(path: Path) -> Path | None:
    """Return the colcon workspace that a folder lies in: the nearest one with src or install."""
    for folder in (path, *path.parents):
        if (folder / 'install' / 'setup.bash').is_file() or any(sources_in(folder / 'src')):
            return folder
    return None


def _workspace_of_built(package: str, source: Path) -> Path | None:
    """Return the workspace that a package is built in: `src` may be one as well, by mistake."""
    return workspace_of(installed().get(package, source))


def sources_in(folder: Path, *, depth: int = 4) -> dict[str, Path]:
    """Map the packages whose sources lie below a folder to where they lie."""
    found: dict[str, Path] = {}
    if not folder.is_dir():
        return found
    if (folder / 'package.xml').is_file():
        return {name_in(folder): folder}
    if depth == 0 or (folder / 'COLCON_IGNORE').exists():
        return found
    for child in sorted(folder.iterdir()):
        if child.is_dir() and not child.name.startswith('.'):
            found |= sources_in(child, depth=depth - 1)
    return found


def name_in(folder: Path) -> str:
    """Return the name that a package.xml tells, that of its folder where it tells none."""
    text = (folder / 'package.xml').read_text(encoding='utf-8', errors='replace')
    match = _PACKAGE_NAME.search(text)
    return match[1] if match else folder.name


def source_in(workspace: Path, package: str) -> Path | None:
    return sources_in(workspace / 'src').get(package)


def source_of(package: str) -> Path | None:
    """Return where the sources of an installed package lie, if it comes from a workspace."""
    prefix = installed().get(package)
    if prefix is None:
        return None
    workspace = workspace_of(prefix)
    return source_in(workspace, package) if workspace is not None else None


def built_prefix(workspace: Path, package: str) -> Path | None:
    for prefix in (workspace / 'install' / package, workspace / 'install'):
        if os.path.lexists(prefix / _INDEX / package):  # a link to nothing where it was moved
            return prefix
    return None


def built_in(workspace: Path, package: str) -> Path | None:
    """Return the workspace that --symlink-install has built a package in, if it was another."""
    prefix = built_prefix(workspace, package)
    link = prefix / _INDEX / package if prefix is not None else None
    if link is None or not link.is_symlink():
        return None
    made = link.readlink()  # WORKSPACE/build/PACKAGE/resource/PACKAGE
    if made.parent.resolve().is_relative_to(workspace.resolve()) or len(made.parents) < 4:
        return None
    return made.parents[3] if made.parents[2].name == 'build' else None


def undeclared_programs(source: Path, package: str) -> list[str]:
    """
    List the modules of an ament_python package that are programs, but that nothing names.

    One that others import is a part of theirs, and `python3 -m` runs `__main__`.
    """
    setup = _setup_of(source)
    if 'console_scripts' not in setup:
        return []
    files = sorted((source / package).glob('*.py'))
    texts = {file.stem: file.read_text(encoding='utf-8', errors='replace') for file in files}
    texts.pop('__main__', None)
    everything = '\n'.join([setup, *texts.values()])
    lists = re.findall(rf'\bfrom (?:\.|{package}) import (\([^)]*\)|.*)', everything)
    imported = set(re.findall(r'\w+', '\n'.join(lists)))
    return [
        stem
        for stem, text in texts.items()
        if _PROGRAM.search(text)
        and stem not in imported
        and not _declares(source, stem)
        and re.search(rf'\b{package}\.{stem}\b|\.{stem} import', everything) is None
    ]


def how_to_declare(source: Path, package: str, program: str) -> str:
    """Say what makes a module an executable."""
    return (
        f"add '{program} = {package}.{program}:main' to 'console_scripts' in "
        f'{source / "setup.py"}, then run `colcon build --packages-select {package}` in '
        f'{_workspace_of_built(package, source)}'
    )


def _declares(source: Path, executable: str) -> bool:
    text = _setup_of(source)
    return re.search(rf"""['"]\s*{re.escape(executable)}\s*=""", text) is not None


def _setup_of(source: Path) -> str:
    try:
        return (source / 'setup.py').read_text(encoding='utf-8')
    except OSError:
        return ''
