# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Messages as plain CDR, little endian, without the four bytes of its header.

The rules (OMG DDS-XTypes 1.3, 7.4.1, encoding version 1; "ROS" marks what ROS adds to them):

* A number of n bytes stands at the next multiple of n, counted from the first byte.
* A string is its size in bytes as uint32, UTF-8, and a zero, which is counted.
* A wstring is its length as uint32, then a uint32 for each unit of UTF-16 (ROS).
* A sequence is its length as uint32, then its items. An array is its items alone.
* A message is its fields in their order. Without fields it is one byte (ROS).
"""

from rosidl_typesupport_python.cdr.codec import class_of, Codec, codec_of, type_name

__all__ = ['Codec', 'class_of', 'codec_of', 'type_name']
