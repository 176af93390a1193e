#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run upstream's own tests of launch, ros2cli and their kin on what is installed here.

    ./lab exec python benchmark/upstream_tests.py FOLDER [--only ros2topic ...]
        [--save results.json] [--against upstream.json] [--list]

FOLDER holds checkouts of upstream's Jazzy: `launch`, `launch_ros`, `ros2cli`, `rosidl_runtime_py`.
Their tests are copied away from upstream's modules, so that those installed are imported. Linters
are left out. Run with `--save` in an environment that has upstream itself, then with `--against`
that file elsewhere: counted are the tests that pass on upstream itself. Prints a line a package;
`--list` names each test that did not pass. The tests import `test_msgs` (a wheel of its own) and
`launch_testing_ros`; what cannot be imported shows as not passed. The domain is that of
ROS_DOMAIN_ID, or 99; `UPSTREAM_TESTS_LOG` names a file that keeps what the tests print.
"""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

_LINTERS = (
    'test_copyright.py',
    'test_flake8.py',
    'test_pep257.py',
    'test_mypy.py',
    'test_xmllint.py',
)
_FILE_SEC = 600.0
_LAUNCH_TEST = ('-m', 'launch_testing.launch_test')
# Settings of none, and what some tests take for imported, as upstream's launch does.
_PYTEST = (
    *('-m', 'pytest', '-p', 'no:cacheprovider', '-c', os.devnull, '--rootdir=.'),
    *('-p', 'osrf_pycommon.process_utils'),
)
_TESTS = {
    'launch': 'launch/launch/test',
    'launch_xml': 'launch/launch_xml/test',
    'launch_yaml': 'launch/launch_yaml/test',
    'launch_testing': 'launch/launch_testing/test',
    'launch_pytest': 'launch/launch_pytest/test',
    'launch_ros': 'launch_ros/test_launch_ros/test',
    'rosidl_runtime_py': 'rosidl_runtime_py/test',
    **{
        f'ros2{command}': f'ros2cli/ros2{command}/test'
        for command in (
            *('cli', 'topic', 'node', 'service', 'action', 'interface', 'param', 'pkg', 'doctor'),
            *('lifecycle', 'component', 'multicast'),
        )
    },
}


def main() -> int:
    """Run the tests; exit status 1 where a test passes upstream and not here."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('folder', type=Path, help="checkouts of upstream's repositories")
    parser.add_argument(
        '--only', nargs='+', choices=_TESTS, default=list(_TESTS), metavar='PACKAGE'
    )
    parser.add_argument('--save', type=Path, help='write the names of the tests that passed')
    parser.add_argument('--against', type=Path, help='count only what this file of --save names')
    parser.add_argument('--list', action='store_true', help='name each test that did not pass')
    args = parser.parse_args()
    # Not a domain that the lab takes for itself: upstream has no husky_runtime to ask.
    os.environ.setdefault('ROS_DOMAIN_ID', '99')
    counted = json.loads(args.against.read_text()) if args.against else {}
    passed: dict[str, list[str]] = {}
    missing = 0
    for package in args.only:
        with tempfile.TemporaryDirectory(prefix=f'upstream_{package}_') as scratch:
            outcomes = _run_package(args.folder / _TESTS[package], Path(scratch))
        passed[package] = sorted(name for name, good in outcomes.items() if good)
        wanted = set(counted.get(package, outcomes))
        failed = sorted(wanted - set(passed[package]))
        missing += len(failed)
        share = 100.0 * (len(wanted) - len(failed)) / max(1, len(wanted))
        print(
            f'{package:18} {len(wanted) - len(failed):4} of {len(wanted):4}  {share:5.1f} %',
            flush=True,
        )
        if args.list:
            print(''.join(f'    {name}\n' for name in failed), end='', flush=True)
    if args.save:
        args.save.write_text(json.dumps(passed, indent=1) + '\n')
    return 1 if missing else 0


def _run_package(tests: Path, scratch: Path) -> dict[str, bool]:
    """Return for each test of a folder of tests whether it passed."""
    copy = scratch / 'test'
    shutil.copytree(tests, copy, ignore=shutil.ignore_patterns(*_LINTERS))
    files = sorted({*copy.rglob('test_*.py'), *copy.rglob('*_test.py')})
    report = scratch / 'report.xml'
    outcomes: dict[str, bool] = {}
    for file in files:
        # One process a file: the names that launch gives to processes are counted in a process.
        launched = '\ndef generate_test_description' in file.read_text()
        outcomes |= _run(
            [*(_LAUNCH_TEST if launched else _PYTEST), str(file), '--junit-xml', str(report)],
            report,
            str(file.relative_to(copy)),
        )
    return outcomes


def _run(command: list[str], report: Path, file: str) -> dict[str, bool]:
    """Run one file of tests, which writes the report; return for each test whether it passed."""
    scratch = report.parent
    report.unlink(missing_ok=True)
    log = scratch / 'log.txt'
    with log.open('w') as stream:
        try:
            subprocess.run(
                [sys.executable, *command],
                cwd=scratch,
                # Some import modules that lie beside the linters left out.
                env=os.environ
                | {'PYTHONPATH': f'{scratch}/test:{os.environ.get("PYTHONPATH", "")}'},
                stdout=stream,
                stderr=subprocess.STDOUT,
                timeout=_FILE_SEC,
                check=False,
            )
        except subprocess.TimeoutExpired:
            print(f'    no end within {_FILE_SEC:.0f} s: {file}')
    if keep := os.environ.get('UPSTREAM_TESTS_LOG'):
        with Path(keep).open('a', encoding='utf-8') as stream:
            stream.write(f'==== {command}\n{log.read_text(errors="replace")}\n')
    if not report.exists():
        return {f'{file}::no report': False}
    outcomes: dict[str, bool] = {}
    for case in ElementTree.parse(report).iter('testcase'):
        scope = (case.get('classname') or '').rpartition('.')[2]
        name = f'{file}::{scope}::{case.get("name")}'
        good = all(case.find(word) is None for word in ('failure', 'error', 'skipped'))
        outcomes[name] = outcomes.get(name, True) and good
    return outcomes


if __name__ == '__main__':
    sys.exit(main())
