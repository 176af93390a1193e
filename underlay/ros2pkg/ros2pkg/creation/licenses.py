# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The licenses that `ros2 pkg create` knows, by their SPDX names, and their texts."""

from __future__ import annotations

from pathlib import Path

# Where Debian and Ubuntu keep the long ones.
_SYSTEM_TEXTS = Path('/usr/share/common-licenses')
_FILES = {
    'Apache-2.0': Path(__file__).with_name('Apache-2.0.txt'),
    'GPL-3.0-only': _SYSTEM_TEXTS / 'GPL-3',
    'LGPL-2.1-only': _SYSTEM_TEXTS / 'LGPL-2.1',
    'LGPL-3.0-only': _SYSTEM_TEXTS / 'LGPL-3',
}
_MIT_GRANT = """\
Permission is hereby granted, free of charge, to any person obtaining a copy of this software and
associated documentation files (the "Software"), to deal in the Software without restriction,
including without limitation the rights to use, copy, modify, merge, publish, distribute,
sublicense, and/or sell copies of the Software, and to permit persons to whom the Software is
furnished to do so"""
_NO_WARRANTY = """\
THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT
NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND
NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM,
DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT
OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.
"""
_BSD = """\
Redistribution and use in source and binary forms, with or without modification, are permitted
provided that the following conditions are met:

{clauses}
THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS" AND ANY EXPRESS OR
IMPLIED WARRANTIES, INCLUDING, BUT NOT LIMITED TO, THE IMPLIED WARRANTIES OF MERCHANTABILITY AND
FITNESS FOR A PARTICULAR PURPOSE ARE DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT HOLDER OR
CONTRIBUTORS BE LIABLE FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL
DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES; LOSS OF USE,
DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER
IN CONTRACT, STRICT LIABILITY, OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT
OF THE USE OF THIS SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
"""
_BSD_CLAUSES = """\
* Redistributions of source code must retain the above copyright notice, this list of conditions
  and the following disclaimer.

* Redistributions in binary form must reproduce the above copyright notice, this list of conditions
  and the following disclaimer in the documentation and/or other materials provided with the
  distribution.

"""
_BSD_THIRD_CLAUSE = """\
* Neither the name of the copyright holder nor the names of its contributors may be used to endorse
  or promote products derived from this software without specific prior written permission.

"""
_TEXTS = {
    'BSD-2-Clause': _BSD.format(clauses=_BSD_CLAUSES),
    'BSD-3-Clause': _BSD.format(clauses=_BSD_CLAUSES + _BSD_THIRD_CLAUSE),
    'MIT': (
        f'{_MIT_GRANT}, subject to the following conditions:\n\n'
        'The above copyright notice and this permission notice shall be included in all copies or '
        'substantial\nportions of the Software.\n\n'
        f'{_NO_WARRANTY}'
    ),
    'MIT-0': f'{_MIT_GRANT}.\n\n{_NO_WARRANTY}',
}


def known() -> list[str]:
    return sorted([*_TEXTS, *_FILES])


def text(name: str) -> str | None:
    """Return the text of a license; None where it is unknown or not on this machine."""
    if name in _TEXTS:
        return _TEXTS[name]
    try:
        return _FILES[name].read_text(encoding='utf-8')
    except (KeyError, OSError):
        return None
