# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Just enough of RTPS (OMG DDSI-RTPS 2.2) to read the discovery data of a domain."""
