# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Images between ROS and OpenCV, with the real OpenCV."""

from __future__ import annotations

from collections.abc import Callable
import subprocess
import sys
from typing import Any

import cv2
from cv_bridge import CvBridge, CvBridgeError, getCvType
import numpy as np
from numpy.typing import NDArray
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

Array = NDArray[Any]
RED = (255, 0, 0)  # as rgb
COLORS = ('mono', 'rgb', 'bgr', 'rgba', 'bgra')
TYPES = ('uint8', 'int8', 'uint16', 'int16', 'int32', 'float32', 'float64')


@pytest.fixture
def bridge() -> CvBridge:
    return CvBridge()


def sent(msg: Any) -> Any:
    """Return a message as it comes out of DDS."""
    return deserialize_message(serialize_message(msg), type(msg))


def message(image: Array, encoding: str, *, gap: int = 0) -> Image:
    """Return a message, made by hand, with some bytes after each row."""
    rows = np.ascontiguousarray(image).view(np.uint8).reshape(len(image), -1)
    padded = np.pad(rows, ((0, 0), (0, gap)), constant_values=77)
    msg = Image(height=image.shape[0], width=image.shape[1], encoding=encoding)
    msg.step = padded.shape[1]
    msg.data.frombytes(padded.tobytes())
    return msg


def noise(dtype: str, *shape: int) -> Array:
    return np.random.default_rng(1).uniform(0, 127, shape).astype(dtype)


@pytest.mark.parametrize('dtype', TYPES)
@pytest.mark.parametrize('channels', [0, 1, 2, 3, 4, 5])
def test_numbers_come_back_as_they_were(bridge: CvBridge, dtype: str, channels: int) -> None:
    image = noise(dtype, 7, 5, *([channels] if channels else []))
    header = Header(frame_id='camera')
    msg = sent(bridge.cv2_to_imgmsg(image, header=header))
    assert (msg.height, msg.width, msg.header.frame_id) == (7, 5, 'camera')
    assert msg.step * 7 == len(msg.data) == image.nbytes
    back = bridge.imgmsg_to_cv2(msg)
    assert back.dtype == image.dtype
    np.testing.assert_array_equal(back, image[:, :, 0] if channels == 1 else image)


def test_a_part_of_an_image_is_sent_alone(bridge: CvBridge) -> None:
    part = noise('uint8', 9, 9, 3)[2:5, 1:8:2]
    np.testing.assert_array_equal(bridge.imgmsg_to_cv2(sent(bridge.cv2_to_imgmsg(part))), part)


@pytest.mark.parametrize('dtype', ['uint16', 'int32', 'float64'])
def test_bytes_in_the_other_order_are_turned(bridge: CvBridge, dtype: str) -> None:
    image = noise(dtype, 3, 4)
    msg = bridge.cv2_to_imgmsg(image.astype(image.dtype.newbyteorder('>')))
    assert msg.is_bigendian == 1
    back = bridge.imgmsg_to_cv2(sent(msg))
    assert back.dtype == image.dtype
    np.testing.assert_array_equal(back, image)
    assert bridge.cv2_to_imgmsg(image.astype(image.dtype.newbyteorder('<'))).is_bigendian == 0
    assert bridge.cv2_to_imgmsg(noise('uint8', 3, 4)).is_bigendian == 0


def test_bytes_after_a_row_are_left_out(bridge: CvBridge) -> None:
    for image, encoding in ((noise('uint8', 4, 5, 3), 'rgb8'), (noise('uint16', 4, 5), 'mono16')):
        np.testing.assert_array_equal(
            bridge.imgmsg_to_cv2(message(image, encoding, gap=3)), image, encoding
        )


def plain(color: str, bits: int) -> Array:
    """Return an image that is red all over."""
    full = 255 if bits == 8 else 65535
    rgba = np.array([full, 0, 0, full])
    # 0.299 of the light of a colour is that of its red (ITU-R BT.601).
    pixel = {
        'mono': np.array(round(0.299 * full)),
        'rgb': rgba[:3],
        'bgr': rgba[2::-1],
        'rgba': rgba,
        'bgra': rgba[[2, 1, 0, 3]],
    }[color]
    return np.broadcast_to(pixel, (2, 2, *pixel.shape)).astype(f'uint{bits}')


@pytest.mark.parametrize('bits', [8, 16])
@pytest.mark.parametrize('source', COLORS[1:])
@pytest.mark.parametrize('target', COLORS)
@pytest.mark.parametrize('wanted_bits', [8, 16])
def test_red_stays_red(
    bridge: CvBridge, source: str, bits: int, target: str, wanted_bits: int
) -> None:
    msg = message(plain(source, bits), f'{source}{bits}')
    got = bridge.imgmsg_to_cv2(msg, f'{target}{wanted_bits}')
    wanted = plain(target, wanted_bits)
    assert (got.dtype, got.shape) == (wanted.dtype, wanted.shape)
    np.testing.assert_allclose(got, wanted, atol=2 ** (wanted_bits - 8) if bits == 8 else 1)


@pytest.mark.parametrize('encoding', ['yuv422', 'uyvy', 'yuv422_yuy2', 'yuyv'])
def test_red_is_seen_in_yuv(bridge: CvBridge, encoding: str) -> None:
    u, y, v = 90, 82, 240  # BT.601, of studio range
    pair = [[u, y], [v, y]] if encoding in ('yuv422', 'uyvy') else [[y, u], [y, v]]
    msg = message(np.array([pair, pair], np.uint8), encoding)
    np.testing.assert_allclose(
        bridge.imgmsg_to_cv2(msg, 'rgb8'), np.broadcast_to(RED, (2, 2, 3)), atol=3
    )
    assert bridge.imgmsg_to_cv2(msg).shape == (2, 2, 2)


@pytest.mark.parametrize('pattern', ['rggb', 'bggr', 'gbrg', 'grbg'])
@pytest.mark.parametrize('bits', [8, 16])
def test_red_is_seen_through_a_bayer_filter(bridge: CvBridge, pattern: str, bits: int) -> None:
    full = 255 if bits == 8 else 65535
    tile = np.array([full if each == 'r' else 0 for each in pattern]).reshape(2, 2)
    msg = message(np.tile(tile, (4, 4)).astype(f'uint{bits}'), f'bayer_{pattern}{bits}')
    for target, wanted in (('rgb', RED), ('bgr', RED[::-1])):
        seen = bridge.imgmsg_to_cv2(msg, f'{target}8')[3:5, 3:5]  # not the border
        np.testing.assert_array_equal(seen, np.broadcast_to(wanted, (2, 2, 3)), target)


def test_numbers_end_at_the_bounds_of_their_type(bridge: CvBridge) -> None:
    image = np.array([[-3.0, 0.5, 1.5, 254.6, 1e9, np.inf, -np.inf, np.nan]], np.float32)
    msg = bridge.cv2_to_imgmsg(image)
    assert bridge.imgmsg_to_cv2(msg, '8UC1').tolist() == [[0, 0, 2, 255, 255, 255, 0, 0]]
    assert bridge.imgmsg_to_cv2(msg, '8S')[0, :5].tolist() == [-3, 0, 2, 127, 127]


@pytest.mark.parametrize(
    ('encoding', 'desired', 'said'),
    [
        ('8UC3', 'mono16', 'has 3 channels'),
        ('8UC3', 'bgr8', 'not a color format'),
        ('rgb8', '32FC1', 'has 3 channels'),
        ('bgr8', 'bayer_rggb8', 'Unsupported conversion'),
        ('rgb8', 'rgb', r'Unrecognized image encoding \[rgb\]: known are mono8, '),
        ('8UC0', 'passthrough', 'Unrecognized'),
        ('8UC999999999', 'passthrough', 'Unrecognized'),
        ('', 'passthrough', 'Unrecognized'),
    ],
)
def test_what_makes_no_sense_is_refused(
    bridge: CvBridge, encoding: str, desired: str, said: str
) -> None:
    with pytest.raises(CvBridgeError, match=said):
        bridge.imgmsg_to_cv2(message(noise('uint8', 2, 2, 3), encoding), desired)


def test_a_message_that_is_no_image_is_refused(bridge: CvBridge) -> None:
    msg = message(noise('uint8', 4, 4, 3), 'rgb8')
    for name, value in (('step', 11), ('height', 5), ('width', 5), ('height', 2**31)):
        wrong = sent(msg)
        setattr(wrong, name, value)
        with pytest.raises(CvBridgeError, match='Image is wrongly formed'):
            bridge.imgmsg_to_cv2(wrong, 'bgr8')


def test_an_array_that_is_no_image_is_refused(bridge: CvBridge) -> None:
    with pytest.raises(CvBridgeError, match=r'rgba8, which is 8UC4, .* type 8UC3'):
        bridge.cv2_to_imgmsg(noise('uint8', 2, 2, 3), 'rgba8')
    with pytest.raises(CvBridgeError, match='int64 numbers: OpenCV has uint8'):
        bridge.cv2_to_imgmsg(noise('int64', 2, 2))
    converts: list[Callable[[Any], object]] = [
        bridge.cv2_to_imgmsg,
        bridge.cv2_to_compressed_imgmsg,
    ]
    for convert in converts:
        with pytest.raises(TypeError, match='list is none'):
            convert([[1]])
        with pytest.raises(CvBridgeError, match=r'not \(4,\)'):
            convert(noise('uint8', 4))


@pytest.mark.parametrize('file_format', ['png', 'bmp', 'tiff', 'jpg', 'jpeg'])
@pytest.mark.parametrize('channels', [1, 3])
def test_pictures_come_back(bridge: CvBridge, file_format: str, channels: int) -> None:
    image = cv2.GaussianBlur(noise('uint8', 32, 24, channels), (0, 0), 5.0)
    msg = sent(bridge.cv2_to_compressed_imgmsg(image, file_format))
    assert msg.format == file_format
    back = bridge.compressed_imgmsg_to_cv2(msg)
    assert back.shape == image.shape
    np.testing.assert_allclose(back, image, atol=8 if file_format.startswith('j') else 0)
    swapped = bridge.compressed_imgmsg_to_cv2(msg, 'rgb8')
    np.testing.assert_array_equal(swapped, back[..., ::-1] if channels == 3 else swapped)
    assert swapped.shape == (32, 24, 3)


def test_what_is_no_picture_is_refused(bridge: CvBridge) -> None:
    for data in (b'', b'no picture', b'\x89PNG\r\n\x1a\n'):
        msg = CompressedImage(format='png', data=data)
        with pytest.raises(CvBridgeError, match=f'^{len(data)} bytes .* reads no image'):
            bridge.compressed_imgmsg_to_cv2(msg)
    with pytest.raises(CvBridgeError, match=r'writes no \[gifs\]'):
        bridge.cv2_to_compressed_imgmsg(noise('uint8', 4, 4), 'gifs')


def test_types_have_opencvs_numbers(bridge: CvBridge) -> None:
    for name in ('8UC1', '8SC2', '16UC3', '16SC4', '32SC1', '32FC2', '64FC3'):
        number = getattr(cv2, f'CV_{name}')
        assert getCvType(name) == bridge.encoding_to_cvtype2(name) == number
        dtype, channels = bridge.cvtype2_to_dtype_with_channels(number)
        assert bridge.dtype_with_channels_to_cvtype2(np.dtype(dtype), channels) == name
        assert bridge.encoding_to_dtype_with_channels(name) == (dtype, channels)
    assert getCvType('bgra16') == cv2.CV_16UC4
    assert getCvType('bayer_rggb8') == getCvType('8U') == cv2.CV_8UC1


def test_without_opencv_it_says_how_to_get_it() -> None:
    program = (
        'import sys; sys.modules["cv2"] = None\n'
        'from cv_bridge import CvBridge; import numpy\n'
        'bridge = CvBridge()\n'
        'msg = bridge.cv2_to_imgmsg(numpy.zeros((2, 2, 3), numpy.uint8), "rgb8")\n'
        'bridge.imgmsg_to_cv2(msg)\n'
        'bridge.imgmsg_to_cv2(msg, "bgr8")\n'
    )
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True)
    assert '-r requirements/vision.in` installs it' in done.stderr.splitlines()[-1], done.stderr
