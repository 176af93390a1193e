# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `./lab` says when it cannot set up: one line, exit status 2, nothing broken."""

from dataclasses import dataclass
import os
from pathlib import Path
import shutil
import subprocess
import sys

from playpen_testing.lab_script import (
    bare_clone,
    lab,
    plain_environment,
    program,
    refused,
    ROOT,
    sourced,
)
import pytest

NO_PROC = (
    'exec unshare --map-root-user --mount '
    'bash -c \'mount -t tmpfs none /proc; exec "$0" exec true\' "$0"'
)
PYTHON_CAN_BE_TOLD = sys.version_info >= (3, 11)  # to import nothing from where it is called
NOBODY = 'http://127.0.0.1:9/simple'  # an index of packages that does not answer


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    return bare_clone(tmp_path / 'clone')


@pytest.fixture
def script_alone(tmp_path: Path) -> Path:
    """Return a folder with `./lab` alone, for what is refused before anything else is read."""
    folder = tmp_path / 'script'
    folder.mkdir()
    shutil.copy(ROOT / 'lab', folder)
    return folder


@pytest.mark.parametrize('char', [':', ';', '=', '$', '{', '}', '\\'])
def test_a_folder_that_no_tool_can_name_is_refused(script_alone: Path, char: str) -> None:
    other = script_alone.rename(script_alone.with_name(f'a{char}b'))
    refused(lab(other, 'exec', 'true'), f"a '{char}' in a folder's name", 'rename it')


def test_a_folder_with_a_line_break_in_its_name_is_refused(script_alone: Path) -> None:
    other = script_alone.rename(script_alone.with_name('a\nb'))
    refused(lab(other, 'exec', 'true'), 'a\\nb: a line break in a folder', 'rename it')


@pytest.mark.parametrize('char', ['"', '`', '*'])
def test_a_folder_that_colcon_cannot_build_in_is_refused(script_alone: Path, char: str) -> None:
    other = script_alone.rename(script_alone.with_name(f'a{char}b'))
    refused(lab(other, 'exec', 'true'), 'colcon cannot build in a folder with a "', 'rename it')


@pytest.mark.parametrize(
    ('before', 'said'),
    [
        ('ulimit -n 32', "a program may open only 32 files here: 'ulimit -n 256' allows more"),
        # So few that the script itself cannot read in /proc whether SIGINT is blocked.
        ('ulimit -n 6', "a program may open only 6 files here: 'ulimit -n 256' allows more"),
        (NO_PROC, "/proc is not there, which programs need: 'mount -t proc"),
        ('ulimit -v 900000', "only 900 MB of addresses here, the simulator needs 1500: 'ulimit"),
        ('rmdir "$PWD"', 'is gone: cd to another'),
    ],
)
def test_a_terminal_in_which_no_program_can_run_is_refused(
    script_alone: Path, tmp_path: Path, before: str, said: str
) -> None:
    (tmp_path / 'here').mkdir()
    done = subprocess.run(
        ['bash', '-c', f'{before}; exec "$0" exec true', script_alone / 'lab'],
        cwd=tmp_path / 'here',
        env=plain_environment(),
        capture_output=True,
        text=True,
        timeout=20,
    )
    assert (done.returncode, said in done.stderr.splitlines()[-1]) == (2, True), done.stderr


def test_a_terminal_of_macos_is_given_files_for_every_connection_of_the_page() -> None:
    done = sourced('ulimit -Sn 256; check_terminal; ulimit -Sn')
    assert done.stdout.split() == ['1024'], done.stderr


@pytest.mark.parametrize('file', ['numpy.py', 'mujoco/__init__.py', 'launch.py'])
def test_packages_that_would_take_the_place_of_the_labs_are_refused(
    tmp_path: Path, file: str
) -> None:
    (tmp_path / file).parent.mkdir(exist_ok=True)
    (tmp_path / file).touch()
    done = sourced('(enter_venv pip) || set_up pip python key', PYTHONPATH=f'/none:{tmp_path}')
    refused(done, f'PYTHONPATH has a {file.split("/")[0].split(".")[0]} in {tmp_path}')


def test_messages_of_ros_1_in_the_place_of_the_labs_are_refused(tmp_path: Path) -> None:
    (tmp_path / 'rospy').mkdir()
    (tmp_path / 'rospy' / '__init__.py').touch()
    refused(sourced('enter_venv pip', PYTHONPATH=str(tmp_path)), f'leads to ROS 1 in {tmp_path}')


def test_a_folder_of_launch_files_in_pythonpath_is_allowed(tmp_path: Path) -> None:
    (tmp_path / 'launch').mkdir()
    done = sourced('enter_venv pip', PYTHONPATH=str(tmp_path))
    assert (done.returncode, done.stderr) == (0, '')


def test_what_another_ros_chose_is_left_where_there_are_wheels() -> None:
    script = 'enter_venv pip; echo "${RMW_IMPLEMENTATION-none}"'
    assert sourced(script, RMW_IMPLEMENTATION='rmw_cyclonedds_cpp').stdout == 'none\n'


# Such as what modules of a cluster set.
OF_ANOTHER_PYTHON = {'PYTHONWARNINGS': 'error', 'PYTHONPATH': '/c', 'PYTHONHOME': '/d'}


def test_what_a_cluster_sets_for_pip_leads_nothing_out_of_the_environment(tmp_path: Path) -> None:
    program(
        tmp_path / 'bin',
        'python',
        'env | grep -E "^(PIP_(TARGET|PREFIX|USER)|PYTHON(WARNINGS|PATH|HOME))=." >&2',
    )
    script = f'venv={tmp_path}; with_progress() {{ "${{@:4}}"; }}; pip_install 1 two'
    theirs = {'PIP_TARGET': '/a', 'PIP_PREFIX': '/b', 'PIP_USER': '1', **OF_ANOTHER_PYTHON}
    assert sourced(script, **theirs).stderr == 'PIP_USER=0\n'


def test_what_leaves_a_part_of_packages_out_is_not_for_the_environment(tmp_path: Path) -> None:
    settings = '[install]\nignore-installed = true\nrequire-hashes = true\nuser = true\n'
    (tmp_path / 'pip.conf').write_text(settings)
    script = f'venv={sys.prefix} setup_log=/dev/null; with_progress() {{ "${{@:4}}"; }}'
    script += '; rm() { :; }; mkdir() { :; }; pip_install 1 --no-index pip'
    theirs = {'PIP_CONFIG_FILE': str(tmp_path / 'pip.conf'), 'PIP_NO_DEPENDENCIES': 'True'}
    done = sourced(script, **theirs, PIP_DRY_RUN='1')
    assert 'Requirement already satisfied: pip in ' in done.stdout, done


def test_what_is_for_another_python_is_not_for_a_set_up(tmp_path: Path) -> None:
    (tmp_path / '.lab.lock').touch()
    steps = 'check_space make_venv compile_modules make_interfaces'
    no_steps = f'for step in {steps}; do eval "$step() {{ :; }}"; done'
    seen = 'with_me() { env | grep -E "^PYTHON(WARNINGS|PATH|HOME)=." >&3; echo step >&3; }'
    program(tmp_path / 'bin', 'python', 'true')
    script = f'venv={tmp_path} root={tmp_path} setup_log={tmp_path}/log; {no_steps}; {seen}'
    script += '; with_progress() { with_me; }'
    done = sourced(f'{script}; exec 3>&1; set +e; set_up pip python3 key', **OF_ANOTHER_PYTHON)
    assert set(done.stdout.splitlines()) == {'step'}, done


def test_what_a_killed_pip_has_downloaded_is_removed_by_the_next(tmp_path: Path) -> None:
    pip = 'test ! -e $TMPDIR/file && touch $TMPDIR/file && echo $TMPDIR >&2'
    program(tmp_path / 'bin', 'python', pip)
    script = f'venv={tmp_path}; with_progress() {{ "${{@:4}}"; }}; pip_install 1 two'
    (tmp_path / 'tmp').mkdir()
    (tmp_path / 'tmp' / 'file').touch()
    assert sourced(script).stderr == f'{tmp_path}/tmp\n'
    assert not (tmp_path / 'tmp').exists()


def test_a_folder_of_logs_that_cannot_be_written_is_refused() -> None:
    refused(sourced('choose_log_folder', ROS_LOG_DIR='/proc/none'), 'logs in /proc/none, which')
    refused(sourced('choose_log_folder', ROS_HOME='/proc/none'), 'logs in /proc/none/log, which')


@pytest.mark.parametrize('name', ['a clone', 'l' * 110])
def test_a_folder_in_place_of_the_link_to_a_clone_is_left(tmp_path: Path, name: str) -> None:
    root, cache = tmp_path / name, tmp_path / 'cache'
    root.mkdir()
    text = (ROOT / 'lab').read_text()
    function = text[text.index('plain_way() {') :].partition('\n}\n')[0]
    command = ['bash', '-c', f'{function}\n}}\nroot=$0; plain_way', str(root)]
    environment = {**os.environ, 'XDG_CACHE_HOME': str(cache)}

    def way() -> Path:
        return Path(subprocess.check_output(command, env=environment, text=True).strip())

    theirs = way()
    assert (theirs.parent, theirs.samefile(root)) == (cache, True)
    assert way() == theirs
    theirs.unlink()
    theirs.mkdir()
    ours = way()
    try:
        assert ours.samefile(root)
        assert ours != theirs
    finally:
        ours.unlink()


def test_another_ros_than_jazzy_is_refused(clone: Path) -> None:
    done = lab(clone, 'exec', 'true', ROS_DISTRO='humble', AMENT_PREFIX_PATH='/opt/ros/humble')
    refused(done, 'humble', 'ROS 2 Jazzy', 'source')


def test_an_old_python_and_one_that_is_not_there_are_refused(clone: Path, tmp_path: Path) -> None:
    program(tmp_path / 'bin', 'old', '[ "$1" = --version ] && echo Python 3.8.18 || echo 308')
    done = lab(clone, 'exec', 'true', PYTHON=str(tmp_path / 'bin' / 'old'))
    refused(done, 'Python 3.8.18', '3.10', 'PYTHON=')
    program(
        tmp_path / 'bin', 'older', '[ "$1" = --version ] && echo Python 2.7.18 >&2 || echo 207'
    )
    done = lab(clone, 'exec', 'true', PYTHON=str(tmp_path / 'bin' / 'older'))
    refused(done, 'Python 2.7.18 found', '3.10')
    gone = str(tmp_path / 'bin' / 'gone')
    refused(lab(clone, 'exec', 'true', PYTHON=gone), f'no {gone} found', '3.10')


def test_a_python_that_cannot_start_is_told_in_its_own_words(clone: Path) -> None:
    done = lab(clone, 'exec', 'true', PYTHONHASHSEED='any')
    refused(done, 'does not start here: Fatal Python error', 'PYTHONHASHSEED must be "random"')


@pytest.mark.parametrize('has_rclpy', [True, False])
def test_a_sourced_ros_gets_the_python_that_has_rclpy(
    clone: Path, tmp_path: Path, *, has_rclpy: bool
) -> None:
    path = program(tmp_path / 'bin', 'python3', 'exit 1')  # of another version, say
    (tmp_path / 'rclpy.py').write_text('' if has_rclpy else 'raise ImportError')
    here = tmp_path / 'here'  # a folder that somebody has handed in
    here.mkdir()
    if PYTHON_CAN_BE_TOLD:  # that of Jazzy is 3.12
        (here / 'rclpy.py').write_text('raise ImportError')
    sourced = {'ROS_DISTRO': 'jazzy', 'AMENT_PREFIX_PATH': '/opt/ros/jazzy', 'PATH': path}
    offline = {'PIP_INDEX_URL': NOBODY, 'PIP_CONFIG_FILE': os.devnull}
    given = {'PYTHONPATH': str(tmp_path), **sourced, **offline}
    done = lab(clone, 'exec', 'true', called_from=str(here), **given)
    if has_rclpy:
        refused(done, 'no network')
    else:
        refused(done, 'no Python on PATH can import rclpy', 'PYTHON=')


@pytest.mark.parametrize(
    ('ros', 'range_before', 'range_now'),
    [
        ('pip', '', 'LOCALHOST'),
        ('pip', 'SUBNET', 'SUBNET'),
        ('sourced', 'SUBNET', 'LOCALHOST'),
        ('sourced', 'SYSTEM_DEFAULT', 'SYSTEM_DEFAULT'),
    ],
)
def test_only_a_range_of_the_users_own_goes_beyond_this_machine(
    ros: str, range_before: str, range_now: str
) -> None:
    told = {'HUSKY_LAB_ROS': ros, 'ROS_AUTOMATIC_DISCOVERY_RANGE': range_before}
    script = 'source "$0" help >/dev/null; choose_range; echo "$ROS_AUTOMATIC_DISCOVERY_RANGE"'
    done = subprocess.run(
        ['bash', '-c', script, ROOT / 'lab'],
        env={**plain_environment(), **told},
        capture_output=True,
        text=True,
    )
    assert done.stdout.strip() == range_now, done.stderr


def test_a_new_waypoint_file_builds_the_package_that_installs_it(clone: Path) -> None:
    (clone / 'colcon.meta').touch()
    for folder in ('husky_sim', 'husky_driver', 'husky_view'):
        (clone / 'src' / folder).mkdir()
        (clone / 'src' / folder / 'package.xml').touch()
    for folder in ('config', 'worlds', '.venv'):
        (clone / folder).mkdir()
    (clone / '.venv' / '.ready').touch()
    script = 'source "$0" help >/dev/null; cd "$root/src"; for p in *; do package_key $p; done'
    packages = sorted(folder.name for folder in (clone / 'src').iterdir())

    def keys() -> list[str]:
        done = subprocess.run(
            ['bash', '-c', script, clone / 'lab'], capture_output=True, text=True
        )
        return done.stdout.split()

    before = keys()
    (clone / 'config' / 'my_path.yaml').touch()
    now = keys()
    changed = [package for package, a, b in zip(packages, before, now, strict=True) if a != b]
    assert changed == ['husky_driver']


def test_a_clone_that_was_moved_or_copied_is_built_again(clone: Path, tmp_path: Path) -> None:
    shutil.copytree(ROOT / 'src' / 'topic_demo', clone / 'src' / 'topic_demo')
    (clone / 'colcon.meta').touch()
    links = ('package.xml', '../ament_index/resource_index/packages/topic_demo')

    def sources(root: Path) -> list[Path]:
        """Build, and return what is installed as links."""
        script = f'source "$0" help >/dev/null; venv={sys.prefix}; build {root.name}'
        done = subprocess.run(['bash', '-c', script, root / 'lab'], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        share = root / 'install' / 'topic_demo' / 'share' / 'topic_demo'
        return [(share / link).resolve().relative_to(root) for link in links]

    expected = [Path('src/topic_demo/package.xml'), Path('src/topic_demo/resource/topic_demo')]
    assert sources(clone) == expected
    (clone / 'install' / 'topic_demo' / '.built').unlink()  # as by a set-up in another place
    assert sources(shutil.copytree(clone, tmp_path / 'copied', symlinks=True)) == expected
    assert sources(clone.rename(tmp_path / 'moved')) == expected


def test_a_disk_that_is_full_in_a_build_is_said_in_a_line(clone: Path) -> None:
    shutil.copytree(ROOT / 'src' / 'topic_demo', clone / 'src' / 'topic_demo')
    (clone / 'colcon.meta').touch()
    build = f'source "$0" help >/dev/null; venv={sys.prefix}; build key'
    full = 'mkdir "$1" && mount -t tmpfs -o size=16k none "$1" && exec bash -c "$2" "$0"'
    places = (str(clone / 'lab'), str(clone / 'install'))
    command = ['unshare', '--map-root-user', '--mount', 'bash', '-c', full, *places, build]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, 'full: the build' in done.stderr.splitlines()[-1]) == (2, True), done


def test_a_terminal_in_another_language_sets_nothing_up_anew(tmp_path: Path) -> None:
    # As one that sorts otherwise; which languages are there differs from machine to machine.
    text = 'exec $(PATH=${PATH#*:} command -v sort) $([ "$LC_ALL" = C ] || echo -r) "$@"'
    path = program(tmp_path, 'sort', text)
    script = f'source "$0" help >/dev/null; venv={sys.prefix}; build_key; setup_key pip python3 3'
    keys = [
        subprocess.run(
            ['bash', '-c', script, ROOT / 'lab'],
            env={**plain_environment(), 'PATH': path, 'LC_ALL': language},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for language in ('C', 'de_DE.UTF-8')
    ]
    assert keys[0] == keys[1] != ''


def test_a_user_without_a_home_can_build() -> None:
    somebody = ['unshare', '--user', '--map-user=12345', 'env', '-u', 'HOME']
    if subprocess.run([*somebody, 'true'], capture_output=True).returncode != 0:
        pytest.skip('nobody else can be made here')
    build = f'source "$0" help >/dev/null; venv={sys.prefix}; enter_venv pip'
    script = f'{build}; colcon --log-base /dev/null list --names-only --base-paths "$root/src"'
    command = [*somebody, 'bash', '-c', script, str(ROOT / 'lab')]
    done = subprocess.run(command, env=plain_environment(), capture_output=True, text=True)
    assert 'husky_sim' in done.stdout.split(), done.stderr


def test_what_python_compiles_sets_nothing_up_anew(clone: Path) -> None:
    examples = clone / 'underlay' / 'launch_testing' / 'prefix' / 'share' / 'launch_testing'
    script = 'source "$0" help >/dev/null; setup_key pip python3 3.11'

    def key() -> str:
        done = subprocess.run(
            ['bash', '-c', script, clone / 'lab'], capture_output=True, text=True, check=True
        )
        return done.stdout

    before = key()
    (examples / '__pycache__').mkdir()
    (examples / '__pycache__' / 'examples.pyc').write_text('compiled')
    assert key() == before
    (examples / 'package.xml').write_text('<package/>')
    assert key() != before, 'a change of what is installed sets up anew'


def test_a_platform_without_wheels_is_told_what_to_do(clone: Path, tmp_path: Path) -> None:
    path = program(tmp_path / 'bin', 'uname', 'echo Darwin arm64')
    refused(lab(clone, 'exec', 'true', PATH=path), 'Darwin arm64', 'RoboStack', 'source')


def test_a_full_disk_is_said_before_anything_is_made(clone: Path, tmp_path: Path) -> None:
    path = program(tmp_path / 'bin', 'df', 'printf "h\\nfs 1 1 90000 1%% /\\n"')
    refused(lab(clone, 'exec', 'true', PATH=path), 'disk is full', '87 MB', 'free some space')
    assert not (clone / '.venv').exists()


def test_a_folder_without_links_or_programs_is_refused(clone: Path, tmp_path: Path) -> None:
    path = program(tmp_path / 'bin', 'ln', 'echo "ln: Operation not permitted" >&2; exit 1')
    refused(lab(clone, 'exec', 'true', PATH=path), 'no symbolic links in', 'into your home')
    stick = 'mkdir "$1" && mount -t tmpfs -o noexec none "$1" && cp -r "$0" "$1"/clone && exec '
    stick += 'bash "$1"/clone/lab exec true'
    command = ['unshare', '--map-root-user', '--mount', 'bash', '-c', stick, str(clone)]
    command.append(str(tmp_path / 'stick'))
    done = subprocess.run(command, env=plain_environment(), capture_output=True, text=True)
    refused(done, 'no program may run in', 'into your home')
    assert not (clone / '.venv').exists()


def test_a_terminal_with_few_letters_is_no_matter_to_a_set_up(clone: Path, tmp_path: Path) -> None:
    told = tmp_path / 'told'
    folder = tmp_path / 'bin'
    path = program(folder, 'df', f'locale charmap >{told}; printf "h\\nfs 1 1 90000 1%% /\\n"')
    refused(lab(clone, 'exec', 'true', PATH=path, LC_ALL='C'), 'disk is full')
    assert told.read_text() == 'UTF-8\n'


@dataclass(frozen=True)
class InVain:
    """What `./lab` said that was called in a folder with modules of pip's names."""

    no_index: subprocess.CompletedProcess[str]
    finds_nothing: subprocess.CompletedProcess[str]
    ran: Path  # is there if one of the modules was run


@pytest.fixture(scope='module')
def set_up_in_vain(tmp_path_factory: pytest.TempPathFactory) -> InVain:
    """Set up twice, the first time after an interrupted set-up, without packages to install."""
    folder = tmp_path_factory.mktemp('in_vain')
    clone, here = bare_clone(folder / 'clone'), folder / 'here'
    (clone / '.venv' / 'bin').mkdir(parents=True)
    (clone / '.venv' / 'bin' / 'python').symlink_to('/nonexistent/python')
    here.mkdir()
    if PYTHON_CAN_BE_TOLD:
        for module in ('venv', 'pip', 'ensurepip', 'random'):
            (here / f'{module}.py').write_text(f'open({str(folder / "ran")!r}, "w")\n')
    no_index, finds_nothing = (
        lab(clone, 'exec', 'true', called_from=str(here), PIP_CONFIG_FILE=os.devnull, **settings)
        for settings in ({'PIP_INDEX_URL': NOBODY}, {'PIP_NO_INDEX': '1'})
    )
    return InVain(no_index, finds_nothing, folder / 'ran')


def test_no_network_is_said_also_after_an_interrupted_set_up(set_up_in_vain: InVain) -> None:
    refused(set_up_in_vain.no_index, 'no network', 'call ./lab again')
    words = ('pip finds no ros-rclpy', 'PIP_INDEX_URL to one and PIP_NO_INDEX to 0')
    refused(set_up_in_vain.finds_nothing, *words)


@pytest.mark.skipif(not PYTHON_CAN_BE_TOLD, reason='Python cannot be told before 3.11')
def test_no_module_of_the_folder_it_is_called_from_is_run(set_up_in_vain: InVain) -> None:
    refused(set_up_in_vain.finds_nothing, 'pip finds no ros-rclpy')
    assert not set_up_in_vain.ran.exists()


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (['fly'], "unknown word 'fly'"),
        (['drive', '--quick'], "'--quick'"),
        (['drive', '--report'], '--report needs a value'),
        (['exec'], 'exec needs a command'),
        (['exec', '--help'], 'exec needs a command'),
        (['shell', '-c', 'id'], "shell takes no '-c'; ./lab exec runs a command"),
    ],
)
def test_a_wrong_word_is_refused_before_anything_is_set_up(
    script_alone: Path, words: list[str], said: str
) -> None:
    refused(lab(script_alone, *words), said)
    assert not (script_alone / '.venv').exists()
