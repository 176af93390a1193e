# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Drive a path through the playpen with real nodes, in a domain of their own; then a report."""

import argparse
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, ExitStack
import os
from pathlib import Path
import shlex
import shutil
import sys
import time

from husky_course.printable import printable
from husky_course.record import COURSE_NAME, FILE_NAME, read_record, read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_runtime.command_line import BAD_INPUT, discard_output, given_name, Parser, run_printing
from husky_runtime.domains import check_loopback, OwnDomain, range_of_a_run
from husky_runtime.settings import refuse_unknown, Setting, settings_of
from husky_runtime.shared_memory import check_shared_memory
from husky_runtime.supervise import run_to_end
from husky_runtime.web_address import AddressError

from husky_grader import check, grade
from husky_grader.drive_page import drive_page, DrivePage, is_at_a_terminal
from husky_grader.grade_class import NOT_PASSED, PASSED
from husky_grader.playpen import default_course
from husky_grader.report.files import keep_course
from husky_grader.report.folder import alone_in
from husky_grader.run.standstill import Watch
from husky_grader.scoring.report import judge
from husky_sim.config import BodyConfig, GroundConfig, PowerConfig, RunConfig, SensorConfig

START_SEC = 90.0  # simulated time in which the driver must have begun
CONDITIONS = {
    each.name: each
    for kind in (GroundConfig, BodyConfig, PowerConfig, SensorConfig, RunConfig)
    for each in settings_of(kind)
    if each.name in ('battery', 'battery_charge', 'floor', 'interface', 'realistic', 'seed')
}
"""Settings of the simulator that a drive may be given."""
_TRUTHS = {'true': True, 'false': False}


def _parser() -> Parser:
    parser = Parser(prog='lab drive', description=__doc__, allow_abbrev=False)
    parser.add_argument(
        'words',
        metavar='FILE | NAME:=VALUE',
        type=given_name,
        nargs='*',
        help='waypoint file to drive (central_barrier.yaml), and settings of the simulator: '
        + '; '.join(f'{name}, {each.allowed}' for name, each in CONDITIONS.items()),
    )
    parser.add_argument('--waypoints', metavar='FILE', help='the same, by its name')
    parser.add_argument(
        '--fast', action='store_true', help='as fast as this computer can, in lockstep'
    )
    parser.add_argument('--no-view', action='store_true', help='without the page in the browser')
    parser.add_argument(
        '--open',
        action=argparse.BooleanOptionalAction,
        help="open the page in this desktop's browser, and wait some seconds for it; the default "
        'in a terminal of a desktop',
    )
    parser.add_argument(
        '--report',
        metavar='DIR',
        type=given_name,
        default='report',
        help='where the report goes (%(default)s)',
    )
    return parser


def main(args: Sequence[str] | None = None) -> int:
    parser = _parser()
    options = parser.parse_in_any_order(args, 'words')
    files = [word for word in options.words if ':=' not in word]
    files += [options.waypoints] if options.waypoints is not None else []
    if len(files) > 1:
        parser.error(f'{" and ".join(files)}: give one waypoint file')
    options.waypoints = files[0] if files else str(default_course())
    try:
        conditions = _conditions(word for word in options.words if ':=' in word)
        for name in (options.waypoints, options.report):
            _refuse_bytes(name)
    except ValueError as error:
        parser.error(printable(str(error)))
    try:
        return run_printing(parser.prog, lambda: _drive(options, conditions))
    except KeyboardInterrupt:
        print('\ninterrupted', file=sys.stderr)
        return grade.INTERRUPTED


def _drive(options: argparse.Namespace, conditions: Mapping[str, str]) -> int:
    # A course through a barrier may be driven: what happens is in the report.
    if status := check.main(['--warn', options.waypoints]):
        return status
    folder = Path(options.report)
    try:
        page = None if options.no_view else drive_page(options.open)
        with alone_in(folder), _copy_in(folder, Path(options.waypoints)) as copy:
            options.waypoints = str(copy)
            status = _run(options, folder, page, conditions)
    except (ValueError, AddressError) as error:
        print(f'lab drive: {printable(str(error))}', file=sys.stderr)
        return BAD_INPUT
    if status in (PASSED, NOT_PASSED):
        _show_again(folder, page)
    return status


@contextmanager
def _copy_in(folder: Path, course: Path) -> Iterator[Path]:
    """
    Copy the course: what is driven is what is judged, whoever edits the file meanwhile.

    The copy of a drive that was killed is removed by the next one into the same folder.
    """
    folder.mkdir(parents=True, exist_ok=True)
    place = folder / '.driven'
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    try:
        yield Path(shutil.copyfile(course, place / course.name))
    finally:
        shutil.rmtree(place, ignore_errors=True)


def _run(
    options: argparse.Namespace,
    folder: Path,
    page: DrivePage | None,
    conditions: Mapping[str, str],
) -> int:
    _prepare(folder, Path(options.waypoints))
    with ExitStack() as stack:
        environment = _environment(stack, page)
        if page is not None:
            page.open()
        begun = time.monotonic()
        launch = _launch(options, folder, page, conditions)
        if options.fast:
            _run_undisturbed(launch, environment, folder / FILE_NAME, options.waypoints)
        else:
            run_to_end(launch, environment)
    wall_time_sec = time.monotonic() - begun
    if not (folder / FILE_NAME).is_file():
        why = 'no simulator has started: what it said stands above'
        if not (folder / COURSE_NAME).is_file():
            why = printable(f'{folder} was emptied, renamed or removed meanwhile; drive again')
        print(f'lab drive: {why}', file=sys.stderr)
        return BAD_INPUT
    record = ['--record', str(folder / FILE_NAME), '--waypoints', options.waypoints, '--mcap']
    return grade.main([*record, '--report', str(folder), '--wall-time', f'{wall_time_sec:.3f}'])


def _run_undisturbed(
    launch: Sequence[str], environment: Mapping[str, str], record: Path, waypoints: str
) -> None:
    """
    Run a drive in lockstep; once more if it failed and the computer stood still meanwhile.

    After 20 s nodes hold each other for dead, and the message that one waits for may be lost.
    """
    watch = Watch()
    try:
        run_to_end(launch, environment)
    finally:
        stood_still = watch.end()
    if stood_still and not _is_passed(record, waypoints):
        print(
            'lab drive: the computer stood still meanwhile, or Ctrl-Z did it: it is driven again',
            file=sys.stderr,
        )
        run_to_end(launch, environment)


def _is_passed(record: Path, waypoints: str) -> bool:
    route = plan_route(load_course(waypoints))
    return record.is_file() and judge(read_run(read_record(record)), route).passed


def _refuse_bytes(name: str) -> None:
    """
    Refuse the name of a file that ROS cannot be told.

    :raises ValueError: if it is not UTF-8.
    """
    try:
        str(Path(name).absolute()).encode()
    except UnicodeEncodeError:
        raise ValueError(f'{name}: ROS takes names in UTF-8 alone; rename it') from None


def _conditions(words: Iterable[str]) -> dict[str, str]:
    """
    Read NAME:=VALUE.

    :raises ValueError: naming what is allowed.
    """
    given = dict(word.split(':=', 1) for word in words)
    refuse_unknown(given, CONDITIONS)
    return {name: _checked(CONDITIONS[name], text) for name, text in given.items()}


def _checked(setting: Setting, text: str) -> str:
    """Return a value as `ros2 launch` takes it, which reads numbers as Python does."""
    kind = type(setting.default)
    try:
        value = _TRUTHS[text.lower()] if kind is bool else kind(text)
    except (KeyError, ValueError):
        value = None
    checked = setting.checked(value, lambda *_: _refusal(setting, text))
    return str(checked).lower() if kind is bool else str(checked)


def _refusal(setting: Setting, text: str) -> ValueError:
    return ValueError(f'{setting.name}:={text} is not allowed; allowed: {setting.allowed}')


def _show_again(folder: Path, page: DrivePage | None) -> None:
    """Say how to see the run again; in a terminal the page shows it, until Ctrl-C."""
    try:
        print(printable(f'  see it again: ./lab view {shlex.quote(str(folder))}'), flush=True)
    except OSError:  # nobody reads it any more, or the disk is full
        discard_output()
        return
    if page is not None and is_at_a_terminal():
        page.replay(folder, os.environ)


def _prepare(folder: Path, waypoints: Path) -> None:
    """Make the report's folder, without the record of an earlier run."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / FILE_NAME).unlink(missing_ok=True)
    keep_course(waypoints, folder)


def _environment(stack: ExitStack, page: DrivePage | None) -> Mapping[str, str]:
    """Put the run into a domain of its own, unless the user has chosen one."""
    check_shared_memory()
    environment = {**os.environ, **(page.environment if page is not None else {})}
    if os.environ.get('ROS_DOMAIN_ID'):
        check_loopback()
        return {**environment, **range_of_a_run()}
    domain = stack.enter_context(OwnDomain())
    number = domain.number
    print(f'ROS domain {number}, of this run alone; to look in: export ROS_DOMAIN_ID={number}')
    sys.stdout.flush()
    return {**environment, **domain.environment}


def _launch(
    options: argparse.Namespace,
    folder: Path,
    page: DrivePage | None,
    conditions: Mapping[str, str],
) -> list[str]:
    course = load_course(options.waypoints)
    arguments = {
        **conditions,
        # The driver keeps a limit of its own; this one ends a run whose driver hangs.
        'waypoints': str(Path(options.waypoints).resolve()),
        'limit_sec': f'{plan_route(course).limit_sec + START_SEC:.1f}',
        'record': str(folder.resolve() / FILE_NAME),
        'real_time_factor': '0.0' if options.fast else '1.0',
        'lockstep': str(options.fast).lower(),
        **(page.launch_arguments if page is not None else {'viewer': 'false'}),
    }
    words = [f'{name}:={value}' for name, value in arguments.items()]
    return ['ros2', 'launch', 'husky_grader', 'drive.launch.py', *words]


if __name__ == '__main__':
    sys.exit(main())
