# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What each control of the page can be set to."""

from typing import Any

import viser

_CHOICES = (viser.GuiButtonGroupHandle, viser.GuiDropdownHandle)


def accepts(control: Any, value: object) -> bool:
    """Tell whether a page can set a control to a value: one that it shows and that is not grey."""
    if control is None or control.disabled or not control.visible:
        return False
    if isinstance(control, viser.GuiButtonHandle):
        return value is True
    if isinstance(control, viser.GuiCheckboxHandle):
        return isinstance(value, bool)
    if isinstance(control, _CHOICES):
        return value in control.options
    if isinstance(control, viser.GuiSliderHandle):
        return type(value) in (int, float) and control.min <= value <= control.max
    if isinstance(control, viser.GuiTextHandle):
        return isinstance(value, str) and value.isprintable()
    return False
