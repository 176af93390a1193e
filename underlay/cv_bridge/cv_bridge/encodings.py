# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the encodings of sensor_msgs/msg/Image say of a pixel.

The names are those of sensor_msgs/image_encodings.hpp that cv_bridge converts.
"""

from __future__ import annotations

from dataclasses import dataclass
import re

DEPTHS = {
    '8U': 'uint8',
    '8S': 'int8',
    '16U': 'uint16',
    '16S': 'int16',
    '32S': 'int32',
    '32F': 'float32',
    '64F': 'float64',
}
"""Numpy's names of OpenCV's depths, in the order of OpenCV's numbers for them."""

_CHANNELS = {'mono': 1, 'rgb': 3, 'bgr': 3, 'rgba': 4, 'bgra': 4}
_BAYER = tuple(f'bayer_{pattern}' for pattern in ('rggb', 'bggr', 'gbrg', 'grbg'))
_YUV = {'yuv422': 'uyvy', 'uyvy': 'uyvy', 'yuv422_yuy2': 'yuy2', 'yuyv': 'yuy2'}
_PLAIN = re.compile(f'({"|".join(DEPTHS)})(?:C([0-9]+))?')
_MOST_CHANNELS = 512  # CV_CN_MAX


class CvBridgeError(TypeError):
    """An image that cannot be converted as it was asked for."""


@dataclass(frozen=True)
class Encoding:
    """One encoding.

    :param depth: of a channel, a key of DEPTHS.
    :param color: what the channels mean: mono, rgb, bgra, bayer_rggb, uyvy ...; None: numbers.
    """

    name: str
    depth: str
    channels: int
    color: str | None = None

    @property
    def bits(self) -> int:
        return int(self.depth[:-1])

    @property
    def cv_type(self) -> int:
        """OpenCV's number of such a pixel, CV_MAKETYPE of its interface.hpp."""
        return [*DEPTHS].index(self.depth) | (self.channels - 1) << 3

    @property
    def cv_name(self) -> str:
        return f'{self.depth}C{self.channels}'


def _colors() -> dict[str, Encoding]:
    of = [
        Encoding(f'{color}{bits}', f'{bits}U', _CHANNELS.get(color, 1), color)
        for color in (*_CHANNELS, *_BAYER)
        for bits in (8, 16)
    ]
    of += [Encoding(name, '8U', 2, color) for name, color in _YUV.items()]
    return {each.name: each for each in of}


_COLORS = _colors()


def encoding_of(name: str) -> Encoding:
    """Return what a name says.

    :raises CvBridgeError: it is none.
    """
    if known := _COLORS.get(name):
        return known
    plain = _PLAIN.fullmatch(name)
    channels = int(plain[2] or 1) if plain else 0
    if not plain or not 1 <= channels <= _MOST_CHANNELS:
        raise CvBridgeError(
            f'Unrecognized image encoding [{name}]: known are {", ".join(_COLORS)}, and the types '
            'of OpenCV, as 8UC3 or 32FC1'
        )
    return Encoding(name, plain[1], channels)


def getCvType(name: str) -> int:  # noqa: N802 - the name is upstream's
    """Return OpenCV's number of the pixels of an encoding.

    :raises CvBridgeError: there is no such encoding.
    """
    return encoding_of(name).cv_type
