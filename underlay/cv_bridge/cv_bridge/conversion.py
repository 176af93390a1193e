# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""An image in one encoding made one in another."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from cv_bridge.encodings import CvBridgeError, DEPTHS, Encoding
from cv_bridge.opencv import opencv

_COLORS = ('mono', 'rgb', 'bgr', 'rgba', 'bgra')
_FROM_BAYER = _COLORS[:3]
_UNCHANGED = (*_COLORS, 'uyvy')  # may become the same color in another depth
# OpenCV calls the patterns by their second row, from its second pixel on.
_OPENCV_BAYER = {'rggb': 'BG', 'bggr': 'RG', 'gbrg': 'GR', 'grbg': 'GB'}
_SCALE = {(8, 16): 65535.0 / 255.0, (16, 8): 255.0 / 65535.0}


def convert(image: NDArray[Any], source: Encoding, target: Encoding) -> NDArray[Any]:
    """Return an image of its own in another encoding.

    :param image: (rows, columns) of one channel, else (rows, columns, channels).
    :raises CvBridgeError: that makes no sense, or OpenCV cannot do it.
    """
    if source.name == target.name:
        return image.copy()
    if source.color is None or target.color is None:
        if source.channels != target.channels:
            raise CvBridgeError(
                f'[{source.name}] has {source.channels} channels and [{target.name}] '
                f'{target.channels}: only colors can become others'
            )
        if source.color is None and target.color is not None:
            raise CvBridgeError(
                f'[{source.name}] is not a color format, but [{target.name}] is: the conversion '
                'does not make sense'
            )
        return _in_depth(image, source, target)
    if source.color == target.color:
        if source.color not in _UNCHANGED:
            raise _unsupported(source, target)
        return _in_depth(image, source, target)
    code = _code(source.color, target.color)
    if code is None:
        raise _unsupported(source, target)
    cv2 = opencv()
    try:
        colored = cv2.cvtColor(image, getattr(cv2, code))
    except cv2.error as error:
        raise CvBridgeError(
            f'[{source.name}] to [{target.name}]: {" ".join(str(error).split())}'
        ) from None
    return colored if source.bits == target.bits else _in_depth(colored, source, target)


def _unsupported(source: Encoding, target: Encoding) -> CvBridgeError:
    return CvBridgeError(f'Unsupported conversion from [{source.name}] to [{target.name}]')


def _code(source: str, target: str) -> str | None:
    """Return OpenCV's name of the conversion of a color to another one."""
    if target not in _COLORS:
        return None
    to = 'GRAY' if target == 'mono' else target.upper()
    if source in ('uyvy', 'yuy2'):
        return f'COLOR_YUV2{to}_{source.upper()}'
    if source in _COLORS:
        return f'COLOR_{"GRAY" if source == "mono" else source.upper()}2{to}'
    if target in _FROM_BAYER:
        return f'COLOR_Bayer{_OPENCV_BAYER[source.removeprefix("bayer_")]}2{to}'
    return None


def _in_depth(image: NDArray[Any], source: Encoding, target: Encoding) -> NDArray[Any]:
    """Return the image with numbers of another type.

    Whole numbers are rounded, and end at the bounds of the type; 8 and 16 bits are brought to
    each other's range. What is not a number becomes 0.
    """
    dtype = np.dtype(DEPTHS[target.depth])
    if image.dtype == dtype:
        return image.copy()
    scale = _SCALE.get((source.bits, target.bits), 1.0)
    if dtype.kind == 'f':
        return (image * scale).astype(dtype)
    bounds = np.iinfo(dtype)
    numbers = np.nan_to_num(image.astype(np.float64) * scale, posinf=np.inf, neginf=-np.inf)
    return np.clip(np.rint(numbers), bounds.min, bounds.max).astype(dtype)
