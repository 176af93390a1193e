#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Build an editable wheel of each distribution beside this file: its modules stay links to here.

    build_links.py FOLDER

It is what `pip install --editable` builds, but pip starts three Pythons for each distribution.
"""

from __future__ import annotations

import importlib
import os
from pathlib import Path
import sys


def main() -> None:
    target = Path(sys.argv[1]).absolute()
    target.mkdir(parents=True)
    for project in sorted(Path(__file__).absolute().parent.glob('*/pyproject.toml')):
        os.chdir(project.parent)
        with_setup = Path('setup.py').is_file()
        name = 'setuptools.build_meta' if with_setup else 'flit_core.buildapi'
        importlib.import_module(name).build_editable(str(target))


if __name__ == '__main__':
    main()
