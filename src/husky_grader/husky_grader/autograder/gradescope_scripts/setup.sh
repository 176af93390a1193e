#!/usr/bin/env bash
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
#
# Gradescope runs this once, as root, when it builds the image (Ubuntu): it sets the lab up.
# HUSKY_AUTOGRADER names another folder for /autograder.
set -euo pipefail
umask 022

autograder=${HUSKY_AUTOGRADER:-/autograder}
lab=$autograder/lab

if ! python3 -c 'import ensurepip, sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
    apt-get update
    DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends python3 python3-venv
fi

# Programs of students run as another user: that one reads the lab, and neither the rubric with its
# hidden courses nor the results of others.
mkdir -p "$lab"
tar -xzf "$autograder/source/lab.tar.gz" --no-same-owner -C "$lab"
chmod 0700 "$autograder/source"

"$lab/lab" exec true
