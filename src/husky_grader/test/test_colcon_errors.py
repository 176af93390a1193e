# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is told of a build, of all that `colcon build` has printed."""

from husky_grader.rubric.colcon_errors import first_error, without_own_errors

SECTION = '--- stderr: {package}\n{said}\n---\n{how} <<< {package}\n'


def test_the_first_package_that_failed_is_told_not_one_that_warned() -> None:
    warned = SECTION.format(package='a', said='error of a test of a', how='Finished')
    failed = [
        SECTION.format(package=package, said=f'{package} lacks a comma', how='Failed  ')
        for package in 'bc'
    ]
    assert first_error(''.join((warned, *failed))) == 'b lacks a comma'


def test_the_time_to_find_an_error_grows_with_what_a_build_prints() -> None:
    # A setup.py writes what colcon puts around it. pytest would end half an hour, as it once took.
    said = '--- stderr: a\n' * 140_000 + '---\nsilence'
    printed = SECTION.format(package='a', said=said, how='Failed  ')
    assert first_error(printed) == ''


def test_the_time_to_leave_out_errors_of_colcon_grows_with_what_a_build_prints() -> None:
    # A setup.py writes the file of colcon's frame again and again. This took minutes.
    frame = '  File "' + '/colcon_core/executor/__init__.py", ' * 10_000
    printed = f'Traceback (most recent call last):\n{frame}\n' + ' x\n' * 300_000
    assert without_own_errors(printed) == printed
