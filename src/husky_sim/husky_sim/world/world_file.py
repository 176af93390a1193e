# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Check the settings of a world's file; a refusal names file, reason, and line if any."""

import math
from pathlib import Path
import re

import mujoco
import numpy as np

from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.errors import WorldError

LONGEST_TIMESTEP_SEC = 0.004
SHORTEST_TIMESTEP_SEC = 1e-5  # with which a second takes some minutes

_NUMBERS = ('pos', 'quat', 'size', 'friction', 'mass', 'inertia', 'ipos', 'axis', 'range')

_HAS_LINE = re.compile(r'\bline\b', re.IGNORECASE)
_QUOTED = re.compile(r"'([^']+)'")
_NO_LINE = re.compile(r',? line 0\b')  # what MuJoCo says of all that stands in an included file
# What it says besides, of its own doing, where the model has no part that is only seen.
_ASIDE = re.compile(r' The visual elements of the spec were discarded .*?remain so\.')
_COMMENT = re.compile(r'<!--.*?-->', re.DOTALL)
_MODEL = re.compile(r'<model\s[^>]*?file\s*=\s*["\']([^"\']+)["\']')
_INCLUDE = re.compile(r'<include\s[^>]*?file\s*=\s*["\']([^"\']+)["\']')


def refused(path: str, reason: str | Exception, *, word: str = '') -> WorldError:
    """
    Make the error that says why a world cannot be used, in one line.

    :param word: an attribute or a name to find the line of, if the reason names none. By
        default what the reason quotes.
    """
    text = ' '.join(str(reason).split())
    text = _ASIDE.sub('', text)
    included, text = _NO_LINE.search(text) is not None, _NO_LINE.sub('', text)
    if not _HAS_LINE.search(text):
        quoted = _QUOTED.search(text)
        word = word or (quoted.group(1) if quoted else '')
        text += line_of(path, word, only_included=included)
    return WorldError(f'world={path!r}: {text}')


def line_of(path: str, word: str, *, only_included: bool = False) -> str:
    """
    Return ', line N' for the first line of a file with a word in quotes, or bare; or ''.

    :param only_included: look only into the files that it includes; otherwise these come second.
    """
    texts = _texts(path)
    if only_included:
        del texts[0]
    for wanted in (f'"{word}"', word):
        for name, text in texts:
            for number, line in enumerate(text.splitlines(), start=1):
                if word and wanted in line:
                    return f', line {number}' + (f' of {name}' if name else '')
    return ''


def _texts(path: str) -> list[tuple[str, str]]:
    """Return the text of a file, and by their names those of the files that it includes."""
    folder, names, texts = Path(path).parent, [''], list[tuple[str, str]]()
    for name in names:  # grows on the way
        try:
            text = (folder / name if name else Path(path)).read_text('utf-8', errors='replace')
        except OSError:
            text = ''
        texts.append((name, text))
        names += [each for each in _INCLUDE.findall(text) if each not in names]
    return texts


def check_models(path: str) -> None:
    """
    Check that no model that is attached is made of itself: MuJoCo 4.0 ends the process on that.

    :raises WorldError: if one is.
    """
    seen: set[Path] = set()

    def follow(file: Path, above: tuple[Path, ...]) -> None:
        seen.add(file)
        for name in _models_of(file):
            model = (file.parent / name).resolve()
            if model in above:
                raise refused(
                    path,
                    f'the model {name!r} is made of itself; name a file that does not lead back '
                    'to it',
                    word=name,
                )
            if model not in seen:
                follow(model, (*above, model))

    world = Path(path).resolve()
    follow(world, (world,))


def _models_of(file: Path) -> list[str]:
    """Return the files of the models that a file names, itself or in what it includes."""
    texts = [_COMMENT.sub('', text) for _, text in _texts(str(file))]
    return [name for text in texts for name in _MODEL.findall(text)]


def steps_per_period(path: str, timestep_sec: float) -> int:
    """
    Return how many physics steps make a control period.

    :raises WorldError: if they are not a whole number, too long for the wheels, or so short that
        nothing would seem to move.
    """
    steps = CONTROL_PERIOD_SEC / timestep_sec if timestep_sec > 0.0 else 0.0
    # Also false for nan, which MuJoCo accepts.
    if not (steps >= 1.0 and math.isclose(steps, round(steps))):
        raise refused(
            path,
            f'timestep={timestep_sec:g}: the control period of {CONTROL_PERIOD_SEC:g} s must be a '
            'whole number of timesteps; use 0.004',
            word='timestep',
        )
    if timestep_sec > LONGEST_TIMESTEP_SEC:
        raise refused(
            path,
            f'timestep={timestep_sec:g}: the servos of the wheels need {LONGEST_TIMESTEP_SEC:g} s '
            'or less',
            word='timestep',
        )
    if timestep_sec < SHORTEST_TIMESTEP_SEC:
        raise refused(
            path,
            f'timestep={timestep_sec:g}: nothing would get on; use {SHORTEST_TIMESTEP_SEC:g} s or '
            'more',
            word='timestep',
        )
    return round(steps)


def check_names(path: str, model: mujoco.MjModel) -> None:
    """
    Check that names can be read.

    :raises WorldError: if one is not UTF-8, as in a file that was saved in another encoding.
    """
    try:
        model.names.decode('utf-8')
    except UnicodeDecodeError as error:
        begin = model.names.rfind(b'\0', 0, error.start) + 1
        name = model.names[begin : model.names.find(b'\0', begin)].decode(errors='replace')
        raise refused(
            path, f'the name {name!r} is not UTF-8; save the file in this encoding', word=name
        ) from None


def check_numbers(path: str, model: mujoco.MjModel) -> None:
    """
    Check the places, sizes and materials of all bodies and their geoms and joints.

    :raises WorldError: if one is not a number, as nan, which MuJoCo accepts, or larger than what
        it calculates with (mjMAXVAL).
    """
    for kind, bodies in (
        ('body', range(model.nbody)),
        ('geom', model.geom_bodyid),
        ('jnt', model.jnt_bodyid),
    ):
        for field in _NUMBERS:
            values = getattr(model, f'{kind}_{field}', np.empty((len(bodies), 0)))
            rows = values.reshape(len(bodies), math.prod(values.shape[1:]))
            wrong = ~(abs(rows) <= mujoco.mjMAXVAL).all(axis=1)  # also of nan
            for index in np.flatnonzero(wrong)[:1]:
                name = model.body(bodies[index]).name
                given = ' '.join(f'{each:g}' for each in rows[index])
                raise refused(
                    path,
                    f'body {name!r}: its {field} is {given}; use numbers up to 1e10',
                    word=name if bodies[index] else 'nan',  # the world itself is not named
                )


def check_settings(path: str, spec: mujoco.MjSpec) -> None:
    """
    Check that a robot can stand and drive in the world.

    :raises WorldError: if the world switches off what it needs, or changes its weight.
    """
    # Without filterparent the wheels would rub against the body that bears them.
    for flag in ('contact', 'constraint', 'actuation', 'filterparent', 'gravity'):
        if spec.option.disableflags & getattr(mujoco.mjtDisableBit, f'mjDSBL_{flag.upper()}'):
            raise refused(
                path, f'{flag}="disable": the robot needs it to drive; remove the flag', word=flag
            )
    gravity = spec.option.gravity.tolist()
    if not (all(map(math.isfinite, gravity)) and gravity[2] < 0.0):
        given = ' '.join(f'{each:g}' for each in gravity)
        raise refused(
            path,
            f'gravity="{given}": the robot needs its weight to drive; use finite numbers, the '
            'last below 0',
            word='gravity',
        )
    if spec.option.iterations < 1:
        raise refused(
            path,
            f'iterations="{spec.option.iterations}": without any the wheels have no force; '
            'use 1 or more, or leave it out',
            word='iterations',
        )
    if spec.option.disableactuator & 1:
        name = 'actuatorgroupdisable'
        raise refused(
            path, f'{name}: the motors of the robot are in group 0; use others', word=name
        )
    if spec.compiler.settotalmass > 0.0:
        name = 'settotalmass'
        raise refused(
            path,
            f'{name}: the robot would weigh something else; give each body its mass',
            word=name,
        )
