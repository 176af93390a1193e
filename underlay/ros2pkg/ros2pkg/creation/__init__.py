# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `ros2 pkg create` writes: texts by file name, made from the description of a package."""
