# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read a rubric into checked, frozen steps; every mistake is named at once."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path

from husky_course.checked_yaml import (
    choice,
    Field,
    FieldReader,
    FileRefused,
    parse_yaml,
    read_yaml,
    Value,
)
from husky_course.waypoints import load_course

from husky_grader.playpen import obstacles_of
from husky_grader.rubric.mistakes import mistakes_of
from husky_grader.rubric.own_types import find_types
from husky_grader.rubric.steps import (
    BuildStep,
    DriveStep,
    PackageStep,
    PathStep,
    ProgramStep,
    Rubric,
    Step,
)
from husky_grader.rubric.tables import RUBRIC, STEPS


def load_rubric(path: str | Path) -> Rubric:
    """
    Return the rubric in a file.

    :raises FileRefused: with every mistake, each with its line, column and field.
    """
    path = Path(path)
    return _RubricReader(path).rubric(read_yaml(path))


def parse_rubric(text: str, name: str = 'rubric.yaml') -> Rubric:
    """Return the rubric in the text of a file; see `load_rubric`."""
    return _RubricReader(Path(name)).rubric(parse_yaml(text, name))


class _RubricReader(FieldReader):
    def __init__(self, path: Path) -> None:
        super().__init__(str(path))
        self._path = path

    def rubric(self, root: Value) -> Rubric:
        interfaces = self._interfaces(root)  # the steps name their types
        rubric: Rubric | None = self.mapping(RUBRIC, root, '')
        if rubric is not None:
            steps = next(value for key, value in root.pairs if key.text == 'steps')
            self._check_together(rubric.steps, steps.items)
            if rubric.points <= 0.0:
                self.wrong(steps, 'steps', 'no step gives points; give one of them more than 0')
        if rubric is None or self.problems:
            raise FileRefused(self.file, self.problems)
        return replace(rubric, file=self._path, interfaces=interfaces)

    def _interfaces(self, root: Value) -> tuple[Path, ...]:
        """Make the types of a list of packages known; return their folders."""
        given = next(
            (value for key, value in root.pairs if key.text == 'interfaces'), Value(1, 1, '')
        )
        folders = tuple(
            (self._path.parent / item.text).absolute() for item in given.items if item.text
        )
        try:
            find_types(folders)
        except ValueError as error:
            self.wrong(given, 'interfaces', str(error))
        return folders

    def item(self, field: Field, value: Value, name: str) -> object:
        return (
            self._step(value, name)
            if field.attribute == 'steps'
            else super().item(field, value, name)
        )

    def value(self, field: Field, value: Value, name: str) -> object:
        found = super().value(field, value, name)
        if field.attribute in ('file', 'after_drive') and isinstance(found, str):
            return self._course_file(found, value, name)
        if field.attribute == 'world' and isinstance(found, str):
            return self._world_file(found, value, name)
        return found

    def _step(self, value: Value, name: str) -> Step | None:
        kinds = [each for key, each in value.pairs if key.text == 'kind']
        if not kinds:
            self.wrong(value, name, f'{value} without a kind; allowed: {", ".join(STEPS)}')
            return None
        if kinds[0].text not in STEPS:
            self.wrong(
                kinds[0], f'{name}.kind', f'{kinds[0]} is not allowed; {choice(kinds[0], STEPS)}'
            )
            return None
        table, before = STEPS[kinds[0].text], len(self.problems)
        given = self.fields(value, f'{name}.', table.fields)
        self.require(value, name, table)
        if len(self.problems) > before:
            return None
        del given['kind']
        step: Step = table.made(**given)
        for key, message in mistakes_of(step):
            self.wrong(_at(value, key), f'{name}.{key}', message)
        return step if step.name else replace(step, name=_own_name(step))

    def _course_file(self, given: str, value: Value, name: str) -> Path:
        """Return a waypoint file; a mistake in it is one of the rubric, too."""
        path = self._beside(given)
        try:
            load_course(path)
        except ValueError as error:
            self.wrong(value, name, _slashes(given, path) or str(error).splitlines()[0])
        return path

    def _world_file(self, given: str, value: Value, name: str) -> str:
        """Return the path of a world; a mistake in it is one of the rubric, too."""
        path = self._beside(given)
        try:
            obstacles_of(str(path))
        except ValueError as error:
            told = str(error).removeprefix('world=')
            self.wrong(value, name, _slashes(given, path) or told)
        return str(path)

    def _beside(self, given: str) -> Path:
        return (self._path.parent / given).absolute()  # programs elsewhere read it, too

    def _check_together(self, steps: Sequence[Step], places: Sequence[Value]) -> None:
        """Check what the steps say of each other."""
        built, of_files = False, all(isinstance(step, PathStep) for step in steps)
        counts = Counter(name for step in steps for name in _files_of(step))
        for number, (step, place) in enumerate(zip(steps, places, strict=True)):
            name = f'steps[{number}]'
            if isinstance(step, PathStep) and not of_files:
                why = 'it is for a waypoint file; a rubric has only such steps, or none'
                self.wrong(place, name, why)
            if any(counts[each] > 1 for each in _files_of(step)):
                why = f'{step.name} is the name of another step, too, or of its files; '
                why += 'give each its own'
                self.wrong(_at(place, 'name'), f'{name}.name', why)
            if isinstance(step, ProgramStep) and not built:
                self.wrong(place, name, 'it runs a program; put a step of kind build before it')
            built = built or isinstance(step, BuildStep)
            for key, message in _wrong_needs(step, steps):
                self.wrong(_at(place, key), f'{name}.{key}', message)


def _slashes(given: str, path: Path) -> str:
    """Return what to write where folders are written as on Windows."""
    if '\\' not in given or path.exists():
        return ''
    return f'{given}: no such file; write / between folders'


def _at(mapping: Value, field: str) -> Value:
    """Return where a field stands; the mapping itself where it is not given."""
    return next((value for key, value in mapping.pairs if key.text == field), mapping)


def _own_name(step: Step) -> str:
    if isinstance(step, PackageStep):
        return f'package {step.package or f"with {step.package_with}"}'
    return step.kind


def _files_of(step: Step) -> set[str]:
    """Return how the names of a step's files and folders begin; each drive of several has one."""
    courses = step.courses if isinstance(step, DriveStep) else ()
    numbers = range(1, len(courses) + 1) if len(courses) > 1 else ()
    return {step.file_name, *(f'{step.file_name}_{number}' for number in numbers)}


def _wrong_needs(step: Step, steps: Sequence[Step]) -> Iterator[tuple[str, str]]:
    names = [other.name for other in steps]
    for key, needed in (('needs', step.needs), ('needs_one_of', step.needs_one_of)):
        for name in needed:
            if name not in names:
                near = get_close_matches(name, names, n=1)
                hint = f'did you mean {near[0]}? ' if near else ''
                yield key, f'{name} is no step; {hint}allowed: {", ".join(names)}'
            elif step.name in _all_needed(name, steps):
                yield key, f'{name} needs {step.name} itself: neither could ever count'


def _all_needed(name: str, steps: Sequence[Step]) -> set[str]:
    """Return a step and those that it needs, directly or not."""
    needs = {step.name: (*step.needs, *step.needs_one_of) for step in steps}
    found: set[str] = set()
    left = [name]
    while left:
        if (each := left.pop()) not in found:
            found.add(each)
            left += needs.get(each, ())
    return found
