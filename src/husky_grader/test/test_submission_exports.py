# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What Moodle, Canvas and Gradescope give, and folders of many, become a list with names."""

from collections.abc import Mapping
import io
from pathlib import Path
import time
import unicodedata
import zipfile

from husky_grader.submission import find_submissions, Refused, Submission, unpack
import pytest

MANIFEST = 'src/topic_demo/package.xml'


def packed(name: str = '') -> bytes:
    """Return a zip with a workspace; a name makes it another one."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, 'w') as archive:
        archive.writestr(MANIFEST, f'<package><name>{name}</name></package>')
    return file.getvalue()


def export(place: Path, files: dict[str, bytes], *, as_zip: bool) -> Path:
    """Write an export as it is downloaded, or as a person has unpacked it."""
    if as_zip:
        with zipfile.ZipFile(place, 'w') as archive:
            for path, content in files.items():
                archive.writestr(path, content)
        return place
    for path, content in files.items():
        (place / path).parent.mkdir(parents=True, exist_ok=True)
        (place / path).write_bytes(content)
    return place


def whose(one: Submission, folder: Path) -> str:
    """Unpack it, and return the name in its package."""
    workspace = unpack(one, folder / one.id)
    return (workspace.path / MANIFEST).read_text().partition('name>')[2].partition('<')[0]


def facts(found: list[Submission]) -> list[tuple[str, str, str]]:
    return [(one.id, one.name, one.user) for one in found]


AS_ZIP = pytest.mark.parametrize('as_zip', [True, False], ids=['zip', 'unpacked'])


@AS_ZIP
@pytest.mark.parametrize('between', ['_file_/', '_file/', '_file_'], ids=['4.0', '4.1', 'flat'])
def test_an_export_of_moodle_keeps_names_and_numbers(
    tmp_path: Path, as_zip: bool, between: str
) -> None:
    text = between.replace('file', 'onlinetext')
    files = {
        f'Ann de Groot_101_assignsubmission{between}CSE461_07_03.zip': packed('ann'),
        f'Ann de Groot_101_assignsubmission{text}onlinetext.html': b'<p>hello</p>',
        f'Çem Öz_102_assignsubmission{between}ws.zip': packed('cem'),
        f'Dan_103_assignsubmission{text}onlinetext.html': b'<p>I had no time</p>',
        f'Default group_assignsubmission{between}ws.zip': packed('none'),
    }
    found = find_submissions([str(export(tmp_path / 'down', files, as_zip=as_zip))])
    assert facts(found) == [
        ('Ann de Groot_101', 'Ann de Groot', '101'),
        ('Dan_103', 'Dan', '103'),
        ('Default group', 'Default group', ''),
        ('Çem Öz_102', 'Çem Öz', '102'),
    ]
    ann, dan, group, cem = found
    assert [whose(one, tmp_path / 'out') for one in (ann, group, cem)] == ['ann', 'none', 'cem']
    assert ann.notes == ('left out: a text typed into Moodle',)
    assert (tmp_path / 'out' / ann.id / 'CSE461_07_03' / MANIFEST).is_file()
    with pytest.raises(Refused, match='a text typed into Moodle, and no file; hand in a zip'):
        unpack(dan, tmp_path / 'out')


def test_names_in_utf8_are_read_also_where_a_zip_does_not_say_so(tmp_path: Path) -> None:
    files = {
        f'??em_102_assignsubmission_file/??/{MANIFEST}': b'',
        'caf%_3_assignsubmission_file/a.zip': packed(),
    }
    place = export(tmp_path / 'down.zip', files, as_zip=True)
    # As macOS has packed it; and a name that is in code page 437 indeed. Sums and times stay.
    data = place.read_bytes()
    for name, packed_as in ((b'??em', 'Çem'), (b'/??/', '/Ç/')):
        data = data.replace(name, packed_as.encode())
    place.write_bytes(data.replace(b'caf%', b'caf\x82'))
    cafe, cem = find_submissions([str(place)])
    assert facts([cem, cafe]) == [('Çem_102', 'Çem', '102'), ('café_3', 'café', '3')]
    assert unpack(cem, tmp_path / 'out').path.name == 'Ç'
    assert unpack(cafe, tmp_path / 'out').path.name == 'a'


@AS_ZIP
def test_files_that_moodle_keeps_in_folders_stay_there(tmp_path: Path, as_zip: bool) -> None:
    folder = 'Ann_101_assignsubmission_file_'
    files = {f'{folder}/ws/{MANIFEST}': b'<package/>', f'{folder}/ws/src/a.py': b''}
    (ann,) = find_submissions([str(export(tmp_path / 'down', files, as_zip=as_zip))])
    workspace = unpack(ann, tmp_path / 'out')
    assert workspace.path == tmp_path / 'out' / 'ws'
    assert (workspace.path / 'src' / 'a.py').is_file()


@AS_ZIP
def test_an_export_of_canvas_keeps_names_and_numbers(tmp_path: Path, as_zip: bool) -> None:
    files = {
        'degrootann_5101_90001_CSE461_07_03.zip': packed('ann'),
        'özcem_LATE_5102_90002_my_ws.zip': packed('cem'),
        'lidan_5103_90003_report.pdf': b'%PDF-1.4',
        'lidan_5103_90005_ws-1.zip': packed('newer'),
        'lidan_5103_90004_ws.zip': packed('older'),
        'anon_aB3dE_90006_ws.zip': packed('anonymous'),
        'fayeve_5104_text.html': b'<p>hello</p>',
    }
    found = find_submissions([str(export(tmp_path / 'submissions', files, as_zip=as_zip))])
    by_user = {one.user: one for one in found}
    assert facts([by_user[user] for user in ('5101', '5102', '5103', 'anon_aB3dE')]) == [
        ('degrootann_5101', 'degrootann', '5101'),
        ('özcem_5102', 'özcem', '5102'),
        ('lidan_5103', 'lidan', '5103'),
        ('anon_aB3dE', '', 'anon_aB3dE'),
    ]
    assert [one.user for one in found if one.late] == ['5102']
    assert whose(by_user['5102'], tmp_path / 'out') == 'cem'
    assert whose(by_user['5103'], tmp_path / 'out') == 'newer'
    assert by_user['5103'].notes == (
        'taken: ws-1.zip, the newest archive; left out: report.pdf, ws.zip',
    )
    with pytest.raises(Refused, match='a text or a link, and no file; hand in a zip'):
        unpack(by_user['5104'], tmp_path / 'out')


@AS_ZIP
def test_letters_with_marks_hide_no_export(tmp_path: Path, as_zip: bool) -> None:
    # Ruby's small letter for the first one of "İnce", a name of Devanagari, and one that macOS has
    # taken apart where it unpacked the export.
    apart = unicodedata.normalize('NFD', 'Ömer Öz')
    canvas = export(
        tmp_path / 'canvas',
        {
            'i\u0307nceali_5101_90001_ws.zip': packed('ali'),
            'वर्मामनीष_5102_90002_ws.zip': packed('manish'),
            f'{apart.lower().replace(" ", "")}_5103_90003_ws.zip': packed('omer'),
        },
        as_zip=as_zip,
    )
    moodle = export(
        tmp_path / 'moodle',
        {
            f'{apart}_101_assignsubmission_file_/a.zip': packed('omer'),
            'मनीष वर्मा_102_assignsubmission_file_/a.zip': packed('manish'),
        },
        as_zip=as_zip,
    )
    assert facts(find_submissions([str(canvas), str(moodle)])) == [
        ('i\u0307nceali_5101', 'i\u0307nceali', '5101'),
        ('ömeröz_5103', 'ömeröz', '5103'),
        ('वर्मामनीष_5102', 'वर्मामनीष', '5102'),
        ('Ömer Öz_101', 'Ömer Öz', '101'),
        ('मनीष वर्मा_102', 'मनीष वर्मा', '102'),
    ]


@AS_ZIP
def test_a_number_for_a_name_on_canvas_is_nobody_elses(tmp_path: Path, as_zip: bool) -> None:
    files = {
        'degrootann_5101_90001_ws.zip': packed('ann'),
        '5101_5102_90002_ws.zip': packed('one who has taken her number for a name'),
        'x_5101_y_5103_90003_2_ws.zip': packed('one who has it in a name'),
        '_5104_90004_ws.zip': packed('one whose name has no letter'),
    }
    found = find_submissions([str(export(tmp_path / 'submissions', files, as_zip=as_zip))])
    assert sorted((one.user, one.name, one.attempt) for one in found) == [
        ('5101', 'degrootann', 90001),
        ('5102', '5101', 90002),
        ('5103', 'x_5101_y', 90003),
        ('5104', '', 90004),
    ]
    assert {whose(one, tmp_path / 'out') for one in found if one.user == '5101'} == {'ann'}


@AS_ZIP
def test_several_files_of_one_canvas_user_stay_together(tmp_path: Path, as_zip: bool) -> None:
    files = {
        'degrootann_5101_90001_package.xml': b'<package/>',
        'degrootann_5101_90002_setup.py': b'',
        'özcem_5102_90003_my_path.yaml': b'waypoints: [[0, 0], [1, 0]]\n',
    }
    ann, cem = find_submissions([str(export(tmp_path / 'submissions', files, as_zip=as_zip))])
    workspace = unpack(ann, tmp_path / 'ann')
    assert workspace.handed == 'package'
    assert (workspace.path / 'src' / 'degrootann_5101' / 'setup.py').is_file()
    assert unpack(cem, tmp_path / 'cem').kind == 'waypoints'


@pytest.mark.parametrize(
    'names',
    [
        [f'cse461_{section}_{group}_ws' for section in (7, 8) for group in (3, 4)],
        [f'cse461_7_{group}_ws' for group in (3, 4)],
        [f'lab2_461_{group}_{name}' for group, name in enumerate(('ann', 'bob'), 1)],
        [f'2026_{number}_{name}' for number, name in enumerate(('ann', 'bob'), 1)],
        [f'{5100 + number}_{number}_{name}' for number, name in enumerate(('ann', 'bob'), 1)],
        [f'461_{section}_{group}_ws' for section, group in ((7, 3), (7, 5), (8, 4))],
        [f'{name}_2026_{number}_{name}' for number, name in enumerate(('ann', 'bob'), 1)],
    ],
)
def test_like_names_of_people_are_not_taken_for_canvas(names: list[str], tmp_path: Path) -> None:
    files = {f'{name}.zip': packed() for name in names}
    found = find_submissions([str(export(tmp_path / 'class', files, as_zip=False))])
    assert [one.id for one in found] == sorted(name.removesuffix('.zip') for name in files)
    assert {one.lms for one in found} == {''}


METADATA = b"""---
submission_2002:
  :submitters:
  - :name: Ann de Groot
    :sid: '0101'
    :email: ann@example.org
  - :name: Cem
    :sid:
    :email: cem@example.org
  :created_at: 2026-03-01 10:00:00.000000000 Z
  :score: 0.0
  :results: !ruby/hash:ActiveSupport::HashWithIndifferentAccess
    tests: []
  :history:
  - :submitters: []
    :id: 2001
submission_2003:
  :submitters: []
"""


def test_many_files_named_as_by_canvas_are_listed_quickly(tmp_path: Path) -> None:
    files = {f'ann_1_{number}_a': b'' for number in range(1, 20_001)}
    handed_in = str(export(tmp_path / 'ann.zip', files, as_zip=True))
    begun_sec = time.thread_time()
    find_submissions([handed_in])
    assert time.thread_time() - begun_sec < 10.0


@AS_ZIP
def test_an_export_of_gradescope_keeps_all_of_a_group(tmp_path: Path, as_zip: bool) -> None:
    files = {
        'submission_metadata.yml': METADATA,
        f'submission_2002/ws/{MANIFEST}': b'<package><name>ann</name></package>',
        f'submission_2003/{MANIFEST}': b'<package><name>none</name></package>',
        'submission_2004/answer.txt': b'42',
    }
    files = {f'assignment_77_export/{path}': content for path, content in files.items()}
    found = find_submissions([str(export(tmp_path / 'down', files, as_zip=as_zip))])
    assert facts(found) == [
        ('submission_2002', 'Ann de Groot, Cem', '0101,cem@example.org'),
        ('submission_2003', '', ''),
        ('submission_2004', '', ''),
    ]
    assert found[0].emails == ('ann@example.org', 'cem@example.org')
    assert [whose(one, tmp_path / 'out') for one in found[:2]] == ['ann', 'none']
    assert found[2].notes == ('not in submission_metadata.yml',)
    with pytest.raises(Refused, match='hand in'):
        unpack(found[2], tmp_path / 'out')


def test_broken_metadata_costs_only_the_names(tmp_path: Path) -> None:
    files = {'submission_metadata.yml': b'a: [', f'submission_1/{MANIFEST}': b'<package/>'}
    (one,) = find_submissions([str(export(tmp_path / 'down', files, as_zip=False))])
    assert one.notes[0].startswith('without names: submission_metadata.yml is not valid YAML (')
    assert unpack(one, tmp_path / 'out').kind == 'workspace'


@pytest.mark.parametrize(
    ('metadata', 'why'),
    [
        (b'[' * 200_000, 'nested too deep'),
        (b'[' + b'[],' * 1_000_000 + b']', 'of more than 1000000 parts'),
        (
            b'f: &f {":submitters": ['
            + b'{},' * 2_000
            + b']}\n'
            + b''.join(b'%d: *f\n' % number for number in range(2_000)),
            'larger than 32 MB with its aliases written out',
        ),
        (b'&a {x: *a, *a : {b: !!python/none {c: {d: {e: {f: g}}}}}}', ''),
    ],
    ids=['deep', 'long', 'aliases', 'odd'],
)
def test_hostile_metadata_costs_only_the_names(tmp_path: Path, metadata: bytes, why: str) -> None:
    files = {'submission_metadata.yml': metadata, f'submission_1/{MANIFEST}': b'<package/>'}
    (one,) = find_submissions([str(export(tmp_path / 'hostile.zip', files, as_zip=True))])
    expected = f'without names: submission_metadata.yml is {why}'
    assert one.notes[0].startswith(expected if why else 'not in submission_metadata.yml')


def test_a_newer_attempt_replaces_the_older_and_says_so(tmp_path: Path) -> None:
    then = {'degrootann_5101_90001_ws.zip': packed('old'), 'li_5103_90002_ws.zip': packed('dan')}
    now = {'degrootann_LATE_5101_90009_ws.zip': packed('new')}
    given = [
        str(export(tmp_path / 'new.zip', now, as_zip=True)),
        str(export(tmp_path / 'old.zip', then, as_zip=True)),
    ]
    for order in (given, given[::-1]):
        found = {one.user: one for one in find_submissions(order)}
        assert sorted(found) == ['5101', '5103']
        assert found['5101'].late
        old = f'{tmp_path}/old.zip/degrootann_5101_90001_ws.zip'
        assert found['5101'].notes == (f'replaces an older one: {old}',)
        assert whose(found['5101'], tmp_path / 'out') == 'new'


def test_of_two_exports_of_moodle_the_one_given_last_counts(tmp_path: Path) -> None:
    for name in ('week1', 'week2'):
        file = {'Ann Lee_7_assignsubmission_file/ws.zip': packed(name)}
        export(tmp_path / f'{name}.zip', file, as_zip=True)
    for first, last in (('week1', 'week2'), ('week2', 'week1')):
        (one,) = find_submissions([f'{tmp_path}/{first}.zip', f'{tmp_path}/{last}.zip'])
        before = f'{tmp_path}/{first}.zip/Ann Lee_7_assignsubmission_file/ws.zip'
        assert one.notes == (f'replaces one that was given before it: {before}',)
        assert whose(one, tmp_path / 'out') == last


def test_a_student_cannot_hand_in_for_another(tmp_path: Path) -> None:
    forged = {'Bob_102_assignsubmission_file_/ws.zip': packed('eve')}
    eve = export(tmp_path / 'eve.zip', forged, as_zip=True)
    bob = export(tmp_path / 'bob.zip', {MANIFEST: b'<package/>'}, as_zip=True)
    alone = find_submissions([str(bob), str(eve)])
    assert facts(alone) == [('bob', '', ''), ('eve', '', '')]
    with pytest.raises(Refused, match=r'eve\.zip: looks like an export, among single files; give'):
        unpack(alone[1], tmp_path / 'out')
    in_folder = find_submissions([str(tmp_path)])
    assert facts(in_folder) == [('bob', '', ''), ('eve', '', '')]
    assert [one.name for one in find_submissions([str(eve)])] == ['Bob']


def test_one_bad_entry_does_not_hide_the_others(tmp_path: Path) -> None:
    place = tmp_path / 'class'
    files = {
        'ann.zip': packed(),
        'bob.zip': packed()[:60],
        'cem.rar': b'Rar!\x1a\x07\x01\0',
        'dan/ws/src/pkg/package.xml': b'<package/>',
        'eve.yaml': b'waypoints: [[0, 0], [1, 0]]\n',
        '.DS_Store': b'',
    }
    export(place, files, as_zip=False)
    (place / 'fay').symlink_to(tmp_path)
    (place / 'gus').mkdir()
    found = find_submissions(
        [str(place), 'https://example.org/a.git', 'git@example.org:a.git', str(place / 'none'), '']
    )
    outcome: dict[str, str] = {}
    for one in found:
        try:
            outcome[one.id] = unpack(one, tmp_path / 'out' / one.id).kind
        except Refused as error:
            outcome[one.id] = str(error).rpartition(': ')[2].partition(';')[0]
    assert outcome['ann'] == outcome['dan'] == 'workspace'
    assert outcome['eve'] == 'waypoints'
    assert outcome['bob'].startswith('broken or incomplete')
    assert outcome['cem.rar'] == 'a RAR archive'
    assert outcome['fay'] == 'a link'
    assert outcome['gus'] == 'nothing'
    assert outcome['none'] == 'no such file or folder'
    assert outcome['a.git'] == outcome['git@example.org_a.git'] == 'a URL'
    assert outcome['unnamed'] == 'an empty name'
    assert len(found) == 11


def test_ids_are_harmless_unique_and_always_the_same(tmp_path: Path) -> None:
    for name in ('one/ann.zip', 'one/$(rm).tar', 'two/Ann.zip', 'two/ann.tar.gz', 'three/-rf.zip'):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(packed())
    given = [str(tmp_path / 'one'), str(tmp_path / 'two')]
    found = find_submissions(given)
    assert [one.id for one in found] == ['one__(rm)', 'one_ann', 'two_Ann', 'two_ann_2']
    assert find_submissions(given) == found
    assert [one.id for one in find_submissions([str(tmp_path / 'three')])] == ['rf']


@pytest.mark.parametrize('inside', ['src', 'package.xml', 'a/package.xml', '.git'])
def test_a_workspace_is_one_submission_and_not_a_class(tmp_path: Path, inside: str) -> None:
    files = {f'{inside}/a' if inside in ('src', '.git') else inside: b'', 'build/b': b''}
    place = export(tmp_path / 'ws', files, as_zip=False)
    (found,) = find_submissions([str(place)])
    assert (found.id, found.source) == ('ws', place)


def packages(names: Mapping[str, str], file: str = 'package.xml') -> dict[str, bytes]:
    return {
        f'{folder}/{file}': f'<package><name>{name}</name></package>'.encode()
        for folder, name in names.items()
    }


@pytest.mark.parametrize(
    ('files', 'expected'),
    [
        (packages({'ann': 'patrol', 'bob': 'patrol'}), ['ann', 'bob']),
        (packages({'ann': 'patrol'}) | {'bob.zip': packed()}, ['ann', 'bob']),
        (
            packages({'ann': 'a', 'bob': 'b'}) | packages({'ann': '', 'bob': ''}, '.git/HEAD'),
            ['ann', 'bob'],
        ),
        (packages({'a': 'patrol', 'b': 'yard'}), ['ws']),
        (packages({'a': 'patrol'}) | {'rosgraph.png': b'\x89PNG', 'README.md': b''}, ['ws']),
    ],
    ids=['one name', 'an archive', 'clones', 'two names', 'a picture'],
)
def test_a_class_that_hands_in_nothing_but_packages_is_a_class(
    tmp_path: Path, files: dict[str, bytes], expected: list[str]
) -> None:
    found = find_submissions([str(export(tmp_path / 'ws', files, as_zip=False))])
    assert [one.id for one in found] == expected
    assert [one.refused for one in found] == [''] * len(expected)


@pytest.mark.parametrize('given', ['.', '../link', '../ws/../ws/.'])
def test_a_folder_may_be_given_in_other_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, given: str
) -> None:
    export(tmp_path / 'ws', {MANIFEST: b'<package/>'}, as_zip=False)
    (tmp_path / 'link').symlink_to('ws')
    monkeypatch.chdir(tmp_path / 'ws')
    (found,) = find_submissions([given])
    assert unpack(found, tmp_path / 'out').path == tmp_path / 'out' / 'ws'
