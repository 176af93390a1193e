# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade waypoint files, or a run that the simulator has recorded."""

import argparse
from collections.abc import Sequence
import json
import math
import os
from pathlib import Path
import sys
import time

from husky_course.printable import printable
from husky_course.record import read_record, read_run, Run
from husky_course.route import plan_route, Route
from husky_course.waypoints import load_course
from husky_runtime.command_line import (
    absolute_path,
    BAD_INPUT,
    discard_output,
    given_name,
    Parser,
    tell,
    why,
)

from husky_grader.file_grading import Grade, grade_file
from husky_grader.grade_class import (
    grade_files,
    grade_labs,
    is_of_a_class,
    NOT_PASSED,
    PASSED,
    wrong_of_class,
)
from husky_grader.playpen import default_course, default_rubric
from husky_grader.report.files import as_json, summary, write_report
from husky_grader.report.folder import alone_in
from husky_grader.run.told import Told
from husky_grader.scoring.report import FORMULA, judge, Report
from husky_grader.tally import Tally

INTERRUPTED = 130
INTERFACES = ('lab', 'clearpath')
YAML = ('.yaml', '.yml')


def _parser() -> Parser:
    parser = Parser(
        prog='grade',
        description=__doc__,
        epilog=FORMULA,
        allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        'files',
        metavar='FILE',
        type=given_name,
        nargs='*',
        help='waypoint files to grade, or folders of them',
    )
    parser.add_argument('--record', metavar='FILE', help="what the simulator's 'record' wrote")
    parser.add_argument('--waypoints', metavar='FILE', help='the course of a record or controller')
    parser.add_argument(
        '--controller', metavar='COMMAND', help='grade a node of yours: "ros2 run my_pkg my_node"'
    )
    parser.add_argument(
        '--lab',
        metavar='SUBMISSION',
        nargs='+',
        default=[],
        help='grade workspaces, step by step of a rubric: folders, archives, exports; see '
        'docs/grading.md',
    )
    parser.add_argument(
        '--sandbox',
        metavar='NAME',
        default='auto',
        help='where workspaces are built and run: auto, bwrap, podman, docker, kernel, user, none',
    )
    parser.add_argument(
        '--gradebook',
        metavar='FILE',
        type=given_name,
        help="the table of Moodle or Canvas to fill in; a copy is written with the class's report",
    )
    parser.add_argument(
        '--make-gradescope',
        metavar='FILE',
        help='write the zip by which Gradescope grades what students hand in there',
    )
    parser.add_argument(
        '--rubric',
        metavar='FILE',
        type=given_name,
        help='what a lab asks for (that of the lab sheet)',
    )
    parser.add_argument(
        '--answers', metavar='A,B,..', default='', help='what is typed into a controller that asks'
    )
    parser.add_argument(
        '--real-time-factor',
        metavar='F',
        type=float,
        default=1.0,
        help='how fast time passes at most (1.0), for one that does not just answer; above 2 a '
        'computer may be too slow for it',
    )
    parser.add_argument(
        '--interface',
        default='lab',
        choices=INTERFACES,
        help="the topics of a controller's Husky: lab, or clearpath, those of a real A200 as well",
    )
    parser.add_argument('--robot', metavar='NAME', help='which robot of the record')
    parser.add_argument(
        '--mcap',
        action='store_true',
        help='write the record as run.mcap, too, for Foxglove and ros2 bag',
    )
    parser.add_argument(
        '--report',
        metavar='DIR',
        type=given_name,
        default='report',
        help='where the reports go (%(default)s)',
    )
    parser.add_argument(
        '--wall-time', metavar='SEC', type=float, help='how long the run took on the clock'
    )
    parser.add_argument('--json', action='store_true', help='print the result as JSON')
    parser.add_argument(
        '--world',
        metavar='FILE',
        type=absolute_path,  # the record names it
        default='',
        help='MJCF world (the playpen)',
    )
    parser.add_argument(
        '--jobs', metavar='N', type=int, default=0, help='how many at a time (as many as cores)'
    )
    parser.add_argument(
        '--shard', metavar='I/N', default='', help='grade only the I-th of N shares of a class'
    )
    parser.add_argument(
        '--collect',
        metavar='DIR',
        nargs='+',
        default=[],
        help='take results from the reports of other calls, as of shards; the rest is graded',
    )
    parser.add_argument(
        '--executor',
        metavar='NAME',
        default='',
        help='where a class is graded: dask:tcp://HOST:PORT (worker processes here)',
    )
    parser.set_defaults(remembers=False)
    return parser


def main(args: Sequence[str] | None = None) -> int:
    parser = _parser()
    options = parser.parse_in_any_order(args, 'files')
    zipped = options.make_gradescope
    given = (options.files, options.record, options.controller, options.lab, zipped)
    if sum(map(bool, given)) != 1:
        if options.controller and options.files:
            parser.error(_beside_controller(options))
        parser.error(
            'give waypoint files, --record FILE, --controller COMMAND, --lab SUBMISSION or '
            '--make-gradescope FILE'
        )
    if options.record and not options.waypoints:
        parser.error('--record needs --waypoints FILE, the course that was driven')
    if not 0.0 < options.real_time_factor < math.inf:
        parser.error(f'--real-time-factor {options.real_time_factor:g}: give a number above 0')
    if options.wall_time is not None and not 0.0 <= options.wall_time < math.inf:
        parser.error(f'--wall-time {options.wall_time:g}: give a number of seconds from 0 on')
    if options.mcap and not options.record:
        parser.error('--mcap needs --record FILE, the run to write')
    if options.rubric and not (options.lab or zipped):
        parser.error('--rubric needs --lab SUBMISSION, the workspace to grade by it')
    if options.lab and (options.waypoints or options.answers):
        parser.error('--lab takes courses and answers from the rubric; see --rubric FILE')
    if options.world and (options.lab or zipped):
        parser.error(f'--world {options.world}: write it into the rubric, as `world: FILE`')
    if options.interface != INTERFACES[0] and not options.controller:
        parser.error(f'--interface {options.interface} is for a controller: give --controller')
    if options.jobs < 0:
        parser.error(f'--jobs {options.jobs}: give a number above 0')
    if wrong := wrong_of_class(options):
        parser.error(wrong)
    try:
        options.files = [file for given in options.files for file in _waypoint_files(given)]
        if options.make_gradescope:
            return _make_gradescope(options)
        with alone_in(Path(options.report)):
            status = _grade(options)
            sys.stdout.flush()
            return status
    except BrokenPipeError:
        return discard_output()
    except ValueError as error:
        print(printable(str(error), keep='\n'), file=sys.stderr)
        return BAD_INPUT
    except OSError as error:
        tell(printable(why(error)))
        _drop_output()
        return BAD_INPUT
    except KeyboardInterrupt:
        goes_on = '; the same command goes on where it was' if options.remembers else ''
        print(f'\ninterrupted{goes_on}', file=sys.stderr)
        return INTERRUPTED


def _beside_controller(options: argparse.Namespace) -> str:
    """Return what is wrong where files are given beside a controller."""
    words = ' '.join([options.controller, *options.files])
    if ' ' in options.controller or options.files[0].endswith(('.yaml', '.yml')):
        return '--controller drives one course: name that by --waypoints FILE'
    return f'--controller takes one word: put the command in quotes, as --controller "{words}"'


def _grade(options: argparse.Namespace) -> int:
    if options.record:
        return _grade_record(options)
    if options.controller:
        return _grade_controller(options)
    if options.lab:
        return grade_labs(options)
    if len(options.files) == 1 and not is_of_a_class(options):
        file, folder = options.files[0], Path(options.report)
        return _show_one(grade_file(file, folder, world=options.world), options)
    return grade_files(options)


def _waypoint_files(given: str) -> list[str]:
    """
    Return the waypoint files in a folder, or the one file that is given.

    Hidden ones are passed over, as a shell does: macOS puts a ._FILE beside each.

    :raises ValueError: if a folder has none.
    """
    if not Path(given).is_dir():
        return [given]
    files = _yaml_files(given)
    notes = list(filter(None, (_folders_passed_over(given), _names_passed_over(given))))
    if not files:
        lab = f'what was handed in for a lab is graded by --lab {given}'
        what = f'no waypoint file lies in this folder (*.yaml); {"; ".join([lab, *notes])}'
        raise ValueError(f'{given}: {what}')
    for note in notes:
        print(printable(f'{given}: {note}'), file=sys.stderr)
    return files


def _yaml_files(folder: str | Path) -> list[str]:
    return sorted(
        str(file)
        for file in Path(folder).glob('*')
        if file.suffix.lower() in YAML and not file.name.startswith('.')
    )


def _folders_passed_over(given: str) -> str:
    """Return a word about folders of files in a folder, as one of each student; '' for none."""
    inner = [
        folder.name
        for folder in sorted(Path(given).glob('[!.]*'))
        if _yaml_files(folder) and not (folder / 'report.json').exists()
    ]
    return (
        f'what lies in its folders ({_few(inner)}) is graded by {Path(given)}/*/' if inner else ''
    )


def _names_passed_over(given: str) -> str:
    """Return a word about files in a folder which Windows has given a second ending it hides."""
    names = [file.name for file in sorted(Path(given).glob('[!.]*.[Tt][Xx][Tt]'))]
    names = [name for name in names if Path(Path(name).stem).suffix.lower() in YAML]
    return f'take .txt off the names of {_few(names)}, which are passed over' if names else ''


def _few(names: list[str]) -> str:
    return ', '.join(names[:3]) + (', ...' if len(names) > 3 else '')


def _make_gradescope(options: argparse.Namespace) -> int:
    from husky_grader.autograder.gradescope_zip import make_gradescope
    from husky_grader.rubric.impossible import impossible_courses
    from husky_grader.rubric.rubric_file import load_rubric

    file = Path(options.make_gradescope)
    rubric = load_rubric(options.rubric or default_rubric())
    make_gradescope(file, rubric)
    for line in impossible_courses(rubric):
        print(printable(line), file=sys.stderr)
    print(printable(f'{file}: for Configure Autograder of Gradescope; see docs/autograders.md'))
    return PASSED


def _grade_record(options: argparse.Namespace) -> int:
    route = plan_route(load_course(options.waypoints))
    record = read_record(options.record)
    run = read_run(record, options.robot)
    report = judge(run, route, wall_time_sec=options.wall_time)
    grade = Grade(options.waypoints, as_json(report), summary(report))
    folder = Path(options.report)
    unwritten = _write(folder, report, run, route)
    status = _show_one(grade, options, unwritten)
    if options.mcap and not unwritten:
        from husky_grader.report.bag import write_bag  # ROS 2 messages take their time

        if wrong := write_bag(folder, record, record.place_of(options.robot), route, report):
            print(printable(wrong), file=sys.stderr)
    return status


def _grade_controller(options: argparse.Namespace) -> int:
    from husky_grader.jail import find_sandbox, Jail
    from husky_grader.run.live import drive_live  # rclpy and the simulator take their time
    from husky_grader.run.standstill import undisturbed

    begun, folder = time.monotonic(), Path(options.report)
    waypoints = options.waypoints or str(default_course())
    route = plan_route(load_course(waypoints))
    (folder / 'controller').mkdir(parents=True, exist_ok=True)
    with (
        Jail(find_sandbox('none'), folder / 'controller') as jail,
        WaypointTally(len(route.course.stops) - 1) as tally,
    ):
        live = undisturbed(
            lambda: drive_live(
                options.controller,
                waypoints,
                folder,
                jail,
                world=options.world,
                interface=options.interface,
                answers=_answer_lines(options.answers),
                environment=os.environ,
                start_in=Path.cwd(),
                real_time_factor=options.real_time_factor,
                on_progress=tally.show,
            )
        )
    run = read_run(live.record)
    took_sec = time.monotonic() - begun
    judged = judge(run, route, wall_time_sec=took_sec, interface=options.interface)
    report = live.with_notes(judged)
    grade = Grade(options.controller, as_json(report), summary(report))
    return _show_one(grade, options, _write(folder, report, run, route))


class WaypointTally:
    """Counts the waypoints of a live run on the terminal."""

    def __init__(self, waypoints: int) -> None:
        self._left = waypoints
        self._tally = Tally(waypoints, sys.stderr, 'the simulator starts', bar=sys.stderr.isatty())

    def __enter__(self) -> 'WaypointTally':
        return self

    def __exit__(self, *_: object) -> None:
        self._tally.close()

    def show(self, told: Told) -> None:
        """Show how far the run has come."""
        for _ in range(self._left - told.waypoints_left):
            self._tally.add(f'waypoints, {told.time_sec:.0f} s of simulated time')
        self._left = told.waypoints_left


def _write(folder: Path, report: Report, run: Run, route: Route) -> str:
    """Write a report; return why it cannot be written, or nothing: the run is not lost by that."""
    try:
        write_report(folder, report, run, route)
    except OSError as error:
        return (
            f'{folder}: the report cannot be written: {error.strerror}; free some space, or name '
            'another folder with --report DIR'
        )
    return ''


def _answer_lines(answers: str) -> str:
    return answers.replace(',', '\n') + '\n'


def _show_one(grade: Grade, options: argparse.Namespace, unwritten: str = '') -> int:
    if grade.report is None:
        print(printable(grade.text, keep='\n'), file=sys.stderr)
        return BAD_INPUT
    if options.json:
        print(json.dumps(grade.report, indent=2))
    else:
        print(grade.text)
        if not unwritten:
            print(printable(f'  report: {Path(options.report) / "report.html"}'))
    if unwritten:
        print(printable(unwritten), file=sys.stderr)
        return BAD_INPUT
    return PASSED if grade.passed else NOT_PASSED


def _drop_output() -> None:
    """Drop output that cannot be printed: Python would complain of it when it ends."""
    try:
        sys.stdout.flush()
    except OSError:
        discard_output()


if __name__ == '__main__':
    sys.exit(main())
