#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Put a link to each installed package beside this file where Python looks for packages.

What pip installs is a file that adds a folder to sys.path. With forty of them every Python that
starts reads as many files, and looks into as many folders for a module that it does not find.
"""

from __future__ import annotations

from pathlib import Path
import sysconfig


def main() -> None:
    underlay, site = Path(__file__).resolve().parent, Path(sysconfig.get_path('purelib'))
    for path in sorted(site.glob('*.pth')):
        project = Path(path.read_text(encoding='utf-8').strip())
        if project.resolve().parent != underlay:
            continue
        for package in (file.parent for file in project.glob('*/__init__.py')):
            link = site / package.name
            link.unlink(missing_ok=True)
            link.symlink_to(package)
        path.unlink()


if __name__ == '__main__':
    main()
