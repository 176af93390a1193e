# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
. "${COLCON_CURRENT_PREFIX:=${0:A:h}}/local_setup.sh"
