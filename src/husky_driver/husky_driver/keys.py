# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Commands of the keys of teleop_twist_keyboard, and of the arrows.

A terminal reports when a key is pressed and repeated, never when it is released. So a key counts
as held until no repeat has come for a time: first the delay of a keyboard's repeat, then a much
shorter one.
"""

from dataclasses import dataclass

from husky_driver.motion import Command, STOP

MAX_SPEED_M_S = 1.0
MAX_TURN_RAD_S = 2.0
FASTER, SLOWER = 1.1, 0.9  # one press, as in teleop_twist_keyboard

HELP = """\
   u    i    o      forward, with a turn to the left and to the right
   j    k    l      turn on the spot; k stops
   m    ,    .      backward
q/z  faster/slower       w/x  only along       e/c  only turning
arrows work too; every other key stops; Ctrl-C or Esc ends"""

MOVES = {
    **{'i': (1, 0), 'u': (1, 1), 'o': (1, -1), 'j': (0, 1), 'l': (0, -1)},
    **{',': (-1, 0), 'm': (-1, -1), '.': (-1, 1)},
    **{'\x1b[A': (1, 0), '\x1b[B': (-1, 0), '\x1b[D': (0, 1), '\x1b[C': (0, -1)},
    # What a terminal sends where a program before has asked for it (DECCKM).
    **{'\x1bOA': (1, 0), '\x1bOB': (-1, 0), '\x1bOD': (0, 1), '\x1bOC': (0, -1)},
}
CHANGES = {
    **{'q': (FASTER, FASTER), 'z': (SLOWER, SLOWER), 'w': (FASTER, 1.0), 'x': (SLOWER, 1.0)},
    **{'e': (1.0, FASTER), 'c': (1.0, SLOWER)},
}


@dataclass
class Keyboard:
    """Turns key presses into commands; times are of any clock that does not jump."""

    speed_m_s: float = 0.5
    turn_rad_s: float = 1.0
    first_repeat_sec: float = 0.6
    next_repeat_sec: float = 0.2

    _move: tuple[int, int] = (0, 0)
    _key: str = ''
    _until_sec: float = 0.0

    def press(self, key: str, now_sec: float) -> None:
        """Register a key press or a repeat."""
        if key in CHANGES:
            along, turning = CHANGES[key]
            self.speed_m_s = min(self.speed_m_s * along, MAX_SPEED_M_S)
            self.turn_rad_s = min(self.turn_rad_s * turning, MAX_TURN_RAD_S)
            return
        repeated = key == self._key and now_sec < self._until_sec
        held_sec = self.next_repeat_sec if repeated else self.first_repeat_sec
        self._move, self._key = MOVES.get(key, (0, 0)), key
        self._until_sec = now_sec + held_sec

    def command(self, now_sec: float) -> Command:
        """Return the command for now: zero once the key counts as released."""
        if now_sec >= self._until_sec or self._move == (0, 0):
            return STOP
        along, turning = self._move
        return Command(along * self.speed_m_s, turning * self.turn_rad_s)


def split_keys(text: str) -> list[str]:
    """Return the keys in what a terminal sent; an arrow or F1 is three characters."""
    keys = []
    while text:
        length = 3 if text.startswith(('\x1b[', '\x1bO')) and len(text) >= 3 else 1
        keys.append(text[:length])
        text = text[length:]
    return keys
