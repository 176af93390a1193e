# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a setup.py asks for, as far as it can be read without running it."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterator
from importlib.machinery import PathFinder
from importlib.util import find_spec
from pathlib import Path
import re
import sys
import warnings

from ros2_diagnosis import nearest

# As setuptools takes it: NAME = PACKAGE.MODULE:FUNCTION.
_ENTRY_POINT = re.compile(r'\s*(\S[^=]*?)\s*=\s*([\w.]+)\s*(?::\s*([\w.]+)\s*)?(?:\[.*\]\s*)?')

# By these a name may be bound that no line binds.
_BINDING = {'exec', 'globals', 'locals', 'vars'}
# What calls nothing else makes no files.
_MAKING_NO_FILES = {
    *('setup', 'find_packages', 'find_namespace_packages', 'glob', 'iglob', 'print', 'str'),
    *('join', 'dirname', 'abspath', 'realpath', 'basename', 'exists', 'isfile', 'isdir'),
    *('listdir', 'walk', 'sorted', 'list', 'tuple', 'append', 'extend', 'Path', 'read_text'),
}


def faults(folder: Path) -> Iterator[str]:
    """Say, a line each, at what the setup.py in a folder ends when colcon runs it.

    Nothing where that is not certain: then colcon shall try.
    """
    try:
        tree = _parsed(folder / 'setup.py')
    except SyntaxError as error:
        quotes = ', which a word processor writes: type \' or "' if '(U+201' in error.msg else ''
        yield f'setup.py:{error.lineno}: {error.msg}{quotes}'
        return
    yield from _missing_modules(tree, folder)
    call = _call_of_setup(tree)
    if call is None:
        if not _called(tree):
            yield 'setup.py does not call setup(): `ros2 pkg create` writes one that does'
        return
    values = _constants(tree)
    yield from _unbound_names(tree)
    for node, text in _scripts(call, values):
        if _ENTRY_POINT.fullmatch(text) is None:
            comma = '; is there no comma behind the line before?' if text.count('=') > 1 else ''
            yield (
                f'setup.py:{node.lineno}: {text!r} is no entry point: write '
                f"'NAME = PACKAGE.MODULE:FUNCTION'{comma}"
            )
    yield from _names_given_twice(call, values)
    if _called(tree) <= _MAKING_NO_FILES and _argument(call, 'cmdclass') is None:
        yield from _missing_files(call, values, folder)


def broken_programs(folder: Path, package: str) -> Iterator[tuple[str, str]]:
    """Name each program that setuptools takes, but that cannot start, and say what to mend."""
    try:
        tree = _parsed(folder / 'setup.py')
    except (OSError, SyntaxError, ValueError):  # ValueError: UTF-16, up to Python 3.11
        return
    call = _call_of_setup(tree)
    for _, text in _scripts(call, _constants(tree)):
        entry = _ENTRY_POINT.fullmatch(text)
        why = _why_broken(folder, package, entry[2], entry[3]) if entry is not None else None
        if entry is not None and why is not None:
            yield entry[1], why
    init = folder / package / '__init__.py'
    if init.parent.is_dir() and not init.exists() and 'find_packages(' in ast.unparse(tree):
        yield (
            package,
            f'{init} is missing, without which its folder is not installed: make an empty one',
        )


def left_out(folder: Path, package: str) -> dict[Path, str]:
    """Map the folders of modules below that of a package which no build copies to what to do.

    Without those of which that is not certain.
    """
    try:
        tree = _parsed(folder / 'setup.py')
    except (OSError, SyntaxError, ValueError):
        return {}
    packages = _argument(_call_of_setup(tree), 'packages')
    finds = isinstance(packages, ast.Call) and _name_of(packages) == 'find_packages'
    values = _constants(tree)
    named = [_text(each, values) for each in getattr(packages, 'elts', [])]
    found: dict[Path, str] = {}
    top = folder / package
    for below in sorted({path.parent for path in top.rglob('*.py')} - {top}):
        chain = [below, *below.parents]
        without = [
            each for each in chain[: chain.index(top)] if not (each / '__init__.py').exists()
        ]
        if finds and without:
            found[below] = f'make an empty {without[-1] / "__init__.py"}'
        elif (
            named and None not in named and '.'.join(below.relative_to(folder).parts) not in named
        ):
            found[below] = (
                f"write packages=find_packages(exclude=['test']) in {folder / 'setup.py'}"
            )
    return found


def _why_broken(folder: Path, package: str, module: str, function: str | None) -> str | None:
    top = module.partition('.')[0]
    if not (folder / top).is_dir():
        if find_spec(top) is not None:  # of another package
            return None
        return f'{module!r}: {folder} has no folder {top}; that of the package is {package}'
    path = folder.joinpath(*module.split('.')).with_suffix('.py')
    if module.endswith('.py'):
        return f'{module!r}: write the name of a module without .py'
    if not path.is_file() and not path.with_suffix('').is_dir():
        if (lost := misplaced(folder, package, path.stem)) is not None:
            return f'{module!r}: there is no {path}: move {lost} there'
        near = nearest.hint(path.stem, (each.stem for each in path.parent.glob('[!_]*.py')))
        return f'{module!r}: there is no {path}{near}'
    if function is None:
        return f'{module!r} names no function: write {module}:main'
    text = path.read_text(encoding='utf-8', errors='replace') if path.is_file() else function
    if '\0' in text:
        return f'{path} is saved as UTF-16 (Windows: Unicode): save it as UTF-8'
    if function.partition('.')[0] not in text:
        return f'{path} has no {function}()'
    return _why_not_imported(path, package) if path.is_file() else None


def _why_not_imported(path: Path, package: str) -> str | None:
    """Say which module beside it a module imports as one may that is run by itself."""
    try:
        tree = _parsed(path)
    except (OSError, SyntaxError, ValueError):
        return None
    for node in tree.body:
        if isinstance(node, ast.Import):
            name, remedy = node.names[0].name, f'from {package} import {node.names[0].name}'
        elif isinstance(node, ast.ImportFrom) and not node.level:
            name = str(node.module)
            remedy = f'from {package}.{name} import {", ".join(each.name for each in node.names)}'
        else:
            continue
        beside = path.parent / f'{name}.py'
        if path.parent.name == package and beside.is_file() and find_spec(name) is None:
            return f'{path}:{node.lineno}: {name} is a module of this package: write `{remedy}`'
    return None


def misplaced(folder: Path, package: str, module: str) -> Path | None:
    """Return a module that lies outside the folder of the programs, as in the src of ROS 1."""
    if not module.isidentifier() or module == 'setup':
        return None
    places = (folder, folder / 'src', folder / 'scripts', folder.parent)
    found = (place / f'{module}.py' for place in places if place != folder / package)
    return next((path for path in found if path.is_file()), None)


def module_of(folder: Path, program: str) -> Path | None:
    """Return the file with the function of a program; None where that is not certain."""
    try:
        tree = _parsed(folder / 'setup.py')
    except (OSError, SyntaxError, ValueError):
        return None
    for _, text in _scripts(_call_of_setup(tree), _constants(tree)):
        entry = _ENTRY_POINT.fullmatch(text)
        if entry is not None and entry[1] == program:
            path = folder.joinpath(*entry[2].split('.')).with_suffix('.py')
            return path if path.is_file() else None
    return None


def declared_programs(folder: Path) -> set[str] | None:
    """Return the names of all entry points of a setup.py; None where they are not certain."""
    try:
        tree = _parsed(folder / 'setup.py')
    except (OSError, SyntaxError, ValueError):
        return None
    groups = _argument(_call_of_setup(tree), 'entry_points')
    if not isinstance(groups, ast.Dict):
        return None
    values = _constants(tree)
    lines = [line for group in groups.values for line in getattr(group, 'elts', [group])]
    entries = [_ENTRY_POINT.fullmatch(_text(line, values) or '') for line in lines]
    names = {entry[1] for entry in entries if entry is not None}
    return None if None in entries else names


def has_console_scripts(folder: Path) -> bool:
    """Tell whether a setup.py that can be read declares programs."""
    groups = _argument(_call_of_setup(_parsed(folder / 'setup.py')), 'entry_points')
    names = groups.keys if isinstance(groups, ast.Dict) else []
    return not names or any(getattr(name, 'value', '') == 'console_scripts' for name in names)


def package_called(folder: Path) -> str | None:
    """Return the name that a setup.py gives its package; None where that is not certain."""
    tree = _parsed(folder / 'setup.py')
    node = _argument(_call_of_setup(tree), 'name')
    return None if node is None else _text(node, _constants(tree))


def _parsed(path: Path) -> ast.Module:
    with warnings.catch_warnings():
        warnings.simplefilter('ignore')
        return ast.parse(path.read_bytes(), str(path))


def _call_of_setup(tree: ast.AST) -> ast.Call | None:
    calls = (node for node in ast.walk(tree) if isinstance(node, ast.Call))
    return next((call for call in calls if _name_of(call) == 'setup'), None)


def _called(tree: ast.AST) -> set[str]:
    """Return the names of what is called."""
    return {_name_of(node) for node in ast.walk(tree) if isinstance(node, ast.Call)}


def _name_of(call: ast.Call) -> str:
    return str(getattr(call.func, 'id', getattr(call.func, 'attr', '')))


def _missing_modules(tree: ast.Module, folder: Path) -> Iterator[str]:
    """Name what is imported in no block and is not here, as what an editor adds by itself."""
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    for node in tree.body:
        if isinstance(node, ast.Import):
            modules = [each.name for each in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module is not None and not node.level:
            modules = [node.module]
        else:
            continue
        names = [(each.asname or each.name).partition('.')[0] for each in node.names]
        for top in dict.fromkeys(module.partition('.')[0] for module in modules):
            if top in sys.modules or find_spec(top) is not None:
                continue
            if PathFinder.find_spec(top, [str(folder)]) is not None:  # setup.py is run there
                continue
            near = nearest.names(top, {*sys.stdlib_module_names, 'setuptools'})
            if not used & {*names} and names != ['*']:
                remedy = 'nothing below uses it: delete the line'
            elif near:
                remedy = f'did you mean {near[0]!r}?'
            else:
                remedy = 'install it first'
            yield f'setup.py:{node.lineno}: no module {top!r} is installed: {remedy}'


def _unbound_names(tree: ast.Module) -> Iterator[str]:
    """Name what is used where each run comes, in no function and no block, and bound nowhere."""
    bound = {*dir(builtins), '__file__'}
    used = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            used.add(node.id)
            if not isinstance(node.ctx, ast.Load):
                bound.add(node.id)
        elif isinstance(node, ast.alias):
            bound.add((node.asname or node.name).partition('.')[0])
        else:
            names = (getattr(node, each, None) for each in ('name', 'arg', 'rest'))
            bound.update(name for name in names if isinstance(name, str))
    if '*' in bound or _BINDING & used:
        return
    always = [node for node in tree.body if isinstance(node, (ast.Assign, ast.Expr))]
    for node in (each for statement in always for each in ast.walk(statement)):
        if isinstance(node, ast.Name) and node.id not in bound:
            wanted = 'from glob import glob' if node.id == 'glob' else f'import {node.id}'
            yield (
                f'setup.py:{node.lineno}: {node.id} is not defined: is `{wanted}` missing above?'
            )
            bound.add(node.id)


def _scripts(call: ast.Call | None, values: dict[str, str]) -> Iterator[tuple[ast.expr, str]]:
    groups = _argument(call, 'entry_points')
    if isinstance(groups, ast.Dict):
        for lines in groups.values:
            for line in getattr(lines, 'elts', []):
                text = _text(line, values)
                if text is not None:
                    yield line, text


def _names_given_twice(call: ast.Call, values: dict[str, str]) -> Iterator[str]:
    groups = _argument(call, 'entry_points')
    for lines in groups.values if isinstance(groups, ast.Dict) else []:
        names: set[str] = set()
        for line in getattr(lines, 'elts', []):
            entry = _ENTRY_POINT.fullmatch(_text(line, values) or '')
            if entry is None:
                continue
            if entry[1] in names:
                yield (
                    f'setup.py:{line.lineno}: {entry[1]!r} is the name of an entry point above, '
                    'too; give each another name, or take one away'
                )
            names.add(entry[1])


def _missing_files(call: ast.Call, values: dict[str, str], folder: Path) -> Iterator[str]:
    for entry in getattr(_argument(call, 'data_files'), 'elts', []):
        if not isinstance(entry, ast.Tuple) or len(entry.elts) != 2:
            continue
        single = _text(entry.elts[1], values)
        if single is not None:
            yield f'setup.py:{entry.lineno}: {single!r} in data_files: write a list, [{single!r}]'
        for node in getattr(entry.elts[1], 'elts', []):
            path = _text(node, values)
            if path is None:
                continue
            why = ''
            if Path(path).is_absolute():
                why = 'begins with /: write it from the folder of setup.py on'
            elif (folder / path).is_dir():
                why = f"is a folder: name the files in it, glob('{path}/*')"
            elif not (folder / path).exists():
                why = 'is not there'
            if why:
                yield f'setup.py:{node.lineno}: {path!r} in data_files {why}'


def _argument(call: ast.Call | None, name: str) -> ast.expr | None:
    keywords = call.keywords if call is not None else []
    return next((each.value for each in keywords if each.arg == name), None)


def _constants(tree: ast.Module) -> dict[str, str]:
    """Return the text that stands in names, as `package_name`."""
    values: dict[str, str] = {}
    for node in tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            text = _text(node.value, values)
            if text is not None:
                values[node.targets[0].id] = text
    return values


def _text(node: ast.expr, values: dict[str, str]) -> str | None:
    """Return the text of an expression, None where it depends on what runs."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else None
    if isinstance(node, ast.Name):
        return values.get(node.id)
    parts: list[ast.expr] = []
    between = ''
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        parts = [node.left, node.right]
    elif isinstance(node, ast.JoinedStr):
        parts = [
            each.value if isinstance(each, ast.FormattedValue) else each for each in node.values
        ]
    elif isinstance(node, ast.Call) and ast.unparse(node.func) in ('os.path.join', 'join'):
        parts, between = node.args, '/'
    texts = [_text(part, values) for part in parts]
    return None if not texts or None in texts else between.join(each or '' for each in texts)
