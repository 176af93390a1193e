# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of the graph, with real nodes: in files and live on a page."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from http.client import HTTPConnection
import json
import os
from pathlib import Path
import signal
import subprocess
import sys
import time
from typing import Any
from urllib.parse import urlsplit
from urllib.request import urlopen
from xml.etree import ElementTree

from playpen_testing import chromium
from playpen_testing.browser import errors, hide, start_browser
from playpen_testing.here import run_here
from playpen_testing.processes import find_line
from playwright.sync_api import Browser
import pytest
from rqt_graph.feed import Feed

SVG = '{http://www.w3.org/2000/svg}'
NODE, TOPIC = f'{SVG}ellipse', f'{SVG}path'
TITLE = '{http://www.w3.org/1999/xlink}title'
NODE_FILL, TOPIC_FILL = (0xDB, 0xE9, 0xFB), (0xFD, 0xF1, 0xD3)


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    answer = subprocess.run(
        ['ros2', 'run', 'rqt_graph', 'rqt_graph', *arguments],
        capture_output=True,
        text=True,
        timeout=30,
        check=False,
    )
    assert 'Traceback' not in answer.stderr, answer.stderr
    return answer


@pytest.fixture
def draw_here(capfd: pytest.CaptureFixture[str]) -> Callable[..., None]:
    """Return a function that draws the graph in this process, which has loaded what it needs."""

    def draw(*words: str) -> None:
        drawn = run_here(capfd, 'rqt_graph.main', *words)
        assert drawn.status == 0, drawn.err

    return draw


def shapes(svg: str) -> dict[str, str]:
    """Return the tag of the outline of each shape, by its key."""
    return {
        group.attrib['id']: next(part.tag for part in group.iter() if part.tag in (NODE, TOPIC))
        for group in groups(svg, 'node')
        if group.attrib['id'].startswith(('node:', 'topic:'))
    }


def arrows(svg: str) -> set[tuple[str, ...]]:
    return {tuple(group.attrib['id'].split('>')) for group in groups(svg, 'edge')}


def groups(svg: str, kind: str) -> list[ElementTree.Element]:
    return [
        group
        for group in ElementTree.fromstring(svg).iter(f'{SVG}g')
        if kind in group.attrib.get('class', '').split()
    ]


TALK = {
    'node:/talker_1': NODE,
    'node:/talker_2': NODE,
    'node:/listener': NODE,
    'topic:/chatter': TOPIC,
}
TALK_ARROWS = {
    ('node:/talker_1', 'topic:/chatter'),
    ('node:/talker_2', 'topic:/chatter'),
    ('topic:/chatter', 'node:/listener'),
}

# What is lit while the pointer is over a shape: it, its arrows and what is at their other ends.
LIT = {
    'node:/talker_1': {'node:/talker_1', 'node:/talker_1>topic:/chatter', 'topic:/chatter'},
    'topic:/chatter': {*TALK, *('>'.join(arrow) for arrow in TALK_ARROWS)},
}


@pytest.fixture(scope='module')
def talk(shared_processes: Any) -> None:
    for kind, name in (('talker', 'talker_1'), ('talker', 'talker_2'), ('listener', 'listener')):
        shared_processes.node(kind, name)


@pytest.fixture(scope='module')
def address(talk: None, shared_processes: Any) -> str:
    """Start a page that shows who talks, and return its address."""
    del talk
    server = shared_processes.start('ros2', 'run', 'rqt_graph', 'rqt_graph')
    return str(find_line(server.stdout, r'http://127\.0\.0\.1:\d+/')[0])


@pytest.fixture(scope='module')
def browser() -> Iterator[Browser]:
    with start_browser(chromium.find_or_install()) as started:
        yield started


@pytest.mark.usefixtures('talk')
def test_svg_has_ellipses_for_nodes_boxes_for_topics_and_arrows(tmp_path: Path) -> None:
    file = tmp_path / 'graph.svg'
    answer = run('--output', str(file))
    assert (answer.returncode, answer.stdout) == (0, f'wrote {file}\n'), answer.stderr
    svg = file.read_text()
    assert shapes(svg) == TALK
    assert arrows(svg) == TALK_ARROWS


@pytest.mark.usefixtures('talk')
def test_png_is_a_picture_of_the_same(draw_here: Callable[..., None], tmp_path: Path) -> None:
    from matplotlib.image import imread

    draw_here('-o', str(tmp_path / 'graph.png'))
    pixels = imread(tmp_path / 'graph.png')
    height, width, _ = pixels.shape
    assert width > 2 * height > 100
    colours = {tuple(round(255 * value) for value in pixel[:3]) for pixel in pixels[height // 2]}
    assert {NODE_FILL, TOPIC_FILL, (255, 255, 255)} <= colours


def test_topics_of_one_side_are_drawn_only_in_the_view_of_all(
    processes: Any, draw_here: Callable[..., None], tmp_path: Path
) -> None:
    processes.node('latched', 'latched')
    drawn = {}
    for options in ((), ('--view', 'all'), ('--view', 'all', '--debug')):
        draw_here('-o', 'graph.svg', *options)
        drawn[options] = set(shapes((tmp_path / 'graph.svg').read_text()))
    active, everything, debug = drawn.values()
    assert active == {'node:/latched'}
    assert everything == {'node:/latched', 'topic:/latched'}
    assert everything | {'topic:/rosout', 'topic:/parameter_events'} <= debug


def test_a_topic_over_which_nothing_arrives_is_red_and_says_why(
    processes: Any, draw_here: Callable[..., None], tmp_path: Path
) -> None:
    processes.node('robot', 'robot')
    processes.node('stamped_driver', 'driver')
    draw_here('-o', 'graph.svg')
    svg = (tmp_path / 'graph.svg').read_text()
    (faulty,) = groups(svg, 'faulty')
    assert 'topic' in faulty.attrib['class'].split()
    (fault,) = (part.attrib[TITLE] for part in faulty.iter() if TITLE in part.attrib)
    assert '/driver publishes geometry_msgs/msg/TwistStamped' in fault


def test_two_nodes_of_one_name_are_one_red_ellipse(
    processes: Any, draw_here: Callable[..., None], tmp_path: Path
) -> None:
    for _ in range(2):
        processes.node('plain', 'same')
    draw_here('-o', 'graph.svg')
    svg = (tmp_path / 'graph.svg').read_text()
    assert shapes(svg) == {'node:/same': NODE}
    assert '2 nodes have this name' in svg


@pytest.mark.usefixtures('domain')
def test_bad_arguments_are_refused(capfd: pytest.CaptureFixture[str]) -> None:
    bad = {
        ('-o', 'graph.gif'): 'must end in .svg or .png',
        ('-o', 'no/graph.svg'): "there is no folder 'no'",
        ('--port', 'abc'): 'a port is from 1 to 65535',
        ('--view', 'some'): "invalid choice: 'some'",
    }
    ended = {words: run_here(capfd, 'rqt_graph.main', *words) for words in bad}
    for words, each in ended.items():
        assert each.status == 2, (words, each)
        assert bad[words] in each.err, words
    answer = run('-o', 'graph.gif')
    assert (answer.returncode, answer.stderr) == (2, ended['-o', 'graph.gif'].err)


@pytest.mark.usefixtures('domain')
def test_a_domain_without_nodes_has_a_picture_that_says_so(
    draw_here: Callable[..., None], tmp_path: Path
) -> None:
    draw_here('-o', 'empty.svg')
    assert 'No nodes are running' in (tmp_path / 'empty.svg').read_text()


@pytest.mark.usefixtures('domain')
@pytest.mark.parametrize(
    'words', [('rqt_graph', 'rqt_graph', '-o', 'graph.svg'), ('tf2_tools', 'view_frames')]
)
def test_a_system_without_a_library_is_told_what_to_install(
    words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # What the dynamic loader says there.
    why = 'libgobject-2.0.so.0: cannot open shared object file: No such file or directory'
    without = tmp_path / 'without'
    without.mkdir()
    (without / 'pygraphviz.py').write_text(f'raise ImportError({why!r})')
    monkeypatch.setenv('PYTHONPATH', str(without), prepend=os.pathsep)
    answer = subprocess.run(['ros2', 'run', *words], capture_output=True, text=True, timeout=30)
    assert answer.returncode == 1
    assert answer.stderr == (
        f'{words[1]}: Graphviz, which draws the picture, cannot be loaded ({why}): install what '
        'it needs (Ubuntu, Debian: sudo apt install libglib2.0-0 libxext6 libxrender1; Fedora: '
        'sudo dnf install glib2 libXext libXrender)\n'
    )
    assert not list(tmp_path.glob('*.*'))


@pytest.mark.usefixtures('domain')
def test_a_reading_that_fails_is_told_and_the_next_one_shown(
    capsys: pytest.CaptureFixture[str],
) -> None:
    found: list[Any] = ['first', OSError('too many'), OSError('too many'), 'second']

    def read() -> str | None:
        value = found.pop(0) if found else None
        if isinstance(value, OSError):
            raise value
        return value

    feed = Feed(read, period_sec=0.01)
    with feed.watching():
        assert feed.wait(0, 5.0) == (1, 'first')
        assert feed.wait(1, 5.0) == (2, 'second')
    assert capsys.readouterr().err == 'nothing newer is shown: OSError: too many\n'


def test_it_is_a_package_of_the_ament_prefix(ros2_here: Callable[..., Any]) -> None:
    def ros2(*words: str) -> str:
        answer = ros2_here('pkg', *words)
        assert answer.status == 0, answer.err
        return str(answer.out)

    assert 'rqt_graph' in ros2('list').split()
    assert ros2('executables', 'rqt_graph') == 'rqt_graph rqt_graph\n'
    assert Path(ros2('prefix', 'rqt_graph').strip(), 'lib/rqt_graph/rqt_graph').exists()
    assert ros2('xml', 'rqt_graph', '-t', 'license').split()[-1] == 'Apache-2.0'


def events(address: str) -> Generator[dict[str, Any], None, None]:
    with urlopen(address + 'events', timeout=20) as answer:
        for line in answer:
            if line.startswith(b'data: '):
                yield json.loads(line.removeprefix(b'data: '))


def test_the_page_shows_nodes_that_start_and_end(address: str, shared_processes: Any) -> None:
    assert '<title>rqt_graph</title>' in urlopen(address, timeout=10).read().decode()
    news = events(address)
    first = next(news)
    assert (shapes(first['svg']), arrows(first['svg'])) == (TALK, TALK_ARROWS)
    assert (first['nodes'], first['topics']) == (3, 1)
    third = shared_processes.node('talker', 'talker_3')
    _wait_for_event(news, lambda keys: 'node:/talker_3' in keys)
    third.send_signal(signal.SIGINT)
    _wait_for_event(news, lambda keys: 'node:/talker_3' not in keys)
    news.close()
    assert urlopen(address + 'graph.png', timeout=20).read().startswith(b'\x89PNG')
    assert set(shapes(urlopen(address + 'graph.svg', timeout=20).read().decode())) == set(TALK)


def test_the_page_answers_to_this_computer_alone(address: str) -> None:
    asked: tuple[tuple[dict[str, str], int], ...] = (
        ({}, 200),
        ({'Host': 'evil.example'}, 421),
        ({'Origin': 'http://evil.example'}, 403),
    )
    for headers, status in asked:
        connection = HTTPConnection(urlsplit(address).netloc, timeout=10.0)
        connection.request('GET', '/graph.svg', headers=headers)
        assert connection.getresponse().status == status, headers
        connection.close()


def test_the_page_lights_what_hangs_on_a_pointed_shape(address: str, browser: Browser) -> None:
    with browser.new_context() as one_browser:
        page = one_browser.new_page()
        page.goto(address)
        for shape, lit in LIT.items():
            page.locator(f'[id="{shape}"]').hover()
            keys = page.locator('#graph.lit .on').evaluate_all('on => on.map((part) => part.id)')
            assert set(keys) == lit, shape
        page.locator('h1').hover()
        assert page.locator('#graph.lit').count() == 0
        assert errors(page) == []


def test_the_page_asks_again_where_a_proxy_had_nobody_to_ask(
    address: str, browser: Browser
) -> None:
    with browser.new_context() as one_browser:
        page = one_browser.new_page()
        page.route('**/events*', lambda route: route.fulfill(status=502))
        page.goto(address)
        for _ in range(2):
            page.wait_for_event('response', lambda answer: answer.status == 502, timeout=20_000)
        page.unroute('**/events*')
        page.locator('[id="topic:/chatter"]').wait_for()


def test_tabs_behind_another_leave_their_connection_to_it(address: str, browser: Browser) -> None:
    with browser.new_context() as one_browser:  # with six connections
        tabs = [one_browser.new_page() for _ in range(8)]
        for tab in tabs:
            tab.goto(address)
            tab.locator('[id="topic:/chatter"]').wait_for()
            hide(tab)
        tabs[0].evaluate("graph.innerHTML = ''")
        hide(tabs[0], hidden=False)
        tabs[0].locator('[id="topic:/chatter"]').wait_for()


def _wait_for_event(news: Iterator[dict[str, Any]], fact: Any) -> None:
    start = time.monotonic()
    for event in news:
        if fact(shapes(event['svg'])):
            break
    assert time.monotonic() - start < 10.0


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.usefixtures('domain')
def test_a_signal_ends_the_page_within_two_seconds(processes: Any, number: signal.Signals) -> None:
    page = processes.start(sys.executable, '-m', 'rqt_graph.main', ready='http://')
    start = time.monotonic()
    page.send_signal(number)
    assert page.wait(timeout=10) == 0
    assert time.monotonic() - start < 2.0


@pytest.mark.usefixtures('domain')
def test_a_taken_port_is_refused_in_one_line(processes: Any) -> None:
    page = processes.start(sys.executable, '-m', 'rqt_graph.main')
    assert page.stdout is not None
    port = find_line(page.stdout, r'http://.*:(\d+)/')[1]
    answer = run('--port', port)
    assert answer.returncode == 1
    assert answer.stderr == f'rqt_graph: --port {port} is taken: leave it out to get a free one\n'
