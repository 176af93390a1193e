# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The bridge: messages to arrays of numpy, as OpenCV has them, and back."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from cv_bridge.conversion import convert
from cv_bridge.encodings import CvBridgeError, DEPTHS, Encoding, encoding_of
from cv_bridge.opencv import opencv

_PASSTHROUGH = 'passthrough'
_DEPTH_OF = {dtype: depth for depth, dtype in DEPTHS.items()}
_COLOR_OF_PICTURE = {1: 'mono', 3: 'bgr', 4: 'bgra'}  # as OpenCV reads files


class CvBridge:
    """Converts images.

    An image of OpenCV is an array of (rows, columns, channels), or (rows, columns) where it has
    one channel.
    """

    def dtype_with_channels_to_cvtype2(self, dtype: DTypeLike, n_channels: int) -> str:
        """Return OpenCV's name of a pixel, as 8UC3.

        :raises CvBridgeError: OpenCV has no such numbers.
        """
        name = np.dtype(dtype).name
        if name not in _DEPTH_OF:
            raise CvBridgeError(
                f'an image of {name} numbers: OpenCV has {", ".join(_DEPTH_OF)}; astype() converts'
            )
        return f'{_DEPTH_OF[name]}C{n_channels}'

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """Return numpy's name of the numbers and how many a pixel has, of OpenCV's number."""
        return [*DEPTHS.values()][cvtype & 7], (cvtype >> 3) + 1

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """Return OpenCV's number of the pixels of an encoding.

        :raises CvBridgeError: there is no such encoding.
        """
        return encoding_of(encoding).cv_type

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return numpy's name of the numbers of an encoding, and how many a pixel has.

        :raises CvBridgeError: there is no such encoding.
        """
        return self.cvtype2_to_dtype_with_channels(self.encoding_to_cvtype2(encoding))

    def imgmsg_to_cv2(self, img_msg: Image, desired_encoding: str = _PASSTHROUGH) -> NDArray[Any]:
        """Return the image of a message.

        :param desired_encoding: 'passthrough': as it is; the array may then be the memory of the
            message.
        :raises CvBridgeError: the message is none of an image, or the conversion makes no sense.
        """
        source = encoding_of(img_msg.encoding)
        image = _pixels(img_msg, source)
        if desired_encoding == _PASSTHROUGH:
            return image
        return convert(image, source, encoding_of(desired_encoding))

    def cv2_to_imgmsg(
        self, cvim: NDArray[Any], encoding: str = _PASSTHROUGH, header: Header | None = None
    ) -> Image:
        """Return a message of an image.

        :param encoding: what the numbers mean, which are not converted; 'passthrough': numbers.
        :raises CvBridgeError: an image of another type than the encoding's.
        :raises TypeError: no array.
        """
        _require_image(cvim)
        channels = 1 if cvim.ndim < 3 else cvim.shape[2]
        cv_name = self.dtype_with_channels_to_cvtype2(cvim.dtype, channels)
        if encoding != _PASSTHROUGH and (needed := encoding_of(encoding).cv_name) != cv_name:
            raise CvBridgeError(
                f'encoding specified as {encoding}, which is {needed}, but image has incompatible '
                f'type {cv_name}'
            )
        msg = Image(height=cvim.shape[0], width=cvim.shape[1])
        if header is not None:
            msg.header = header
        msg.encoding = cv_name if encoding == _PASSTHROUGH else encoding
        little = cvim.dtype.byteorder == '<' or (
            cvim.dtype.byteorder == '=' and sys.byteorder == 'little'
        )
        msg.is_bigendian = int(cvim.dtype.itemsize > 1 and not little)
        msg.step = cvim.shape[1] * channels * cvim.dtype.itemsize
        msg.data.frombytes(cvim.tobytes())
        return msg

    def compressed_imgmsg_to_cv2(
        self, cmprs_img_msg: CompressedImage, desired_encoding: str = _PASSTHROUGH
    ) -> NDArray[Any]:
        """Return the image of a message that has it as a file, such as a JPEG.

        :param desired_encoding: 'passthrough': as OpenCV reads it, bgr8 mostly.
        :raises CvBridgeError: OpenCV cannot read it, or the conversion makes no sense.
        """
        cv2 = opencv()
        file = np.frombuffer(bytes(cmprs_img_msg.data), np.uint8)
        image = cv2.imdecode(file, cv2.IMREAD_UNCHANGED) if file.size else None
        if image is None:
            raise CvBridgeError(
                f'{file.size} bytes of format [{cmprs_img_msg.format}]: OpenCV reads no image in '
                'them'
            )
        if desired_encoding == _PASSTHROUGH:
            return np.asarray(image)
        color = _COLOR_OF_PICTURE[1 if image.ndim == 2 else image.shape[2]]
        source = encoding_of(f'{color}{8 * image.dtype.itemsize}')
        return convert(image, source, encoding_of(desired_encoding))

    def cv2_to_compressed_imgmsg(
        self, cvim: NDArray[Any], dst_format: str = 'jpg'
    ) -> CompressedImage:
        """Return a message that has the image as a file.

        :param dst_format: jpg, png, or what else OpenCV writes.
        :raises CvBridgeError: OpenCV does not write it.
        :raises TypeError: no array.
        """
        _require_image(cvim)
        cv2 = opencv()
        try:
            _, file = cv2.imencode(f'.{dst_format}', cvim)
        except cv2.error as error:
            raise CvBridgeError(
                f'OpenCV writes no [{dst_format}] of an image of {cvim.dtype.name} and shape '
                f'{cvim.shape}: {" ".join(str(error).split())}'
            ) from None
        msg = CompressedImage(format=dst_format)
        msg.data.frombytes(file.tobytes())
        return msg


def _require_image(image: object) -> None:
    if not isinstance(image, np.ndarray):
        raise TypeError(
            f'an image of OpenCV is an array of numpy, and {type(image).__name__} is none'
        )
    if image.ndim not in (2, 3):
        raise CvBridgeError(
            f'an image is of (rows, columns) or (rows, columns, channels), not {image.shape}'
        )


def _pixels(msg: Image, source: Encoding) -> NDArray[Any]:
    dtype = np.dtype(DEPTHS[source.depth])
    size = dtype.itemsize
    needed = msg.width * source.channels * size
    if msg.step < needed or len(msg.data) < msg.height * msg.step:
        raise CvBridgeError(
            f'Image is wrongly formed: {msg.height} rows of {msg.step} bytes (step) do not hold '
            f'{msg.width} pixels of [{source.name}], {needed} bytes a row, in {len(msg.data)} '
            'bytes of data'
        )
    data = bytes(msg.data) if isinstance(msg.data, list) else msg.data
    pixels: NDArray[Any] = np.ndarray(
        shape=(msg.height, msg.width, source.channels),
        dtype=dtype.newbyteorder('>' if msg.is_bigendian else '<'),
        buffer=data,
        strides=(msg.step, source.channels * size, size),
    )
    if source.channels == 1:
        pixels = pixels[:, :, 0]
    return np.ascontiguousarray(pixels, dtype=dtype)
