# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What students hand in, in every shape that is taken, becomes the same plain workspace."""

from collections.abc import Callable, Mapping
import io
import os
from pathlib import Path
import subprocess
import sys
import tarfile
import zipfile

from husky_grader.grade import main as grade
from husky_grader.submission import find_submissions, Refused, Submission, unpack, Workspace
from husky_grader.submission.git import why_not
from playpen_testing.jails import as_ordinary_user
import pytest

PACKAGE = {'topic_demo/package.xml': '<package/>', 'topic_demo/topic_demo/talk.py': 'pass\n'}
SOURCES = {f'src/{path}': text for path, text in PACKAGE.items()}
COURSE = 'waypoints: [[0, 0], [-2, 0]]\n'


def below(folder: str, files: Mapping[str, str]) -> dict[str, str]:
    return {f'{folder}/{path}': text for path, text in files.items()}


def in_folder(place: Path, files: Mapping[str, str]) -> Path:
    for path, text in files.items():
        (place / path).parent.mkdir(parents=True, exist_ok=True)
        (place / path).write_text(text)
    return place


def in_zip(place: Path, files: Mapping[str, str]) -> Path:
    with zipfile.ZipFile(place, 'w', zipfile.ZIP_DEFLATED) as archive:
        for path, text in files.items():
            archive.writestr(path, text)
    return place


def in_tar(place: Path, files: Mapping[str, str], packed: str = '') -> Path:
    with tarfile.open(place, f'w:{packed}') as archive:  # type: ignore[call-overload]
        for path, text in files.items():
            member = tarfile.TarInfo(f'./{path}')
            member.size = len(text.encode())
            archive.addfile(member, io.BytesIO(text.encode()))
    return place


def git(*arguments: str) -> None:
    identity = ['-c', 'user.name=Ann', '-c', 'user.email=ann@example.org']
    subprocess.run(['git', *identity, *arguments], check=True, capture_output=True)


def in_git(place: Path, files: Mapping[str, str]) -> Path:
    in_folder(place, files)
    git('init', '--quiet', str(place))
    git('-C', str(place), 'add', '.')
    git('-C', str(place), 'commit', '--quiet', '--message', 'all')
    return place


def in_bare_git(place: Path, files: Mapping[str, str]) -> Path:
    clone = in_git(place.with_name('working'), files)
    git('clone', '--quiet', '--bare', str(clone), str(place))
    return place


def only(path: Path) -> Submission:
    (found,) = find_submissions([str(path)])
    return found


def tree(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): path.read_text()
        for path in sorted(folder.rglob('*'))
        if path.is_file()
    }


def unpacked(path: Path) -> Workspace:
    return unpack(only(path), path.parent / 'unpacked')


@pytest.mark.parametrize(
    ('pack', 'kind'),
    [
        (in_folder, 'folder'),
        (in_zip, 'zip'),
        (in_tar, 'tar'),
        (lambda place, files: in_tar(place, files, 'gz'), 'tar'),
        (lambda place, files: in_tar(place, files, 'bz2'), 'tar'),
        (lambda place, files: in_tar(place, files, 'xz'), 'tar'),
        (in_git, 'git'),
        (in_bare_git, 'git'),
    ],
    ids=['folder', 'zip', 'tar', 'gz', 'bz2', 'xz', 'git', 'bare git'],
)
def test_every_shape_becomes_the_same_workspace(
    tmp_path: Path, pack: Callable[[Path, Mapping[str, str]], Path], kind: str
) -> None:
    # No ending: the content says what it is.
    source = pack(tmp_path / 'ann', below('CSE461_07_03', SOURCES))
    found = only(source)
    if found.source != source:  # a folder around one folder: that one is the submission
        assert (found.id, kind) == ('CSE461_07_03', 'folder')
    workspace = unpack(found, tmp_path / 'unpacked')
    assert found.kind == kind
    assert workspace == Workspace(
        tmp_path / 'unpacked' / 'CSE461_07_03', 'workspace', 'workspace', ()
    )
    assert tree(tmp_path / 'unpacked') == below('CSE461_07_03', SOURCES)


@pytest.mark.parametrize(
    ('files', 'name', 'handed'),
    [
        (SOURCES, 'ann', 'workspace'),
        (below('a', below('b', SOURCES)), 'b', 'workspace'),
        (PACKAGE, 'ann', 'packages'),
        (below('CSE461_07_03', PACKAGE), 'CSE461_07_03', 'packages'),
    ],
    ids=['only src', 'wrapped twice', 'only packages', 'packages in a folder'],
)
def test_a_workspace_is_found_however_it_is_wrapped(
    tmp_path: Path, files: dict[str, str], name: str, handed: str
) -> None:
    workspace = unpacked(in_zip(tmp_path / 'ann.zip', files))
    assert (workspace.path.name, workspace.handed) == (name, handed)
    assert tree(workspace.path) == SOURCES


def test_a_package_alone_gets_a_workspace_around_it(tmp_path: Path) -> None:
    files = {path.removeprefix('topic_demo/'): text for path, text in PACKAGE.items()}
    workspace = unpacked(in_tar(tmp_path / 'topic_demo.tar.gz', files, 'gz'))
    assert workspace.handed == 'package'
    assert tree(workspace.path) == SOURCES


def test_what_is_no_work_of_a_student_is_left_out(tmp_path: Path) -> None:
    silent = {
        **{'__MACOSX/ws/._src': '', 'ws/.DS_Store': '', 'ws/src/topic_demo/._package.xml': ''},
        **{'ws/.git/config': '', 'ws/src/topic_demo/__pycache__/a.pyc': '', 'ws/.venv/x.py': ''},
    }
    named = {
        **{'ws/build/COLCON_IGNORE': '', 'ws/log/latest/a.log': '', 'notes.txt': ''},
        'ws/install/topic_demo/share/topic_demo/package.xml': '<package/>',
    }
    kept = {**SOURCES, 'src/topic_demo/topic_demo/log/a.py': '', 'README.md': ''}
    files = {**below('ws', kept), **silent, **named}
    workspace = unpacked(in_zip(tmp_path / 'ann.zip', files))
    assert tree(workspace.path) == kept
    assert workspace.notes == ('left out: notes.txt, ws/build, ws/install, ws/log',)


def test_what_colcon_has_made_in_src_is_left_out(tmp_path: Path) -> None:
    folder = in_folder(tmp_path / 'ann', SOURCES)
    for made in ('build', 'install', 'log', 'install/topic_demo/log'):
        (folder / 'src' / made).mkdir(parents=True)
        (folder / 'src' / made / 'COLCON_IGNORE').touch()
    (folder / 'src/log/latest').symlink_to('build_2026')
    (folder / 'src/install/topic_demo/package.xml').write_text(SOURCES[next(iter(SOURCES))])
    (folder / 'src/topic_demo/log').mkdir()
    (folder / 'src/topic_demo/log/kept.txt').touch()
    workspace = unpacked(folder)
    assert tree(workspace.path) == {**SOURCES, 'src/topic_demo/log/kept.txt': ''}
    assert workspace.notes == ('left out: src/build, src/install, src/log',)


def test_a_waypoint_file_may_be_handed_in_alone(tmp_path: Path) -> None:
    plain = in_folder(tmp_path, {'my_path.yaml': COURSE}) / 'my_path.yaml'
    packed = in_zip(tmp_path / 'ann.zip', {'paths/my_path.yaml': COURSE})
    for source, kind in ((plain, 'yaml'), (packed, 'zip')):
        assert only(source).kind == kind
        workspace = unpacked(source)
        assert (workspace.kind, workspace.path.name) == ('waypoints', 'my_path.yaml')
        assert workspace.path.read_text() == COURSE


def test_a_waypoint_file_may_have_documents_beside_it(tmp_path: Path) -> None:
    files = {'my_path.yaml': COURSE, 'report/Bericht Ä.PDF': '%PDF', 'map.png': ''}
    workspace = unpacked(in_zip(tmp_path / 'ann.zip', files))
    assert (workspace.kind, workspace.path.name) == ('waypoints', 'my_path.yaml')
    assert workspace.notes == ('left out beside my_path.yaml: map.png, report/Bericht Ä.PDF',)
    repository = {'.github/classroom.yml': '', '.gitignore': '', 'LICENSE': '', 'README.md': ''}
    workspace = unpacked(in_zip(tmp_path / 'cem.zip', {'p.yml': COURSE, **repository}))
    assert (workspace.kind, workspace.path.name) == ('waypoints', 'p.yml')
    for other in ('drive.py', 'other.yaml'):
        with pytest.raises(Refused, match='no package in it'):
            unpacked(in_zip(tmp_path / 'ann.zip', {**files, other: ''}))


def test_a_folder_with_an_archive_hands_in_the_archive(tmp_path: Path) -> None:
    in_zip(in_folder(tmp_path / 'class' / 'ann', {'report.txt': 'I'}) / 'ws.zip', SOURCES)
    workspace = unpacked(tmp_path / 'class')
    assert (workspace.path.name, tree(workspace.path)) == ('ws', SOURCES)
    assert workspace.notes == ('left out beside ws.zip: report.txt',)
    in_zip(tmp_path / 'class' / 'ann' / 'ws_new.zip', SOURCES)
    with pytest.raises(Refused, match=r'ann: 2 archives: ws.zip, ws_new.zip; hand in one$'):
        unpacked(tmp_path / 'class')


def test_a_copy_keeps_the_right_to_run_and_the_source(tmp_path: Path) -> None:
    source = in_folder(tmp_path / 'ws', {**SOURCES, 'src/run.sh': 'true\n'})
    (source / 'src' / 'run.sh').chmod(0o4755)
    for name in ('ws', 'ws.tar', 'ws.zip'):
        if name == 'ws.tar':
            with tarfile.open(tmp_path / name, 'w') as archive:
                archive.add(source, 'ws')
        if name == 'ws.zip':
            with zipfile.ZipFile(tmp_path / name, 'w') as zipped:
                for path in sorted(source.rglob('*')):
                    zipped.write(path, path.relative_to(tmp_path))
        workspace = unpacked(tmp_path / name)
        assert (workspace.path / 'src' / 'run.sh').stat().st_mode & 0o7111 == 0o111
        assert os.access(workspace.path / 'src/topic_demo/package.xml', os.R_OK)
        assert not os.access(workspace.path / 'src/topic_demo/package.xml', os.X_OK)
        assert tree(source) == {**SOURCES, 'src/run.sh': 'true\n'}


def test_unpacking_again_replaces_what_was_there(tmp_path: Path) -> None:
    source = in_zip(tmp_path / 'ann.zip', SOURCES)
    first = unpacked(source)
    in_folder(first.path, {'src/report.json': 'forged'})
    (tmp_path / 'unpacked' / '.unpacking').mkdir()  # as a killed call leaves it
    assert unpacked(source) == first
    assert [path.name for path in (tmp_path / 'unpacked').iterdir()] == ['ann']
    assert tree(first.path) == SOURCES


@pytest.mark.parametrize(
    ('files', 'why'),
    [
        ({'main.py': '', 'doc/a.txt': ''}, r'no package in it .* but: doc, main.py; hand in the'),
        (
            {},
            'no package in it .* but: nothing; hand in the workspace, with your packages in src, '
            'or the waypoint file alone where one is asked for',
        ),
        (
            {**below('old', SOURCES), **below('new', SOURCES)},
            '2 workspaces in it: new, old; hand in one',
        ),
        (
            {'ws/src/notes': '', 'ws/install/a/share/a/package.xml': ''},
            'no package in it .* but: ws/install, ws/src; hand in',
        ),
        (
            {'report.pdf': '%PDF-'},
            'only report.pdf is in it; hand in the workspace, with your packages in src, or the '
            'waypoint file alone where one is asked for',
        ),
        (
            {'lab/p1.yaml': COURSE, 'lab/p2.yaml': COURSE, 'lab/x.txt': ''},
            'no package in it .* but: lab/p1.yaml, lab/p2.yaml, lab/x.txt; hand in ',
        ),
        (
            {'my_path.yaml': COURSE, 'b.yaml': COURSE},
            'no package in it .* but: b.yaml, my_path.yaml; hand in the workspace, with your '
            'packages in src, or the waypoint file alone where one is asked for',
        ),
        (
            {'ws/ws.zip': '', 'ws/report.pdf': ''},
            r'no package in it .* but: ws/ws\.zip; hand in that one',
        ),
        (
            {'class/ann.zip': '', 'class/cem.TGZ': ''},
            r'no package in it .* but: class/ann\.zip, class/cem\.TGZ; hand in one; a whole class '
            'is given unpacked, or as the export that it was',
        ),
    ],
    ids=[
        *(
            'no package',
            'empty',
            'two',
            'only built',
            'a report',
            'courses in a folder',
            'two courses',
            'an archive',
        ),
        'a class',
    ],
)
def test_what_is_no_workspace_is_named(tmp_path: Path, files: dict[str, str], why: str) -> None:
    with pytest.raises(Refused, match=f'^[^\n]*ann.zip: {why}[^\n]*$'):
        unpacked(in_zip(tmp_path / 'ann.zip', files))
    assert list((tmp_path / 'unpacked').iterdir()) == []


UNPACKED = """
from pathlib import Path
import sys
from husky_grader.submission import find_submissions, unpack
try:
    unpack(*find_submissions(sys.argv[1:2]), Path(sys.argv[2]))
except ValueError as error:
    print(error)
"""


@pytest.mark.parametrize('closed', ['src', 'src/topic_demo/package.xml'])
def test_what_may_not_be_read_is_told_by_its_own_path(tmp_path: Path, closed: str) -> None:
    place = in_folder(tmp_path / 'ann', SOURCES)
    mode = (place / closed).stat().st_mode
    (place / closed).chmod(0)
    command = [sys.executable, '-c', UNPACKED, str(place), str(tmp_path / 'out')]
    done = subprocess.run(as_ordinary_user(command), capture_output=True, text=True)
    (place / closed).chmod(mode)
    told = f'{place}: {closed} may not be read; give the grader the right to\n'
    assert (done.stdout, done.stderr) == (told, '')


def test_an_archive_in_an_archive_is_not_unpacked(tmp_path: Path) -> None:
    inner = in_zip(tmp_path / 'inner.zip', SOURCES)
    with zipfile.ZipFile(tmp_path / 'ann.zip', 'w') as archive:
        archive.write(inner, 'inner.zip')
    with pytest.raises(Refused, match=r'only another archive is in it, inner.zip; hand in that'):
        unpacked(tmp_path / 'ann.zip')


def test_git_obeys_nothing_of_a_bare_repository(tmp_path: Path) -> None:
    bare = in_bare_git(tmp_path / 'ann.git', SOURCES)
    trap = tmp_path / 'trap'
    trap.write_text(f'#!/bin/sh\ntouch {tmp_path}/sprung\ncat\n')
    trap.chmod(0o755)
    for hook in ('post-checkout', 'reference-transaction', 'post-upload-pack'):
        (bare / 'hooks').mkdir(exist_ok=True)
        (bare / 'hooks' / hook).symlink_to(trap)
    with (bare / 'config').open('a') as config:
        config.write(f'[core]\n fsmonitor = {trap}\n pager = {trap}\n sshCommand = {trap}\n')
        config.write(f'[uploadpack]\n packObjectsHook = {trap}\n[tar "tar"]\n command = {trap}\n')
    (bare / 'objects' / 'passwd').symlink_to('/etc/passwd')  # a local clone would take it
    workspace = unpacked(bare)
    assert tree(workspace.path) == SOURCES
    assert not (tmp_path / 'sprung').exists()


def test_a_bare_repository_of_another_user_is_not_called_broken(tmp_path: Path) -> None:
    bare = in_bare_git(tmp_path / 'ann.git', SOURCES)
    command = ['git', 'clone', '--bare', '--no-local', '--', str(bare), str(tmp_path / 'clone')]
    other = {**os.environ, 'LC_ALL': 'C', 'GIT_TEST_ASSUME_DIFFERENT_OWNER': '1'}
    done = subprocess.run(command, env=other, capture_output=True, text=True)
    assert done.returncode != 0
    assert why_not(done.stderr) == (
        'a bare repository of another user, which git does not read; copy it (cp -r), and give '
        'the copy'
    )


def test_a_bare_repository_without_a_commit_is_refused(tmp_path: Path) -> None:
    git('init', '--quiet', '--bare', str(tmp_path / 'ann.git'))
    with pytest.raises(Refused, match=r'ann.git: git cannot read it \(.*push a commit'):
        unpacked(tmp_path / 'ann.git')


@pytest.mark.parametrize(
    'files', [below('ws', SOURCES), PACKAGE, {'package.xml': '<package/>', 'a/talk.py': ''}]
)
def test_a_jail_may_read_what_was_unpacked_by_whatever_umask(
    tmp_path: Path, files: Mapping[str, str]
) -> None:
    given = only(in_zip(tmp_path / 'ann.zip', files))
    before = os.umask(0o077)
    try:
        place = unpack(given, tmp_path / 'report').path
    finally:
        os.umask(before)
    found = [place, *place.rglob('*')]
    assert len(found) >= 4
    for path in found:
        assert path.stat().st_mode & 0o777 == (0o755 if path.is_dir() else 0o644), path


@pytest.mark.parametrize('name', ['handed_in', 'built'])
def test_a_copy_that_an_earlier_grading_has_made_is_left_out(tmp_path: Path, name: str) -> None:
    copy = {**below(f'my_report/{name}/ws', SOURCES), f'my_report/{name}/COLCON_IGNORE': ''}
    given = only(in_zip(tmp_path / 'ann.zip', below('ws', {**SOURCES, **copy})))
    workspace = unpack(given, tmp_path / 'report')
    assert workspace.notes == (f'left out: ws/my_report/{name}',)
    assert sorted(path.name for path in workspace.path.iterdir()) == ['my_report', 'src']
    assert list((workspace.path / 'my_report').iterdir()) == []


@pytest.mark.parametrize('name', ['COLCON_IGNORE', 'Colcon_Ignore'])
def test_a_workspace_leaves_the_name_of_the_mark_for_colcon_free(
    tmp_path: Path, name: str
) -> None:
    in_folder(tmp_path / 'report', {'COLCON_IGNORE': ''})
    for archive, files in ('ann.zip', below(name, SOURCES)), (f'{name}.zip', SOURCES):
        workspace = unpack(only(in_zip(tmp_path / archive, files)), tmp_path / 'report')
        assert workspace.path.name == f'{name}_2'
        assert tree(workspace.path) == SOURCES
    assert (tmp_path / 'report' / 'COLCON_IGNORE').is_file()


def test_a_class_is_graded_where_a_workspace_is_named_as_that_mark(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path / 'state'))
    built = '<export><build_type>ament_python</build_type></export>'
    manifest = f'<package><name>p</name>{built}</package>'
    handed_in = tmp_path / 'class'
    handed_in.mkdir()
    for student, name in ('ann', 'COLCON_IGNORE'), ('bob', 'ws'):
        in_zip(handed_in / f'{student}.zip', {f'{name}/src/p/package.xml': manifest})
    rubric = tmp_path / 'rubric.yaml'
    rubric.write_text('title: T\nsteps: [{kind: package, points: 1, package: p}]\n')
    words = ['--lab', str(handed_in), '--rubric', str(rubric), '--report', str(tmp_path / 'r')]
    assert grade(words) == 0
