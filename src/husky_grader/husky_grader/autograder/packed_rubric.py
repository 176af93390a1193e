# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A rubric with the files that it names, so that it can be read elsewhere."""

from collections.abc import Mapping
from dataclasses import dataclass
import os
from pathlib import Path
import shutil
from tempfile import TemporaryDirectory

from husky_grader.rubric.rubric_file import load_rubric
from husky_grader.rubric.steps import Rubric


@dataclass(frozen=True)
class PackedRubric:
    """Files by their paths in a folder, with the rubric among them."""

    files: Mapping[str, Path]
    rubric: str  # the path of the rubric in the folder


def packed_rubric(rubric: Rubric) -> PackedRubric:
    """
    Return what a rubric was read from.

    :raises ValueError: when it names a file in a way that only holds where it lies now.
    """
    every = [path.resolve() for path in rubric.files]
    top = Path(os.path.commonpath([path.parent for path in every]))
    files = {path.relative_to(top).as_posix(): path for path in every}
    packed = PackedRubric(files, rubric.file.resolve().relative_to(top).as_posix())
    _check(packed, rubric)
    return packed


def _check(packed: PackedRubric, rubric: Rubric) -> None:
    """Read it in another folder."""
    with TemporaryDirectory() as name:
        folder = Path(name).resolve()
        for path, source in packed.files.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, folder / path)
        read = load_rubric(folder / packed.rubric)
        for given, found in zip(rubric.files, read.files, strict=True):
            if not found.resolve().is_relative_to(folder):
                raise ValueError(
                    f'{rubric.file}: names the file {given} by its place on this computer; name '
                    'it from the folder of the rubric, as in ../courses/one.yaml'
                )
