# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Hostile and broken submissions: each is refused in one line, and leaves nothing behind."""

from collections.abc import Callable, Iterator
import gzip
import io
import lzma
import os
from pathlib import Path
import re
import shutil
import socket
import stat
import struct
import subprocess
import tarfile
import tempfile
import zipfile
import zlib

from husky_course.printable import printable
from husky_grader.submission import find_submissions, Limits, Refused, unpack
from hypothesis import example, given, settings
from hypothesis import strategies as st
import pytest

MANIFEST = 'ws/src/pkg/package.xml'
SMALL = Limits(
    entries=100, total_bytes=1_000_000, file_bytes=500_000, path_bytes=200, depth=10, cpu_sec=10.0
)


def zip_of(*members: tuple[str | zipfile.ZipInfo, bytes]) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, content in ((MANIFEST, b'<package/>'), *members):
            archive.writestr(name, content, zipfile.ZIP_DEFLATED)
    return file.getvalue()


def special(name: str, mode: int) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name)
    info.create_system, info.external_attr = 3, mode << 16
    return info


def tar_member(name: str, kind: bytes = tarfile.REGTYPE, link: str = '') -> tarfile.TarInfo:
    member = tarfile.TarInfo(name)
    member.type, member.linkname = kind, link
    return member


def tar_of(*members: tarfile.TarInfo, content: bytes = b'') -> bytes:
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode='w') as archive:
        archive.addfile(tar_member(MANIFEST))
        for member in members:
            member.size = len(content) if member.isreg() else 0
            archive.addfile(member, io.BytesIO(content))
    return file.getvalue()


def raw_tar_header(name: bytes, size: bytes, kind: bytes) -> bytes:
    """Return a header whose size may be anything."""
    fields = (
        name,
        b'0000644\0',
        b'0000000\0',
        b'0000000\0',
        size,
        b'00000000000\0',
        b' ' * 8,
        kind,
    )
    header = bytearray(struct.pack('100s8s8s8s12s12s8s1s356x', *fields))
    header[257:265] = b'ustar\x0000'
    header[148:156] = b'%06o\0 ' % sum(header)
    return bytes(header)


def encrypted_zip() -> bytes:
    data = bytearray(zip_of())
    for signature, offset in ((b'PK\x03\x04', 6), (b'PK\x01\x02', 8)):
        data[data.index(signature) + offset] |= 1
    return bytes(data)


def overlapping_zip() -> bytes:
    """Return a zip whose list names one packed file 90 times (David Fifield's zip bomb)."""
    packed = zip_of(('ws/src/zeros', b'\0' * 400_000))
    start = packed.index(b'PK\x01\x02')
    second = packed.index(b'PK\x01\x02', start + 4)
    end = packed.index(b'PK\x05\x06')
    entry = packed[second:end]
    entries = [entry.replace(b'zeros', b'%05d' % number) for number in range(90)]
    data = packed[:start].replace(b'zeros', b'00000') + packed[start:second] + b''.join(entries)
    size = len(data) - start
    return data + struct.pack('<4s4H2LH', b'PK\x05\x06', 0, 0, 91, 91, size, start, 0)


def zip_with_a_wrong_size() -> bytes:
    data = bytearray(zip_of(('ws/src/a', b'a' * 5_000)))
    struct.pack_into('<L', data, data.rindex(b'PK\x01\x02') + 24, 10)
    return bytes(data)


def sparse_tar() -> bytes:
    member = tar_member('ws/src/a', tarfile.GNUTYPE_SPARSE)
    block = bytearray(member.tobuf(tarfile.GNU_FORMAT))
    struct.pack_into('12s12s', block, 386, b'0' * 11 + b'\0', b'0' * 11 + b'\0')
    struct.pack_into('12s', block, 483, b'7' * 11 + b'\0')
    block[148:156] = b' ' * 8
    block[148:156] = b'%06o\0 ' % sum(block)
    return bytes(block) + b'\0' * 1024


def tar_cut_where_a_file_ends() -> bytes:
    return tar_of(tar_member('ws/src/a'), content=b'a')[:1536]


def tar_broken_in_the_middle() -> bytes:
    data = bytearray(tar_of(tar_member('ws/src/a'), tar_member('ws/src/b')))
    data[600] ^= 255
    return bytes(data)


LEADS_OUT = 'leads out of its folder; pack it again'
TWICE = 'is in it twice; pack it again'
PLAIN = 'hand in files and folders only'
BROKEN = r'(broken or incomplete.*; pack and hand it in again)'
CASES: dict[str, tuple[Callable[[], bytes], str]] = {
    'absolute': (lambda: zip_of(('/etc/x', b'')), f'/etc/x {LEADS_OUT}'),
    'dots': (lambda: zip_of(('ws/../../x', b'')), rf'ws/\.\./\.\./x {LEADS_OUT}'),
    'backslashes': (lambda: zip_of(('ws\\..\\..\\x', b'')), rf'ws/\.\./\.\./x {LEADS_OUT}'),
    'drive': (lambda: zip_of(('C:/x', b'')), f'C:/x {LEADS_OUT}'),
    'dots in a tar': (lambda: tar_of(tar_member('../x')), rf'\.\./x {LEADS_OUT}'),
    'absolute in a tar': (lambda: tar_of(tar_member('/x')), f'/x {LEADS_OUT}'),
    'link': (
        lambda: tar_of(tar_member('ws/src/a', tarfile.SYMTYPE, '/etc/passwd')),
        f'ws/src/a is a link to /etc/passwd; {PLAIN}',
    ),
    'hard link': (
        lambda: tar_of(tar_member('ws/src/a', tarfile.LNKTYPE, '/etc/passwd')),
        f'ws/src/a is a link to /etc/passwd; {PLAIN}',
    ),
    'file behind a link': (
        lambda: tar_of(tar_member('ws/a', tarfile.SYMTYPE, '/tmp'), tar_member('ws/a/b')),
        f'ws/a is a link to /tmp; {PLAIN}',
    ),
    'link in a zip': (
        lambda: zip_of((special('ws/src/a', stat.S_IFLNK | 0o777), b'/etc/passwd')),
        f'ws/src/a is a link; {PLAIN}',
    ),
    'link for src': (
        lambda: tar_of(tar_member('src', tarfile.SYMTYPE, '/'))[1024 - 512 :],
        f'src is a link to /; {PLAIN}',
    ),
    'device': (
        lambda: tar_of(tar_member('ws/src/a', tarfile.CHRTYPE)),
        f'ws/src/a is a device; {PLAIN}',
    ),
    'fifo': (
        lambda: tar_of(tar_member('ws/src/b/package.xml', tarfile.FIFOTYPE)),
        f'ws/src/b/package.xml is a FIFO; {PLAIN}',
    ),
    'fifo in a zip': (
        lambda: zip_of((special('ws/src/a', stat.S_IFIFO | 0o644), b'')),
        f'ws/src/a is a FIFO; {PLAIN}',
    ),
    'unknown kind': (
        lambda: tar_of(tar_member('ws/src/a', b'Q')),
        f'ws/src/a is no file; {PLAIN}',
    ),
    'sparse': (sparse_tar, f'ws/src/a is a sparse file; {PLAIN}'),
    'control character': (
        lambda: zip_of(('ws/src/\x1b[31m', b'')),
        r'the name ws/src/\\x1b\[31m has bytes that are no text; rename it',
    ),
    'no UTF-8': (
        lambda: tar_of(tar_member('ws/src/\udcff')),
        r'the name ws/src/\\xff has bytes that are no text; rename it',
    ),
    'two names in case': (
        lambda: zip_of(('ws/src/a.py', b''), ('ws/src/A.py', b'')),
        'ws/src/a.py and ws/src/A.py are one name on some systems; rename one',
    ),
    'twice': (
        lambda: tar_of(tar_member('ws/src/a.py'), tar_member('./ws/src/a.py')),
        f'ws/src/a.py {TWICE}',
    ),
    'file and folder': (
        lambda: zip_of(('ws/src/a', b''), ('ws/src/a/b', b'')),
        f'ws/src/a {TWICE}',
    ),
    'long name': (lambda: zip_of((f'ws/{"a" * 300}', b'')), r'the name ws/a+\.\.\.a+ is too long'),
    'long path': (lambda: zip_of(('ab/' * 70, b'')), r'the name ab/.* is too long'),
    'deep': (lambda: zip_of(('a/' * 12, b'')), 'a/a/.*: more than 10 folders in each other'),
    'no name': (lambda: tar_of(tar_member('.')), 'a file without a name'),
    'many': (
        lambda: zip_of(*((f'ws/{number}/', b'') for number in range(100))),
        'more than 100 files and folders; leave out build, install, log',
    ),
    'many in a tar': (
        lambda: tar_of(*(tar_member(f'ws/{number}') for number in range(100))),
        'more than 100 files and folders; leave out build, install, log',
    ),
    'large file': (
        lambda: zip_of(('ws/src/zeros', b'\0' * 600_000)),
        'ws/src/zeros is larger than 0.5 MB; leave out',
    ),
    'large': (
        lambda: zip_of(*((f'ws/src/{number}', b'\0' * 400_000) for number in range(3))),
        'more than 1 MB unpacked; leave out',
    ),
    'bomb of a tar': (
        lambda: gzip.compress(b'\0' * 512 + tar_of() + b'\0' * 5_000_000),
        'more than 1 MB unpacked; leave out',
    ),
    'large in what is left out': (
        lambda: lzma.compress(tar_of(tar_member('ws/.git/a'), content=b'\0' * 2_000_000)),
        'more than 1 MB unpacked; leave out',
    ),
    'overlapping': (overlapping_zip, r'broken or incomplete \(several of its files lie at one'),
    'encrypted': (
        encrypted_zip,
        'ws/src/pkg/package.xml is encrypted; pack it without a password',
    ),
    'wrong size': (zip_with_a_wrong_size, BROKEN),
    'size below 0': (
        lambda: tar_of()[:512] + raw_tar_header(b'a', b'\xff' * 10 + b'\0\0', b'0') + b'\0' * 2048,
        # Since CVE-2025-8194 was mended, tarfile takes it for no header.
        r'broken or incomplete( \(a size below 0\))?; pack and hand it in again',
    ),
    'endless header': (
        lambda: raw_tar_header(b'a', b'77777777777\0', b'x') + b'1' * 100_000,
        # Python 3.14 asks for no more than the second at once.
        'a header of (8589934592|1048576) bytes; pack it again, with zip',
    ),
    'rare method': (
        lambda: zip_of()[:0] + lzma_zip(),
        'ws/src/a is packed by method 14; pack it by deflate',
    ),
    'cut zip': (lambda: zip_of(('ws/src/a', os.urandom(3_000)))[:1_500], BROKEN),
    'cut gz': (
        lambda: gzip.compress(tar_of(tar_member('ws/src/a'), content=os.urandom(3_000)))[:2_000],
        BROKEN,
    ),
    'cut where a file ends': (tar_cut_where_a_file_ends, BROKEN),
    'broken in the middle': (tar_broken_in_the_middle, BROKEN),
    'compressed, but no tar': (lambda: gzip.compress(b'#!/usr/bin/python3\n'), BROKEN),
    'rar': (lambda: b'Rar!\x1a\x07\x01\0', r'a RAR archive; hand in zip, tar'),
    '7z': (lambda: b"7z\xbc\xaf'\x1c\0\4", r'a 7z archive; hand in zip, tar'),
    'a program': (lambda: b'\x7fELF' * 200, r'no archive that is known here; hand in zip, tar'),
    'a waypoint file of another name': (
        lambda: b'\xef\xbb\xbf# ours\r\nwaypoints:\r\n  - [0, 0]\r\n  - [1, 0]\r\n',
        r'a waypoint file by another name; call it NAME\.yaml \(Windows hides a \.txt behind',
    ),
    'nothing': (lambda: b'', r'empty; hand in zip, tar'),
}


def lzma_zip() -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, 'w', zipfile.ZIP_LZMA) as archive:
        archive.writestr('ws/src/a', b'')
    return file.getvalue()


def everything_in(folder: Path) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob('*'))


@pytest.mark.parametrize('case', CASES)
def test_an_attack_is_refused_in_one_line(tmp_path: Path, case: str) -> None:
    make, why = CASES[case]
    (tmp_path / 'ann').write_bytes(make())
    (found,) = find_submissions([str(tmp_path / 'ann')])
    with pytest.raises(Refused, match=f'^{re.escape(str(found.source))}: ({why})[^\n]*$'):
        unpack(found, tmp_path / 'unpacked', SMALL)
    assert [name for name in everything_in(tmp_path) if name not in ('ann', 'unpacked')] == []


def test_a_folder_is_as_safe_as_an_archive(tmp_path: Path) -> None:
    source = tmp_path / 'ann'
    manifest = source / 'src' / 'pkg' / 'package.xml'
    manifest.parent.mkdir(parents=True)
    os.mkfifo(manifest)
    whys = {f'src/pkg/package.xml is a FIFO; {PLAIN}': lambda: manifest.unlink()}
    (found,) = find_submissions([str(source)])
    for why, mend in whys.items():
        with pytest.raises(Refused, match=why):
            unpack(found, tmp_path / 'unpacked', SMALL)
        mend()
    manifest.write_text('<package/>')
    (source / 'src' / 'etc').symlink_to('/etc')
    with pytest.raises(Refused, match=f'src/etc is a link; {PLAIN}'):
        unpack(found, tmp_path / 'unpacked', SMALL)
    (source / 'src' / 'etc').unlink()
    with (source / 'src' / 'sparse').open('wb') as file:
        file.truncate(1 << 40)
    with pytest.raises(Refused, match=r'src/sparse is larger than 0.5 MB'):
        unpack(found, tmp_path / 'unpacked', SMALL)
    (source / 'src' / 'sparse').unlink()
    (source / os.fsdecode(b'src/\xff')).touch()
    with pytest.raises(Refused, match=r'the name src/\\xff has bytes that are no text'):
        unpack(found, tmp_path / 'unpacked', SMALL)


def test_what_never_ends_is_not_read(tmp_path: Path) -> None:
    fifo, door = tmp_path / 'ann.zip', tmp_path / 'bob.zip'
    os.mkfifo(fifo)
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(door))
        for path in (fifo, door, Path('/dev/zero')):
            (found,) = find_submissions([str(path)])
            with pytest.raises(Refused, match=f'^{path}: no file and no folder$'):
                unpack(found, tmp_path / 'unpacked')


def test_a_manifest_that_root_waits_for_does_not_stop_a_class(tmp_path: Path) -> None:
    for name in ('ann', 'bob'):
        (tmp_path / name).mkdir()
        (tmp_path / name / 'package.xml').symlink_to('/proc/kmsg')
    (found,) = find_submissions([str(tmp_path)])
    with pytest.raises(Refused, match=r'package\.xml is a link'):
        unpack(found, tmp_path / 'unpacked')


def test_leftovers_of_colcon_may_have_links_in_them(tmp_path: Path) -> None:
    links = [
        tar_member(f'ws/{folder}/pkg/a', tarfile.SYMTYPE, '/home/ann/ws/src/pkg/a')
        for folder in ('build', 'install', 'log')
    ]
    (tmp_path / 'ann.tar').write_bytes(tar_of(*links))
    (found,) = find_submissions([str(tmp_path / 'ann.tar')])
    workspace = unpack(found, tmp_path / 'unpacked')
    assert [path for path in everything_in(workspace.path) if path.endswith('/a')] == []


def test_ten_thousand_files_are_unpacked_within_the_limits(tmp_path: Path) -> None:
    (tmp_path / 'ann.zip').write_bytes(
        zip_of(*((f'ws/src/pkg/{n % 100}/{n}.py', b'pass\n') for n in range(10_000)))
    )
    (found,) = find_submissions([str(tmp_path / 'ann.zip')])
    workspace = unpack(found, tmp_path / 'unpacked')
    assert sum(path.is_file() for path in workspace.path.rglob('*')) == 10_001


def test_a_list_of_millions_of_files_is_not_read(tmp_path: Path) -> None:
    size = 9 << 20
    end = struct.pack('<4s4H2LH', b'PK\x05\x06', 0, 0, 9, 9, size, 30, 0)
    with (tmp_path / 'ann.zip').open('wb') as file:
        file.write(b'PK\x03\x04' + b'\0' * 26)
        file.truncate(30 + size)
        file.seek(30 + size)
        file.write(end)
    (found,) = find_submissions([str(tmp_path / 'ann.zip')])
    with pytest.raises(Refused, match=r'ann.zip: its list of files is too long; .* unpacked'):
        unpack(found, tmp_path / 'unpacked')


def test_a_commit_that_names_itself_a_million_times_is_refused(tmp_path: Path) -> None:
    def git(*arguments: str, said: str = '') -> str:
        command = ['git', '-C', str(tmp_path / 'ann.git'), *arguments]
        done = subprocess.run(command, input=said, check=True, capture_output=True, text=True)
        return done.stdout.strip()

    subprocess.run(['git', 'init', '--quiet', '--bare', str(tmp_path / 'ann.git')], check=True)
    tree = f'100644 blob {git("hash-object", "-w", "--stdin")}\tfile\n'
    for _ in range(9):
        number = git('mktree', said=tree)
        tree = ''.join(f'040000 tree {number}\tfolder{n}\n' for n in range(10))
    author = ['-c', 'user.name=Ann', '-c', 'user.email=ann@example.org']
    commit = git(*author, 'commit-tree', git('mktree', said=tree), '-m', 'all')
    git('update-ref', 'HEAD', commit)
    (found,) = find_submissions([str(tmp_path / 'ann.git')])
    with pytest.raises(Refused, match=r'ann\.git: more than 100 files and folders'):
        unpack(found, tmp_path / 'unpacked', SMALL)


@pytest.fixture(scope='module')
def place() -> Iterator[Path]:
    """Return a folder that the examples of a property may share."""
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)


def taken_or_refused(data: bytes, place: Path) -> None:
    """Unpack it, and look that nothing but plain files in the folder came of it."""
    for path in place.iterdir():
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    (place / 'ann').write_bytes(data)
    (found,) = find_submissions([str(place / 'ann')])
    try:
        workspace = unpack(found, place / 'unpacked', SMALL)
    except Refused as error:
        assert printable(str(error)) == str(error)
        assert everything_in(place) in (['ann'], ['ann', 'unpacked'])
        return
    names = everything_in(place)
    below = f'unpacked/{workspace.path.name}'
    assert all(name in ('ann', 'unpacked') or f'{name}/'.startswith(f'{below}/') for name in names)
    assert all((place / name).is_dir() or (place / name).is_file() for name in names)
    assert not any((place / name).is_symlink() for name in names)


NAMES = st.lists(
    st.sampled_from(['..', '.', '', 'a', 'A', 'C:', '~', 'build', 'src', 'package.xml'])
    | st.text(max_size=8),
    min_size=1,
    max_size=5,
).map('/'.join)


@settings(max_examples=100)
@given(st.lists(NAMES, max_size=4))
@example(['ws/src/\u0130', 'ws/src/i\u0307'])
@example(['\0'])
def test_no_name_leads_out_of_the_folder(place: Path, names: list[str]) -> None:
    def utf8(name: str) -> bool:
        return not any('\ud800' <= char <= '\udfff' for char in name)

    in_zip = {name.partition('\0')[0] for name in names if utf8(name)} - {'', MANIFEST}
    taken_or_refused(zip_of(*((name, b'') for name in sorted(in_zip))), place)
    taken_or_refused(
        tar_of(*(tar_member(name.replace('\0', '')) for name in names if utf8(name))), place
    )


@settings(max_examples=150)
@given(
    st.sampled_from(['zip', 'tar', 'gz', 'xz', 'sparse']),
    st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 255)), min_size=1, max_size=4),
    st.integers(0, 100_000),
)
def test_no_broken_byte_makes_anything_but_a_refusal(
    place: Path, kind: str, flips: list[tuple[int, int]], cut: int
) -> None:
    plain = tar_of(tar_member('ws/src/a'), content=b'hello ' * 40)
    whole = {
        'zip': zip_of(('ws/src/a', b'hello ' * 40)),
        'tar': plain,
        'gz': gzip.compress(plain),
        'xz': lzma.compress(plain),
        'sparse': sparse_tar(),
    }[kind]
    data = bytearray(whole)
    for offset, value in flips:
        data[offset % len(data)] = value
    taken_or_refused(bytes(data[:cut]) if cut < len(data) else bytes(data), place)


def test_a_slow_archive_is_stopped_by_its_processor_time(tmp_path: Path) -> None:
    (tmp_path / 'ann.tgz').write_bytes(gzip.compress(tar_of(content=b'')))
    (found,) = find_submissions([str(tmp_path / 'ann.tgz')])
    with pytest.raises(Refused, match='takes more than 0 s of processor time; pack it again'):
        unpack(found, tmp_path / 'unpacked', Limits(cpu_sec=0.0))


def test_the_sum_of_a_compressed_tar_is_checked(tmp_path: Path) -> None:
    data = bytearray(gzip.compress(tar_of()))
    struct.pack_into('<L', data, len(data) - 8, zlib.crc32(b'another'))
    (tmp_path / 'ann.tgz').write_bytes(data)
    (found,) = find_submissions([str(tmp_path / 'ann.tgz')])
    with pytest.raises(Refused, match=r'broken or incomplete \(CRC check failed'):
        unpack(found, tmp_path / 'unpacked')
