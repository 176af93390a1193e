# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The steps that a rubric may have: what is asked for, its points, and what each defect costs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
import re
from typing import Any, ClassVar

from husky_grader.rubric.forms import Form
from husky_grader.rubric.own_types import files_of
from husky_grader.rubric.world_files import files_of_world

COURSE = '{course}'
"""Stands for the waypoint file of the course that is driven."""


@dataclass(frozen=True, kw_only=True)
class Step:
    """What every step has; it counts only when the steps that it needs got points."""

    kind: ClassVar[str]
    points: float
    name: str = ''
    needs: tuple[str, ...] = ()
    needs_one_of: tuple[str, ...] = ()
    costs: object = None  # percent, an attribute for each defect

    @property
    def file_name(self) -> str:
        """The beginning of the names of its files."""
        return file_name_of(self.name)

    def cost_percent(self, defect: str) -> float:
        """Return what a defect costs."""
        return float(getattr(self.costs, defect))


def file_name_of(step: str) -> str:
    """Return the beginning of the names of the files of a step."""
    return re.sub(r'[^\w-]+', '_', step)


@dataclass(frozen=True, kw_only=True)
class WorkspaceCosts:
    name: float = 50.0


@dataclass(frozen=True, kw_only=True)
class WorkspaceStep(Step):
    """A folder of a given form of name, with packages in src."""

    kind = 'workspace'
    forms: tuple[Form, ...] = ()
    costs: WorkspaceCosts = WorkspaceCosts()


@dataclass(frozen=True, kw_only=True)
class PackageCosts:
    dependencies: float = 50.0
    build_type: float = 50.0
    todo: float = 20.0


@dataclass(frozen=True, kw_only=True)
class PackageStep(Step):
    """A package and its manifest."""

    kind = 'package'
    package: str = ''
    package_with: str = ''
    build_type: str = 'ament_python'
    dependencies: tuple[str, ...] = ()
    costs: PackageCosts = PackageCosts()


@dataclass(frozen=True, kw_only=True)
class BuildStep(Step):
    """Building the workspace; every step that runs a program comes after it."""

    kind = 'build'


@dataclass(frozen=True, kw_only=True)
class ProgramStep(Step):
    """What every step has that runs one of the student's programs."""

    executable: str = ''
    launch: str = ''  # a launch file, in the place of an executable
    package: str = ''
    package_with: str = ''
    arguments: tuple[str, ...] = ()
    parameters: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class FieldCheck:
    """What a field of a message must hold; of a list, each of its entries."""

    field: str
    form: Form | None = None
    equals: bool | float | str | None = None
    least: float | None = None
    most: float | None = None


@dataclass(frozen=True, kw_only=True)
class ServiceCall:
    """A call of a service that must be answered."""

    service: str
    type: str
    request: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class PublisherCosts:
    rate: float = 30.0
    content: float = 50.0


@dataclass(frozen=True, kw_only=True)
class PublisherStep(ProgramStep):
    """A program that publishes: topic, type, rate and content."""

    kind = 'publisher'
    topic: str
    type: str
    rate_hz: float | None = None
    rate_tolerance_percent: float = 15.0
    content: tuple[FieldCheck, ...] = ()
    after_drive: Path | None = None
    call: ServiceCall | None = None
    within_sec: float = 15.0
    listen_sec: float = 3.0
    costs: PublisherCosts = PublisherCosts()


@dataclass(frozen=True, kw_only=True)
class SubscriberCosts:
    printed: float = 30.0


@dataclass(frozen=True, kw_only=True)
class SubscriberStep(ProgramStep):
    """A program that listens, and prints what it hears."""

    kind = 'subscriber'
    topic: str
    type: str
    sent: Mapping[str, Any]
    printed: str
    within_sec: float = 15.0
    costs: SubscriberCosts = SubscriberCosts()


@dataclass(frozen=True, kw_only=True)
class ServiceCosts:
    response: float = 50.0


@dataclass(frozen=True, kw_only=True)
class ServiceStep(ProgramStep):
    """A program that answers a service."""

    kind = 'service'
    service: str
    type: str
    request: Mapping[str, Any] = field(default_factory=dict)
    response: tuple[FieldCheck, ...] = ()
    within_sec: float = 15.0
    costs: ServiceCosts = ServiceCosts()


@dataclass(frozen=True, kw_only=True)
class CourseToDrive:
    """A course and its share of the step; of a hidden one, students learn its title only."""

    file: Path
    title: str = ''
    share: float = 1.0
    hidden: bool = False


@dataclass(frozen=True, kw_only=True)
class DriveLimits:
    """What a drive may not exceed; None: as much as it likes."""

    collisions: float | None = None
    off_path_m: float | None = None  # root of the mean square
    time_sec: float | None = None  # simulated


@dataclass(frozen=True, kw_only=True)
class DriveCosts:
    collisions: float = 50.0
    off_path_m: float = 50.0
    time_sec: float = 50.0


@dataclass(frozen=True, kw_only=True)
class DriveStep(ProgramStep):
    """A program that drives courses; it gets the score of each drive."""

    kind = 'drive'
    courses: tuple[CourseToDrive, ...]
    answers: tuple[str, ...] = ()
    limits: DriveLimits = DriveLimits()
    costs: DriveCosts = DriveCosts()


@dataclass(frozen=True, kw_only=True)
class PathCosts(DriveCosts):
    passes: float = 100.0


@dataclass(frozen=True, kw_only=True)
class Place:
    """A point of the frame odom, in metres."""

    x: float
    y: float


@dataclass(frozen=True, kw_only=True)
class PathStep(Step):
    """A waypoint file that was handed in; the lab's driver follows it, and its score counts."""

    kind = 'path'
    passes: tuple[Place, ...] = ()  # in this order
    within_m: float = 0.5
    limits: DriveLimits = DriveLimits()
    costs: PathCosts = PathCosts()


@dataclass(frozen=True, kw_only=True)
class Rubric:
    """What a lab asks for, step by step."""

    title: str
    steps: tuple[Step, ...]
    interfaces: tuple[Path, ...] = ()  # packages of the types that are not installed
    world: str = ''  # MJCF file; empty: the playpen
    file: Path = field(default=Path(), compare=False)

    @property
    def is_of_files(self) -> bool:
        """Whether it is for waypoint files, and not for workspaces."""
        return all(isinstance(step, PathStep) for step in self.steps)

    @property
    def packages(self) -> tuple[str, ...]:
        """The packages that students are asked for by their names, also those of types."""
        asking = (step for step in self.steps if isinstance(step, (PackageStep, ProgramStep)))
        named = (step.package for step in asking if step.package)
        return tuple(dict.fromkeys((*named, *(folder.name for folder in self.interfaces))))

    @property
    def courses(self) -> tuple[Path, ...]:
        """The waypoint files that are driven, each once."""
        driven: list[Path] = []
        for step in self.steps:
            if isinstance(step, DriveStep):
                driven += [course.file for course in step.courses]
            elif isinstance(step, PublisherStep) and step.after_drive is not None:
                driven.append(step.after_drive)
        return tuple(dict.fromkeys(driven))

    @property
    def files(self) -> tuple[Path, ...]:
        """All that the rubric is read from, itself first."""
        interfaces = (path for package in self.interfaces for path in files_of(package))
        world = files_of_world(Path(self.world)) if self.world else ()
        return (self.file, *self.courses, *world, *interfaces)

    @property
    def points(self) -> float:
        """The most that can be got."""
        return sum(step.points for step in self.steps)
