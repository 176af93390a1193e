# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The pages of a class and of its students: what they say, link to, and do not tell."""

from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
import re
from urllib.parse import unquote

from husky_course.printable import printable
from husky_grader.batch.job import Outcome
from husky_grader.graded import Graded, StepGrade
from husky_grader.lab.drive_step import FOR_STAFF, passed
from husky_grader.lab_job import LabJob
from husky_grader.outputs import write_outputs, write_student_page
from husky_grader.outputs.canvas import _as_text
from husky_grader.outputs.class_page import class_page
from husky_grader.outputs.class_summary import summarize, without_names
from husky_grader.outputs.histogram import histogram
from husky_grader.outputs.moodle import comment
from husky_grader.rubric.steps import Rubric
from husky_grader.submission import find_submissions, Refused, Submission, unpack
from husky_grader.submission.limits import BUILT, COPY
from playpen_testing.graded_class import a_class, full, HOSTILE, MOST, partial, refused, submission
import pytest


class Page(HTMLParser):
    """The tags, the links and the text of a page."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.links: list[str] = []
        self.text = ''
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.links += [unquote(value or '') for name, value in attrs if name in ('href', 'src')]

    def handle_data(self, data: str) -> None:
        self.text += data


def told(number: int, **reasons: str) -> Graded:
    """Return what somebody got who has lost ten points for each reason, by its step."""
    steps = [StepGrade(name, 20.0, 10.0, why) for name, why in reasons.items()]
    return Graded(submission(number), 20.0 * len(steps), steps)


@pytest.mark.parametrize(
    ('one', 'other'),
    [
        ('talker.py line 12: nothing', 'my_node.py line 3: nothing'),
        ("no such file: 'a b.txt'", 'no such file: "c"'),
        ('hears nothing of /odom', 'hears nothing of /odometry/filtered'),
        ('0.35 m RMS off the path', '1.2 m RMS off the path'),
        ('package CSE461_07_03 was not built', 'package my_ws was not built'),
    ],
)
def test_reasons_are_the_same_whatever_names_are_in_them(one: str, other: str) -> None:
    assert without_names(one) == without_names(other)


def test_different_reasons_stay_apart() -> None:
    assert without_names('it listens to /odom') != without_names('it publishes /odom')
    assert without_names('lacks: <a>rclpy</a>') != without_names('lacks: <a>std</a>')


def test_a_mistake_has_all_who_made_it_and_its_cost() -> None:
    summary = summarize(
        [
            told(1, build='a.py line 1: no; see the log', drive='touched cone_1'),
            told(2, build='b.py line 2: no; see the log'),
            told(3, build='see the log'),
            told(4, build='c.py line 9: no'),
            told(5, drive='touched cone_7; touched cone_8'),
            # With what a program was run is no mistake, and has no part in the cost of one.
            told(6, rate='it publishes on /a; it was run with -p rate_hz:=20.0'),
            told(7, rate='it publishes on /b; it was run with -p rate_hz:=20.0'),
            told(8, rate='it hears nothing; it was run with -p rate_hz:=20.0'),
        ]
    )
    found = [(m.step, m.text, [one.submission.id for one in m.who]) for m in summary.mistakes]
    assert found == [
        ('build', 'a.py line 1: no', ['student 1', 'student 2', 'student 4']),
        ('build', 'see the log', ['student 1', 'student 2', 'student 3']),
        ('drive', 'touched cone_1', ['student 1', 'student 5']),
        ('rate', 'it publishes on /a', ['student 6', 'student 7']),
    ]
    assert [mistake.lost for mistake in summary.mistakes] == [20.0, 20.0, 20.0, 20.0]


def test_what_the_same_students_were_told_is_one_mistake() -> None:
    both = 'it listens to /odm; did you mean /odom?'
    (mistake,) = summarize([told(1, build=both), told(2, build=both)]).mistakes
    assert mistake.text == both
    assert mistake.lost == 20.0


def test_a_course_that_was_passed_is_no_mistake() -> None:
    everyone = [
        Graded(submission(n), 40.0, [StepGrade('drive', 40.0, 38.4, told)])
        for n in (1, 2)
        for told in [passed('central_barrier', {f'0.{n} m RMS off the path': 4.0})]
    ]
    (mistake,) = summarize(everyone).mistakes
    assert mistake.text == '0.1 m RMS off the path costs 4.0 points'
    assert mistake.lost == pytest.approx(3.2)


def test_what_cost_the_class_most_is_to_be_talked_about() -> None:
    everyone = [told(k, build='no', drive='off') for k in (1, 2)] + [told(3, drive='slow')]
    assert summarize(everyone).talk_about == [
        'drive cost the class 30 of 60 points: 0 students got nothing for it, 0 got all.',
        'build cost the class 20 of 60 points: 0 students got nothing for it, 0 got all.',
        '2 students lost 20 points in build by this: no',
        '2 students lost 20 points in drive by this: off',
    ]


def test_who_was_refused_counts_only_as_that() -> None:
    everyone = [full(submission(1)), partial(submission(2), build=0.0), refused(submission(3))]
    summary = summarize(everyone)
    assert [one.submission.id for one in summary.refused] == ['student 3']
    assert summary.quartiles == [85.0, 90.0, 95.0]
    build = next(step for step in summary.steps if step.name == 'build')
    assert (build.mean, build.full, build.zero, build.lost) == (10.0, 1, 1, 20.0)


def test_nobody_is_called_refused_for_what_the_computer_lacked(tmp_path: Path) -> None:
    why = 'its report cannot be written: No space left on device'
    one = LabJob(submission(1), 'student 1', Rubric(title='T', steps=()), 'none').graded(
        Outcome(None, why, undone=True)
    )
    assert one.line(9) == f'student 1  not graded  {why}'
    assert one.said() == 'student 1 not graded'
    page = write_student_page(tmp_path, one).read_text(encoding='utf-8')
    told_of_class = class_page([one], title='T')
    for text in (Page(page).text, Page(told_of_class).text, comment(one), _as_text(one)):
        assert 'not graded' in text.casefold()
        assert 'refused' not in text.casefold()
    assert '2 not graded or refused' in class_page([one, refused(submission(2))], title='T')


def test_each_student_is_in_one_bar() -> None:
    points = [0.0, 9.9, 10.0, 70.0, 99.9, 100.0]
    drawing = histogram(points, 100.0, (10.0, 40.0, 99.0))
    tall = [float(height) for height in re.findall(r'class="bar".*?height="([\d.]+)"', drawing)]
    assert [round(height / max(tall) * 2) for height in tall] == [2, 1, 0, 0, 0, 0, 0, 1, 0, 2]


@pytest.mark.parametrize('size', [0, 1, 60])
def test_a_page_needs_nothing_and_every_link_leads_somewhere(tmp_path: Path, size: int) -> None:
    outputs = write_outputs(tmp_path, a_class(size), title='<Lab> & more')
    assert outputs.files[0] == tmp_path / 'class.html'
    pages = [tmp_path / 'class.html', *tmp_path.glob('*/index.html')]
    assert len(pages) == size + 1
    for path in pages:
        html = path.read_text(encoding='utf-8')
        page = Page(html)
        assert page.tags & {'script', 'img', 'link', 'iframe', 'form'} == set()
        assert re.findall(r'@import|url\(|[\x00-\x09\x0b-\x1f\u202e]', html) == []
        assert [link for link in page.links if not (path.parent / link).is_file()] == []
    assert '<Lab> & more' in Page(pages[0].read_text()).text


def test_names_and_reasons_are_shown_and_never_obeyed() -> None:
    page = Page(class_page(a_class(60), title='Lab'))
    assert page.text.count(printable(HOSTILE)) > 5
    assert '1 late' not in page.text
    assert 'student 4: late' in page.text
    assert '57 graded' in page.text
    assert '3 refused' in page.text


def test_a_student_sees_the_drives_but_no_hidden_one(tmp_path: Path) -> None:
    shown = ['drive_1', 'drive_2', 'drive_10']
    # A student's own files, what only the staff may see, and other steps.
    others = [COPY, BUILT, FOR_STAFF, f'{FOR_STAFF}/drive_3', 'driven', 'drive_x']
    for name in [*shown, *others]:
        (tmp_path / name).mkdir(parents=True, exist_ok=True)
        (tmp_path / name / 'report.html').write_text(name)
    (tmp_path / 'drive_4').mkdir()
    path = write_student_page(tmp_path, full(submission(1)))
    assert Page(path.read_text()).links == [f'{name}/report.html' for name in shown]


def test_a_name_that_is_not_shown_as_it_is_tells_no_place(tmp_path: Path) -> None:
    # With the character that joins no letters, as many Persian names have it.
    source = tmp_path / 'علی\u200cرضا.zip'
    source.write_bytes(b'Rar!\x1a\x07')
    (one,) = find_submissions([str(source)])
    with pytest.raises(Refused) as why:
        unpack(one, tmp_path / 'unpacked')
    page = Page(
        write_student_page(tmp_path, replace(full(one), refused=str(why.value))).read_text()
    )
    assert 'a RAR archive; hand in' in page.text
    assert str(tmp_path) not in page.text


def test_a_student_sees_no_place_of_this_machine(tmp_path: Path) -> None:
    replaced = 'replaces an older one: /exports/old.zip/5001'
    one: Submission = replace(submission(1), notes=(replaced,))
    found = [refused(one), replace(full(one), notes=(replaced, 'left out: build'))]
    pages = [Page(write_student_page(tmp_path, each).read_text()).text for each in found]
    assert [text for text in pages if '/exports' in text] == []
    assert 'a RAR archive; hand in a zip' in pages[0]
    assert 'left out: build' in pages[1]
    assert all(f'{name} is right' in pages[1] for name in MOST)
