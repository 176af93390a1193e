# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What root finds in a container of somebody else: no right to namespaces, but another user's number.

The rights are those that docker gives by default. Folders on the way to Python and to the lab that
only their owner can pass, as /root, can be passed there.
"""

from collections.abc import Sequence
from pathlib import Path
import stat
import sys

ROOT = Path(__file__).resolve().parents[2]
RIGHTS = (
    *('chown', 'dac_override', 'fsetid', 'fowner', 'mknod', 'net_raw', 'setgid', 'setuid'),
    *('setfcap', 'setpcap', 'net_bind_service', 'sys_chroot', 'kill', 'audit_write'),
)
# A folder gives way to one with all that is in it: in a mount namespace nobody else sees it.
_OPENED = """
for folder in $FOLDERS; do
    new=$(mktemp -d) && mount -t tmpfs -o mode=755 tmpfs "$new" || exit
    find "$folder" -mindepth 1 -maxdepth 1 ! -type l -print0 | while IFS= read -rd '' child; do
        if [ -d "$child" ]; then mkdir "$new/${child##*/}"; else touch "$new/${child##*/}"; fi
        mount --rbind "$child" "$new/${child##*/}"
    done
    mount --move "$new" "$folder" && rmdir "$new" || exit
done
"""


def in_container(command: Sequence[str]) -> list[str]:
    """Return the command by which root runs another one as in a container."""
    folders = ' '.join(map(str, _barred()))
    rights = ','.join(['-all', *(f'+{right}' for right in RIGHTS)])
    script = f'FOLDERS="{folders}"\n{_OPENED}\nexec setpriv --bounding-set={rights} "$@"'
    return ['unshare', '--mount', 'bash', '-c', script, 'bash', *command]


def _barred() -> list[Path]:
    """Return the folders that bar the way to others, the outermost first."""
    places = (ROOT, Path(sys.prefix), Path(sys.executable).resolve())
    found = {
        folder
        for place in places
        for folder in place.parents
        if not folder.stat().st_mode & stat.S_IXOTH
    }
    return sorted(found)
