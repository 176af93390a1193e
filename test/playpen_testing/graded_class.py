# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A class that was graded, as its outputs are made from it; some of it is hostile."""

from pathlib import Path
import random

from husky_grader.graded import Graded, StepGrade
from husky_grader.submission import Submission

MOST = {'package topic_demo': 10.0, 'build': 20.0, 'publisher': 30.0, 'drive': 40.0}
NAMES = ('Ann de Groot', 'Çem Öz', 'Dan Li', 'Faye Mensah', 'Iñaki Sáez', 'Jürgen Weiß')
MISTAKES = {
    'package topic_demo': 'package.xml lacks: <exec_depend>std_msgs</exec_depend>',
    'build': "colcon build failed: talker.py line {n}: NameError: name 'x{n}' is not defined",
    'publisher': (
        'it hears nothing of /odometry/filtered: it asks for TRANSIENT_LOCAL, but that is '
        'published VOLATILE; leave the durability of its QoS profile out'
    ),
    'drive': 'touched cone_{n} at {n}.5 s; 0.{n} m RMS off the path, 0.05 m are allowed',
}
HOSTILE = '=HYPERLINK("http://evil")<script>alert(1)</script>\n\u202egro.li\x1b[2J;=1+1'


def submission(
    number: int, name: str = '', *, lms: str = '', late: bool = False, refused: str = ''
) -> Submission:
    """Return one as an export gives it; of Canvas with the file that was handed in."""
    name = name or NAMES[number % len(NAMES)]
    top = f'student_{5000 + number}_{9000 + number}_ws.zip'
    return Submission(
        f'student {number}',
        Path(f'/exports/{lms or "folder"}.zip'),
        'zip',
        lms=lms,
        user=str(5000 + number),
        name=name,
        emails=(f'student{number}@example.org',),
        late=late,
        attempt=9000 + number,
        files=((top, 'ws.zip'),) if lms == 'canvas' else (),
        refused=refused,
    )


def full(one: Submission) -> Graded:
    steps = [StepGrade(name, most, most, f'{name} is right') for name, most in MOST.items()]
    return Graded(one, sum(MOST.values()), steps, sandbox='bwrap')


def partial(one: Submission, **points: float) -> Graded:
    """Return it with so many points in some steps, for the mistakes of these steps."""
    number = int(one.user)
    steps = [
        StepGrade(
            name,
            most,
            points.get(name, most),
            MISTAKES[name].format(n=number) if name in points else f'{name} is right',
            printed=f'line {number}\nTraceback\n' if name in points else '',
        )
        for name, most in MOST.items()
    ]
    return Graded(one, sum(MOST.values()), steps, sandbox='bwrap')


def refused(one: Submission) -> Graded:
    why = f'{one.place}: a RAR archive; hand in a zip'
    return Graded(one, sum(MOST.values()), refused=why, sandbox='bwrap', notes=one.notes)


def hostile(one: Submission) -> Graded:
    """Return what somebody got who has put into every text what may do harm."""
    steps = [
        StepGrade(name, most, 0.0, HOSTILE, printed='\x00\x1b\u202e' * 20_000)
        for name, most in MOST.items()
    ]
    return Graded(one, sum(MOST.values()), steps, sandbox='bwrap', notes=(HOSTILE,))


def a_class(size: int, *, lms: str = '') -> list[Graded]:
    """Return a class of many, of whom some made mistakes, were late, refused or are hostile."""
    chance = random.Random(7)
    found = []
    for number in range(size):
        one = submission(number, lms=lms, late=number % 9 == 4)
        kind = number % 20
        if kind == 11:
            found.append(refused(one))
        elif kind == 17:
            found.append(hostile(submission(number, HOSTILE, lms=lms)))
        elif chance.random() < 0.3:
            found.append(full(one))
        else:
            wrong = chance.sample(sorted(MOST), chance.choice([1, 1, 2]))
            got = {name: MOST[name] * chance.choice([0.0, 0.5, 0.9]) for name in wrong}
            found.append(partial(one, **got))
    return found
