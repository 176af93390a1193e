# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of the frames, from real broadcasters: in files and live on a page."""

from __future__ import annotations

from collections.abc import Iterator
import json
from pathlib import Path
import re
import signal
import subprocess
import time
from typing import Any
from urllib.request import urlopen
from xml.etree import ElementTree

from geometry_msgs.msg import TransformStamped
from hypothesis import assume, given, strategies
from playpen_testing import chromium
from playpen_testing.browser import errors, start_browser
from playpen_testing.here import run_here
from playpen_testing.processes import find_line
from playpen_testing.spinning import SpunNodes
from playpen_testing.transforms import buffer_of, transform
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from rqt_graph.picture import draw_svg
from rqt_graph.selection import Arrow, Drawing, Kind, Shape
import tf2_ros
from tf2_tools.frames import generate_dot, read_frames
from tf2_tools.frames_page import FramesPage

SVG = '{http://www.w3.org/2000/svg}'
COMMAND = ('ros2', 'run', 'tf2_tools', 'view_frames')
FRAMES = {'odom', 'base', 'laser'}
ARROWS = {'odom>base', 'base>laser'}
LINK = '<TABLE HREF="javascript:alert(1)"><TR><TD>press</TD></TR></TABLE>'


class Sender(Node):
    """Moves `base` in `odom`, and has `laser` fixed on it."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__('sender', **arguments)
        self._moving = tf2_ros.TransformBroadcaster(self)
        self._fixed = tf2_ros.StaticTransformBroadcaster(self)
        self.fix('laser')
        self.timer = self.create_timer(0.05, self._move)

    def fix(self, child: str) -> None:
        self._fixed.sendTransform(self._transform('base', child))

    def _move(self) -> None:
        self._moving.sendTransform(self._transform('odom', 'base'))

    def _transform(self, parent: str, child: str) -> TransformStamped:
        message = TransformStamped(child_frame_id=child)
        message.header.frame_id = parent
        message.header.stamp = self.get_clock().now().to_msg()
        return message


@pytest.fixture
def sender(domain: int) -> Iterator[Sender]:
    with SpunNodes(domain) as nodes:
        yield nodes.start(Sender)


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    answer = subprocess.run([*COMMAND, *arguments], capture_output=True, text=True, timeout=30)
    assert 'Traceback' not in answer.stderr, answer.stderr
    return answer


@pytest.mark.usefixtures('sender')
def test_it_writes_a_tree_for_graphviz_and_a_pdf(tmp_path: Path) -> None:
    tree = ''

    def is_whole() -> bool:  # on a busy machine it may hear too little in its time
        nonlocal tree
        answer = run('--wait-time', '1.5', '--output', 'tree')
        assert answer.returncode == 0, answer.stderr
        said = [line.split('[view_frames]: ')[-1] for line in answer.stderr.splitlines()]
        assert said[0] == 'Listening to tf data for 1.5 seconds...'
        assert said[1] == 'Generating graph...'
        assert said[2].startswith('Result:tf2_msgs.srv.FrameGraph_Response(frame_yaml=')
        assert said[3] == 'Exporting graph in tree.pdf file...'
        tree = (tmp_path / 'tree.gv').read_text()
        found = re.findall(r'"(\w+)" -> "(\w+)"\[label=" Broadcaster: default_authority', tree)
        rates = re.findall(r'"base"\[label=" .*?Average rate: ([0-9.]+)', tree)
        arrows = {'>'.join(arrow) for arrow in found}
        return arrows == ARROWS and 15.0 < float(rates[0]) < 30.0

    wait_until(is_whole, timeout_sec=40.0, what=lambda: f'both arrows, base at 20 Hz: {tree}')
    assert '\n}->"odom";\n}' in tree
    assert (tmp_path / 'tree.pdf').read_bytes().startswith(b'%PDF-')


@pytest.mark.usefixtures('domain')
def test_without_transforms_the_files_say_so(tmp_path: Path) -> None:
    assert run('-t', '0.1').returncode == 0
    tree, pdf = sorted(tmp_path.glob('frames_*'))
    assert re.fullmatch(r'frames_\d{4}-\d\d-\d\d_\d\d\.\d\d\.\d\d\.gv', tree.name)
    assert tree.read_text() == 'digraph G { "No tf data received" }'
    assert pdf.suffix == '.pdf'


def test_a_loop_and_names_of_any_kind_are_drawn() -> None:
    text = ''.join(
        f"{name}: \n  parent: '{parent}'\n  broadcaster: 'b'\n  rate: 1.000\n"
        '  most_recent_transform: 1.000000\n  oldest_transform: 0.500000\n'
        '  buffer_length: 0.500\n'
        for name, parent in (('a', '7'), ('7', 'a'))
    )
    assert generate_dot(read_frames(text), 2.5).splitlines()[-2:] == ['}', '}']
    assert '"7" -> "a"[label=" Broadcaster: b\\nAverage rate: 1.0\\n' in generate_dot(
        read_frames(text), 2.5
    )


@given(strategies.text(min_size=1), strategies.text(min_size=1))
def test_a_name_of_any_letters_is_read_back(parent: str, child: str) -> None:
    assume(parent != child and not parent.startswith('/') and not child.startswith('/'))
    (frame,) = read_frames(buffer_of(transform(parent, child, 1.0)).all_frames_as_yaml())
    assert (frame.parent, frame.name) == (parent, child)


@pytest.mark.parametrize('name', ["'map'", '"map"', 'no', '007', 'x: y', 'tag36h11:0', '[a', '%a'])
def test_a_name_with_a_sense_in_yaml_or_graphviz_is_drawn(name: str) -> None:
    assert words_of_node(name) == [name]


@pytest.mark.parametrize(
    'name',
    ['<b>', '<<x>>', '\\N', 'a\\nb', '&amp;', f'<{LINK}>', f'a{LINK}', '<IMG SRC="a.png"/>'],
)
def test_a_name_is_words_to_graphviz_and_no_html(name: str) -> None:
    assert words_of_node(name) == [name]
    shape = Shape(Kind.NODE, name, f'<{LINK}>')
    drawn = draw_svg(Drawing((shape,), (Arrow(shape.key, shape.key),))).decode()
    assert words_of(drawn, shape.key) == [name]
    assert ids(drawn, 'edge') == {f'{shape.key}>{shape.key}'}


def words_of_node(name: str) -> list[str | None]:
    """Return what the page writes into the shape of a frame."""
    buffer = buffer_of(transform('root', name, 1.0))
    svg = FramesPage(buffer.all_frames_as_yaml, 0).picture({}, 'svg').decode()
    assert ids(svg, 'node') == {'root', name}
    assert ids(svg, 'edge') == {f'root>{name}'}
    return words_of(svg, name)


def words_of(svg: str, key: str) -> list[str | None]:
    (shape,) = (each for each in ElementTree.fromstring(svg).iter() if each.get('id') == key)
    assert 'href="javascript' not in svg
    return [text.text for text in shape.iter(f'{SVG}text')]


def events(address: str) -> Iterator[dict[str, Any]]:
    with urlopen(address + 'events', timeout=20) as answer:
        for line in answer:
            if line.startswith(b'data: '):
                yield json.loads(line.removeprefix(b'data: '))


def ids(svg: str, kind: str) -> set[str]:
    return {
        group.attrib['id']
        for group in ElementTree.fromstring(svg).iter(f'{SVG}g')
        if group.attrib.get('class') == kind
    }


def wait_for_event(news: Iterator[dict[str, Any]], fact: Any, timeout_sec: float = 20.0) -> str:
    start = time.monotonic()
    for event in news:
        assert time.monotonic() - start < timeout_sec, f'the last event is {event}'
        if fact(event):
            break
    return str(event['svg'])


def test_the_page_follows_what_is_sent(processes: Any, sender: Sender) -> None:
    page = processes.start(*COMMAND, '--live')
    address = find_line(page.stdout, r'http://127\.0\.0\.1:\d+/')[0]
    assert '<title>view_frames</title>' in urlopen(address, timeout=10).read().decode()
    news = events(address)
    svg = wait_for_event(
        news,
        lambda event: (
            ids(event['svg'], 'edge') == ARROWS
            and re.search('> (1[5-9]|2[0-5]) Hz<', event['svg'])
        ),
    )
    assert ids(svg, 'node') == FRAMES
    assert '> static<' in svg
    sender.fix('imu')
    wait_for_event(news, lambda event: event['frames'] == 4)
    sender.timer.cancel()
    svg = wait_for_event(news, lambda event: 'no newer transform' in event['svg'])
    assert ids(svg, 'node') == {*FRAMES, 'imu'}
    assert urlopen(address + 'graph.png', timeout=20).read().startswith(b'\x89PNG')
    assert ids(urlopen(address + 'graph.svg', timeout=20).read().decode(), 'edge') == {
        *ARROWS,
        'base>imu',
    }


@pytest.mark.usefixtures('sender')
def test_the_page_in_a_browser_lights_what_hangs_on_a_frame(processes: Any) -> None:
    server = processes.start(*COMMAND, '--live')
    address = find_line(server.stdout, r'http://127\.0\.0\.1:\d+/')[0]
    with start_browser(chromium.find_or_install()) as browser:
        page = browser.new_page()
        page.goto(address)
        page.locator('[id="laser"]').hover()
        keys = page.locator('#graph.lit .on').evaluate_all('on => on.map((part) => part.id)')
        assert set(keys) == {'base', 'base>laser', 'laser'}
        page.get_by_text('3 frames').wait_for()
        assert errors(page) == []


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.usefixtures('sender')
def test_a_signal_ends_the_page_within_two_seconds(processes: Any, number: signal.Signals) -> None:
    page = processes.start(*COMMAND, '--live', ready='http://')
    start = time.monotonic()
    page.send_signal(number)
    output, _ = page.communicate(timeout=10)
    assert (output, page.returncode) == ('', 0), output
    assert time.monotonic() - start < 2.0


@pytest.mark.usefixtures('domain')
def test_ctrl_c_while_it_listens_writes_nothing(processes: Any, tmp_path: Path) -> None:
    listening = processes.start(*COMMAND, ready='Listening to tf data for 5.0 seconds...')
    listening.send_signal(signal.SIGINT)
    output, _ = listening.communicate(timeout=2)
    assert ('Traceback' in output, listening.returncode) == (False, 130)
    assert list(tmp_path.glob('frames*')) == []


@pytest.mark.usefixtures('domain')
def test_bad_arguments_are_refused(capfd: pytest.CaptureFixture[str]) -> None:
    bad = {
        ('-t', 'long'): "'long' is refused: it must be seconds, 0 or more",
        ('-t=-1',): "'-1' is refused",
        ('-o', 'no/tree'): "there is no folder 'no'; make it first",
        ('--live', '--port', 'abc'): 'a port is from 1 to 65535',
    }
    ended = {words: run_here(capfd, 'tf2_tools.view_frames', *words) for words in bad}
    for words, each in ended.items():
        assert (each.status, bad[words] in each.err) == (2, True), (words, each)
    answer = run('-t', 'long')
    assert (answer.returncode, answer.stderr) == (2, ended['-t', 'long'].err)
