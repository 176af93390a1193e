# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Type support of messages, services and actions for rmw_fastrtps_cpp, without a compiler."""

from rosidl_typesupport_python.package import capsules_of

__all__ = ['capsules_of']
