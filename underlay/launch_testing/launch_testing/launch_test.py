# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The command launch_test: run a file of launch tests without pytest."""

from __future__ import annotations

import argparse
import importlib.util
import logging
from pathlib import Path
import sys
from types import ModuleType

from .junitxml import unittestResultsToXml
from .loader import LoadTestsFromPythonModule
from .print_arguments import print_arguments_of_launch_description
from .test_runner import LaunchTestRunner

_logger = logging.getLogger(__name__)


def _load_python_file_as_module(test_module_name: str, python_file_path: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(test_module_name, python_file_path)
    if spec is None or spec.loader is None:
        raise ValueError(f"Test file '{python_file_path}' is not a Python file")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('launch_test_file', help='Path to the launch test.')
    parser.add_argument(
        '--package-name', help='Package of the test, for the names in the JUnit XML file.'
    )
    parser.add_argument('-v', '--verbose', action='store_true', help='Print debug messages.')
    parser.add_argument(
        '-s',
        '--show-args',
        '--show-arguments',
        action='store_true',
        help='Show the launch arguments that the test takes.',
    )
    parser.add_argument(
        'launch_arguments',
        nargs='*',
        help="Launch arguments, '<name>:=<value>'; of duplicates the last wins.",
    )
    parser.add_argument('--junit-xml', dest='xmlpath', help='File to write JUnit XML to.')


def parse_arguments() -> tuple[argparse.ArgumentParser, argparse.Namespace]:
    parser = argparse.ArgumentParser(description='Run the tests of a launch.')
    add_arguments(parser)
    return parser, parser.parse_args()


def run(
    parser: argparse.ArgumentParser,
    args: argparse.Namespace,
    test_runner_cls: type[LaunchTestRunner] = LaunchTestRunner,
) -> int | None:
    """Run the tests of a file; return 0 where all have passed, else 1."""
    if not Path(args.launch_test_file).is_file():
        parser.error(f"Test file '{args.launch_test_file}' does not exist")
    file = Path(args.launch_test_file).absolute()
    package = args.package_name or file.stem
    module = _load_python_file_as_module(package, str(file))
    test_runs = LoadTestsFromPythonModule(module, name=f'{package}.{file.stem}.launch_tests')
    runner = test_runner_cls(
        test_runs=test_runs, launch_file_arguments=args.launch_arguments, debug=args.verbose
    )
    runner.validate()
    if args.show_args:
        print_arguments_of_launch_description(
            launch_description=test_runs[0].get_launch_description()
        )
        return None
    results = runner.run()
    if args.xmlpath:
        report = unittestResultsToXml(name=f'{package}.{file.stem}', test_results=results)
        report.write(args.xmlpath, encoding='utf-8', xml_declaration=True)
    return 0 if all(result.wasSuccessful() for result in results.values()) else 1


def main() -> None:
    logging.basicConfig()
    parser, args = parse_arguments()
    if args.verbose:
        _logger.setLevel(logging.DEBUG)
    try:
        sys.exit(run(parser, args))
    except Exception as error:
        _logger.debug('where it was raised:', exc_info=True)
        parser.error(f'{type(error).__name__}: {error}')


if __name__ == '__main__':
    main()
