# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The live view in a real browser: what is to be seen, and that every control acts."""

from collections.abc import Iterator
from contextlib import suppress
import math
import subprocess
import sys
import time

from geometry_msgs.msg import Point, Pose, PoseArray, PoseStamped
from husky_sim.scene_topic import QOS as SCENE_QOS
from husky_view.gate.front_page import NO_WEBGL
from husky_view.live.links import LATCHED
from nav_msgs.msg import Path
from playpen_testing import chromium
from playpen_testing.browser import (
    button,
    errors,
    FLAGS,
    launch,
    number,
    open_editor,
    places,
    wait_for,
)
from playpen_testing.spinning import do_in_thread_of
from playpen_testing.view_lab import COMMANDS, Lab, view_lab
from playpen_testing.waiting import wait_until
from playwright.sync_api import Browser, Error, expect, Page
import pytest
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import Bool, Float64MultiArray, UInt32

PHONE = (390, 844)
FACTOR = "parseFloat((document.querySelector('[data-number=factor]') || {}).textContent)"
TROUBLE = "(document.querySelector('[data-trouble]') || {textContent: ''}).textContent"
SCENE = "document.querySelector('canvas[data-engine]')"
PANEL = """(() => {
  let e = document.querySelector('.husky-page');
  while (getComputedStyle(e).position !== 'fixed') e = e.parentElement;
  const r = e.getBoundingClientRect();
  return [r.left, r.top, r.width];
})()"""


# Notes how much each frame draws, without drawing it.
COUNT_DRAWN = """
window.drawn = [];
let count = 0;
for (const name of ['drawElements', 'drawElementsInstanced'])
  WebGL2RenderingContext.prototype[name] = () => { count += 1; };
const soon = window.requestAnimationFrame.bind(window);
window.requestAnimationFrame = (draw) => soon((now) => {
  count = 0;
  draw(now);
  // Before anything has come, viser draws its own axes.
  const sent = Object.keys(window.__viserSceneTree?.getState() ?? {}).length > 2;
  if (count > 1 && sent) window.drawn.push(count);
});
"""


@pytest.fixture(scope='module')
def lab(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    with view_lab(tmp_path_factory.mktemp('view'), browser) as started:
        yield started


@pytest.fixture(scope='module')
def page(lab: Lab) -> Page:
    return lab.open()


@pytest.mark.timeout(120)
def test_the_page_shows_passing_time_and_no_legend_of_nothing(page: Page) -> None:
    expect(number(page, 'time')).not_to_have_text(number(page, 'time').inner_text())
    expect(page.locator('.husky-legend')).to_have_text('')
    assert errors(page) == []


@pytest.mark.timeout(120)
def test_the_first_picture_of_the_scene_is_whole_but_for_its_letters(lab: Lab) -> None:
    page = lab.browser.new_page()
    page.add_init_script(COUNT_DRAWN)
    page.goto(lab.address, wait_until='commit')
    wait_for(page, 'window.drawn.length > 20')
    drawn = page.evaluate('window.drawn')
    assert drawn[0] >= max(drawn) - 3, f'{drawn}: parts came later'
    assert drawn[0] < 30, 'it takes long where a processor draws'
    page.close()


@pytest.mark.timeout(120)
def test_a_browser_that_draws_nothing_in_3d_is_told_what_to_do(lab: Lab) -> None:
    program = chromium.find_or_install()
    with launch(lab.browser.browser_type, program, [*FLAGS, '--disable-3d-apis']) as browser:
        page = browser.new_page()
        page.goto(lab.address, wait_until='commit')
        expect(page.get_by_text(NO_WEBGL)).to_be_visible(timeout=30_000)


@pytest.mark.timeout(120)
def test_no_button_moves_when_time_is_paused(page: Page) -> None:
    wait_for(page, f'{FACTOR} > 0.5')
    before = places(page)
    button(page, 'Pause').click()
    expect(number(page, 'factor')).to_have_text('paused')
    while_paused = places(page)
    button(page, 'Resume').click()
    expect(number(page, 'factor')).not_to_have_text('paused')
    assert {'STOP', 'Plots over the time', 'Waypoints'} <= before.keys()
    assert while_paused == {{'Pause': 'Resume'}.get(k, k): v for k, v in before.items()}


@pytest.mark.timeout(120)
def test_pause_step_reset_and_speed_act_on_the_simulation(lab: Lab, page: Page) -> None:
    button(page, 'Pause').click()
    button(page, 'Resume').wait_for()
    stands_since = [lab.time_sec, time.monotonic()]

    def stands() -> bool:
        if lab.time_sec != stands_since[0]:  # messages of before may still be on their way
            stands_since[:] = [lab.time_sec, time.monotonic()]
        return time.monotonic() > stands_since[1] + 0.5

    wait_until(stands, timeout_sec=15.0, what='half a second in which time stands')
    paused_sec = lab.time_sec
    button(page, 'Step').click()
    wait_until(
        lambda: abs(lab.time_sec - paused_sec - 0.02) < 1e-6,
        timeout_sec=15.0,
        what=lambda: f'one period after {paused_sec}; it is {lab.time_sec}',
    )
    button(page, 'Resume').click()
    wait_until(lambda: lab.time_sec > paused_sec + 0.2, timeout_sec=15.0, what='time that goes on')
    button(page, 'Reset').click()
    wait_until(lambda: lab.time_sec < paused_sec, timeout_sec=15.0, what='a new beginning')
    expect(button(page, '1×')).to_have_attribute('aria-pressed', 'true')
    button(page, '5×').click()
    wait_for(page, f'{FACTOR} > 1.5')
    expect(button(page, '5×')).to_have_attribute('aria-pressed', 'true')
    expect(button(page, '1×')).to_have_attribute('aria-pressed', 'false')
    button(page, '1×').click()
    wait_for(page, f'{FACTOR} < 1.2')


@pytest.mark.timeout(120)
def test_an_arrow_key_drives_while_it_is_held(lab: Lab, page: Page) -> None:
    page.keyboard.down('ArrowUp')
    wait_until(lab.moves, timeout_sec=10.0, what='a robot that moves')
    page.keyboard.up('ArrowUp')
    wait_until(lab.stands, timeout_sec=10.0, what='a robot that stands')
    heard = lab.listener.heard[COMMANDS]
    assert heard[-1].linear.x == 0.0
    silent_since = [len(heard), lab.time_sec]

    def silent() -> bool:
        if len(heard) != silent_since[0]:  # the last zeros may still be on their way
            silent_since[:] = [len(heard), lab.time_sec]
        return lab.time_sec > silent_since[1] + 0.5

    wait_until(silent, timeout_sec=15.0, what='half a second without a command: nobody drives')
    assert heard[-1].linear.x == 0.0


@pytest.mark.timeout(120)
def test_the_arrow_keys_drive_when_a_box_was_ticked(lab: Lab) -> None:
    page = lab.open()
    open_editor(page)
    page.get_by_label('Back to the first (loop)').click()
    page.keyboard.down('ArrowUp')
    wait_until(lab.moves, timeout_sec=10.0, what='a robot that moves')
    page.keyboard.up('ArrowUp')
    wait_until(lab.stands, timeout_sec=10.0, what='a robot that stands')
    page.close()


@pytest.mark.timeout(120)
def test_the_page_publishes_commands_only_while_it_drives(lab: Lab, page: Page) -> None:
    def publishers() -> int:
        infos = lab.listener.get_publishers_info_by_topic('/' + COMMANDS)
        return sum(info.node_name == 'husky_view' for info in infos)

    wait_until(lambda: publishers() == 0, timeout_sec=10.0, what='a page that does not drive')
    page.keyboard.down('ArrowLeft')
    wait_until(lambda: publishers() == 1, timeout_sec=10.0, what='a page that drives')
    page.keyboard.up('ArrowLeft')
    wait_until(lambda: publishers() == 0, timeout_sec=10.0, what='a page that has let go')
    wait_until(lab.stands, timeout_sec=10.0, what='a robot that stands')


@pytest.mark.timeout(120)
def test_nonsense_is_not_drawn_but_named_on_the_page(lab: Lab, page: Page) -> None:
    scenes = list[Float64MultiArray]()
    # Ended as a whole: what is destroyed while its node spins in another thread ends the spinning.
    stranger = lab.nodes.start(Node, 'stranger')
    stranger.create_subscription(Float64MultiArray, 'husky_sim/scene', scenes.append, SCENE_QOS)
    wait_until(lambda: bool(scenes), timeout_sec=10.0, what='a scene')
    scene = scenes[0]
    publisher = stranger.create_publisher(Float64MultiArray, 'husky_sim/scene', SCENE_QOS)
    wait_until(
        lambda: publisher.get_subscription_count() > 0,
        timeout_sec=10.0,
        what='a view that listens',
    )
    shown_sec = number(page, 'time').inner_text()
    scene.data[2] = math.nan

    def told() -> bool:
        publisher.publish(scene)
        return bool(page.evaluate(f"{TROUBLE}.includes('a joint position is no number')"))

    wait_until(told, timeout_sec=10.0, what='a word about the nonsense')
    scene.layout.dim[1].size = 3
    publisher.publish(scene)
    expect(page.locator('[data-trouble]')).to_contain_text('no scene of 1 robots')
    lab.nodes.close(stranger)
    wait_for(page, f'!{TROUBLE}')
    expect(number(page, 'time')).not_to_have_text(shown_sec)
    assert errors(page) == []


@pytest.mark.timeout(120)
def test_a_reset_keeps_the_path_of_a_driver_that_still_drives_only(lab: Lab, page: Page) -> None:
    driver = lab.nodes.start(Node, 'driver')
    poses = [Pose(position=Point(x=x)) for x in (0.0, 2.0)]
    for kind, topic, message in (
        (Path, 'path', Path(poses=[PoseStamped(pose=pose) for pose in poses])),
        (PoseArray, 'waypoints', PoseArray(poses=poses)),
        (UInt32, 'waypoints_left', UInt32(data=2)),
    ):
        driver.create_publisher(kind, topic, LATCHED).publish(message)
    legend, left = page.locator('.husky-legend'), number(page, 'left')
    expect(legend).to_contain_text('given path', timeout=10_000)
    expect(left).to_have_text('2')

    def reset() -> None:
        before_sec = lab.time_sec
        button(page, 'Reset').click()
        wait_until(lambda: lab.time_sec < before_sec, timeout_sec=15.0, what='a new beginning')
        wait_until(lambda: lab.time_sec > 0.5, timeout_sec=15.0, what='time that goes on')

    reset()
    expect(legend).to_contain_text('given path')
    expect(left).to_have_text('2')
    publishers = lab.listener.count_publishers
    lab.nodes.close(driver)
    wait_until(lambda: not publishers('path'), timeout_sec=10.0, what='a driver that is gone')
    expect(left).to_have_text('2')  # until the reset, it is what was driven
    reset()
    expect(legend).not_to_contain_text('given path')
    expect(left).to_have_text('–')
    assert errors(page) == []


@pytest.mark.timeout(120)
def test_a_camera_has_a_pane_until_it_is_switched_off(lab: Lab, page: Page) -> None:
    camera = lab.nodes.start(Node, 'camera')
    publisher = camera.create_publisher(Image, 'camera/image_raw', 1)
    picture = Image(height=32, width=48, encoding='rgb8', data=bytes(32 * 48 * 3))
    seen = '[...document.images].some((image) => image.naturalWidth === 48)'

    def is_seen() -> bool:
        publisher.publish(picture)
        return bool(page.evaluate(seen))

    wait_for(page, f'{FACTOR} > 0.5')
    before = places(page)
    wait_until(is_seen, timeout_sec=20.0, what='the picture on the page')
    assert places(page) == before, 'a press would end beside its button'
    page.get_by_label('What the camera sees').uncheck()
    wait_until(
        lambda: publisher.get_subscription_count() == 0,
        timeout_sec=10.0,
        what='a camera that nobody looks at',
    )
    lab.nodes.close(camera)
    expect(page.get_by_label('What the camera sees')).to_be_hidden()


@pytest.mark.timeout(120)
def test_the_pad_turns_the_robot_and_the_stop_button_holds_it(lab: Lab, page: Page) -> None:
    button(page, '◀').hover()
    page.mouse.down()
    wait_until(
        lambda: lab.truth.twist.twist.angular.z > 0.3, timeout_sec=10.0, what='a turn to the left'
    )
    page.mouse.up()
    button(page, 'STOP').click()
    button(page, 'Release the stop').wait_for()
    wait_until(lab.stands, timeout_sec=10.0, what='a robot that stands')

    def push() -> bool:
        lab.listener.command(0.5)
        return lab.moves()

    later_sec = lab.time_sec + 0.5
    wait_until(lambda: push() or lab.time_sec > later_sec, timeout_sec=15.0, what='half a second')
    assert lab.stands(), 'a stopped robot was driven'
    button(page, 'Release the stop').click()
    button(page, 'STOP').wait_for()
    wait_until(push, timeout_sec=10.0, what='a robot that can be driven again')


@pytest.mark.timeout(120)
def test_a_page_reloaded_with_a_key_held_stops_the_robot(lab: Lab) -> None:
    page = lab.open()
    page.keyboard.down('ArrowUp')
    wait_until(lab.moves, timeout_sec=10.0, what='a robot that moves')
    page.reload(wait_until='commit')
    wait_until(lab.stands, timeout_sec=5.0, what='a robot that stands')
    page.locator('.husky-stop').wait_for()
    expect(number(page, 'time')).not_to_be_empty()
    assert errors(page) == []
    page.close()


@pytest.mark.timeout(120)
def test_a_page_that_dies_with_its_pad_held_stops_the_robot(lab: Lab) -> None:
    page = lab.open()
    button(page, '▼').hover()
    page.mouse.down()
    wait_until(lambda: lab.speed_m_s < -0.2, timeout_sec=10.0, what='a robot that moves')
    with suppress(Error):  # it cannot even say goodbye
        page.goto('chrome://crash')
    wait_until(lab.stands, timeout_sec=3.0, what='a robot that stands')
    page.close()


@pytest.mark.timeout(120)
def test_a_phone_shows_the_scene_and_can_stop_the_robot(lab: Lab) -> None:
    page = lab.open(*PHONE)
    expect(button(page, 'STOP')).to_be_in_viewport(ratio=1.0)
    left, top, width = page.evaluate(PANEL)
    assert (left, width) == (0, PHONE[0]), 'the panel is as wide as the phone'
    assert top > 0.4 * PHONE[1], 'and leaves room for the scene'
    button(page, 'STOP').click()
    button(page, 'Release the stop').wait_for()
    button(page, 'Release the stop').click()
    button(page, 'STOP').wait_for()
    for end in ('touchEnd', 'touchCancel'):
        let_go_beside(page, '▼', end)
        wait_for(page, 'window.released')  # and not only by the timeout
    page.set_viewport_size({'width': PHONE[1], 'height': PHONE[0]})
    wait_for(page, f'{SCENE}.clientHeight === {PHONE[0]}')  # turned, it has room beside the panel
    assert errors(page) == []
    page.close()


def let_go_beside(page: Page, sign: str, end: str) -> None:
    """Press a pad's button with a finger that ends on the scene."""
    pad = button(page, sign)
    pad.evaluate('b => { released = false; b.onclick = () => { released = true; }; }')
    place = pad.bounding_box()
    assert place is not None
    finger = {'x': place['x'] + 5.0, 'y': place['y'] + 5.0}
    devtools = page.context.new_cdp_session(page)
    for kind, points in (
        ('touchStart', [finger]),
        ('touchMove', [{**finger, 'y': 50.0}]),
        (end, []),
    ):
        devtools.send('Input.dispatchTouchEvent', {'type': kind, 'touchPoints': points})
    devtools.detach()


@pytest.mark.timeout(120)
def test_the_page_goes_on_with_the_next_simulator(lab: Lab, page: Page) -> None:
    wait_until(lambda: lab.time_sec > 1.0, timeout_sec=15.0, what='a second of this run')
    wait_for(page, f'{FACTOR} > 0.5')
    before = places(page)
    lab.simulator.close()
    expect(page.locator('[data-trouble]')).to_contain_text('is gone')
    assert places(page) == before, 'a press, as on STOP, would end beside its button'
    assert number(page, 'factor').inner_text() == '–'
    lab.start_simulator()
    wait_for(page, f'!{TROUBLE}')
    wait_for(page, f'{FACTOR} > 0.5')
    assert errors(page) == []


def pages_that_hear_of_a_stop(lab: Lab) -> set[bytes]:
    """Return the subscriptions of the view; there is another where it shows another world."""
    readers = lab.listener.get_subscriptions_info_by_topic('/e_stop')
    return {bytes(each.endpoint_gid) for each in readers if each.node_name == 'husky_view'}


@pytest.mark.timeout(120)
def test_a_stop_holds_the_next_simulators_and_anybody_may_release_it(lab: Lab, page: Page) -> None:
    button(page, 'STOP').click()
    wait_until(lambda: len(pages_that_hear_of_a_stop(lab)) == 1, timeout_sec=10.0, what='the page')
    before = pages_that_hear_of_a_stop(lab)
    for robots in ((), ('husky -2 0 0',)):  # the same world, and another one
        lab.simulator.close()
        expect(page.locator('[data-trouble]')).to_contain_text('is gone')
        lab.start_simulator(*robots)
        lab.simulator.wait_for_text('emergency stop')
        wait_for(page, f'{FACTOR} > 0.5')
        button(page, 'Release the stop').wait_for()
    # Another world has another page: what is published before it hears of stops is lost to it.
    wait_until(
        lambda: len(pages_that_hear_of_a_stop(lab) - before) == 1,
        timeout_sec=10.0,
        what='the page of the other world',
    )
    stop = lab.listener.create_publisher(Bool, 'e_stop', LATCHED)
    wait_until(
        lambda: stop.get_subscription_count() == 2, timeout_sec=10.0, what='page and simulator'
    )
    stop.publish(Bool(data=False))
    button(page, 'STOP').wait_for()
    # The next message takes the place of one that the simulator has not taken yet.
    wait_until(
        lambda: 'stop released' in lab.simulator.output,
        timeout_sec=10.0,
        what=lambda: f'a release in {lab.simulator.output}',
    )
    stop.publish(Bool(data=True))
    # One that is released before the simulator has noticed it is none for it.
    wait_until(
        lambda: sum(line.endswith('emergency stop') for line in lab.simulator.lines) == 2,
        timeout_sec=10.0,
        what='a second stop of the simulator',
    )
    button(page, 'Release the stop').click()
    button(page, 'STOP').wait_for()
    wait_until(
        lambda: lab.simulator.output.count('stop released') == 2,
        timeout_sec=10.0,
        what=lambda: f'two releases in {lab.simulator.output}',
    )
    do_in_thread_of(lab.listener, lab.listener.destroy_publisher, stop)


@pytest.mark.timeout(120)
def test_the_page_is_made_anew_for_other_robots_and_knows_what_holds_them(
    lab: Lab, page: Page
) -> None:
    lab.simulator.close()
    held = [
        lab.listener.create_publisher(Bool, f'{each}/e_stop', 10) for each in ('alpha', 'beta')
    ]
    lab.start_simulator('alpha 0 0 0', 'beta -3 0 0')
    for stop in held:
        wait_until(stop.get_subscription_count, timeout_sec=20.0, what='robots')
        stop.publish(Bool(data=True))
    page.get_by_label('Robot', exact=True).wait_for()
    button(page, 'Release the stop').click()
    for name in ('alpha', 'beta'):
        lab.simulator.wait_for_text(f'{name}: emergency stop released')
    for stop in held:
        do_in_thread_of(lab.listener, lab.listener.destroy_publisher, stop)
    wait_for(page, f'{FACTOR} > 0.5')
    wait_for(page, f'!{TROUBLE}')
    page.get_by_label('Robot', exact=True).click()
    page.get_by_role('option', name='beta', exact=True).click()
    page.keyboard.down('ArrowUp')  # it drives the one that was chosen, and opens no list
    wait_for(page, "parseFloat(document.querySelector('[data-number=speed]').textContent) > 0.2")
    page.keyboard.up('ArrowUp')
    assert errors(page) == []


def test_a_simulator_without_a_viewer_loads_none_of_its_code() -> None:
    script = (
        'import sys, husky_sim.ros.node; '
        "print([m for m in sys.modules if m.split('.')[0] in ('viser', 'mjviser', 'trimesh')"
        " or m.startswith('husky_view')])"
    )
    done = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True)
    assert done.stdout.strip() == '[]', done.stdout + done.stderr
