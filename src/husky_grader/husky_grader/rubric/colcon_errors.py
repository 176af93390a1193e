# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `colcon build` prints of a package that it cannot build, in one line."""

import re

_BEGIN, _END, _FAILED = '--- stderr: ', '---', 'Failed '
_CMAKE = 'CMake Error at '
_TWICE = re.compile(r'Duplicate package names not supported:\n- (.*):\n  - ')
# What colcon raises where a setup.py that it runs has failed: the error of that is told beside it.
_OF_COLCON = re.compile(
    r'^Traceback .*\n  File "[^"\n]*/colcon_core/executor/__init__\.py", .*\n(?: .*\n)*'
    r'(?:subprocess\.CalledProcessError: .*\n|AssertionError: Expected .* to pass: )',
    re.MULTILINE,
)
# It has setup.py print what it says, and nothing else.
_READS_SETUP = re.compile(
    r'/python_setup_py\.py", line \d+, in _get_setup_information\n'
    r' +(?:return ast\.literal_eval|output = result\.stdout\.decode)'
)
# What Python says where colcon has it run one that is not there.
_NO_SETUP = re.compile(r"can't open file '(?:[^'\n]*/)?([^'/\n]+)/setup\.py': \[Errno 2\]")
# What Python says where setup() has ended the setup.py, or was not called.
_NO_DISTRIBUTION = "RuntimeError: 'distutils.core.setup()' was never called"
_FAILED_PACKAGE = re.compile(r'^Failed +<<< ([\w-]+)', re.MULTILINE)
_OF_SETUPTOOLS = re.compile(r'^error in .*? setup command: (.*)', re.MULTILINE)
_BEGINS_SETUP = re.compile(
    r'^(Traceback .*\n)  File "<string>", line 1, in <module>\n', re.MULTILINE
)


def without_own_errors(printed: str) -> str:
    """Return it without the errors by which colcon tells that a setup.py has failed."""
    told = _BEGINS_SETUP.sub(r'\1', _OF_COLCON.sub('', printed))
    return told.replace('  File "<string>", line ', '  File "setup.py", line ')


def printing_setup(printed: str) -> str:
    """Return that a setup.py prints, which spoils what colcon reads of it; empty if none does."""
    if not (spoilt := _READS_SETUP.search(printed)):
        return ''
    package = printed[: spoilt.start()].rpartition(_BEGIN)[2].partition('\n')[0]
    return f'setup.py of {package} prints to its standard output, which colcon reads; let it not'


def missing_setup(printed: str) -> str:
    """Return that a package has no setup.py, though its manifest says it has; empty if it has."""
    if not (missing := _NO_SETUP.search(printed)):
        return ''
    return (
        f'{missing[1]} has no setup.py, which the build type ament_python needs; ros2 pkg create '
        '--build-type ament_python makes one'
    )


def failed_packages(printed: str) -> list[str]:
    """Return the packages that could not be built."""
    return _FAILED_PACKAGE.findall(printed)


def is_without_setup(printed: str) -> bool:
    """Tell whether a setup.py has come to its end, and colcon knows nothing of what it says."""
    return _NO_DISTRIBUTION in printed


def setuptools_error(printed: str) -> str:
    """Return why setuptools refuses a setup.py, by what that has printed; empty if nothing."""
    error = _OF_SETUPTOOLS.search(printed)
    return f'setup.py: {error[1]}' if error else ''


def first_error(printed: str) -> str:
    """Return the first error of the first package that failed; empty if nothing tells one."""
    if twice := _TWICE.search(printed):
        return f'package {twice[1]} is in src twice; take one of the two out'
    failed = _of_failed(printed)
    told = printed if failed is None else failed
    lines = [line.strip() for line in told.splitlines()]
    error = next((line for line in lines if 'rror' in line), '')
    if error.startswith(_CMAKE):
        return _message_of_cmake(told.partition(error)[2]) or error
    return error or (next(filter(None, lines), '') if failed else '')


def _of_failed(printed: str) -> str | None:
    """Return what the first package that failed has printed to its standard error, if it has."""
    # By a regular expression the time would grow with the square of what a setup.py prints.
    lines = printed.split('\n')
    begin = None
    for number, line in enumerate(lines[:-1]):
        if begin is None and line.startswith(_BEGIN):
            begin = number + 1
        elif begin is not None and line == _END:
            if lines[number + 1].startswith(_FAILED):
                return '\n'.join(lines[begin:number])
            begin = None
    return None


def _message_of_cmake(below: str) -> str:
    """Return the first paragraph that is not only the beginning of the next: `... said:`."""
    paragraphs = (' '.join(each.split()) for each in re.split(r'\n\s*\n', below.lstrip('\n')))
    return next((each for each in paragraphs if each and not each.endswith(':')), '')
