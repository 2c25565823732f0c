"""Results as users see them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

FloatArray = np.ndarray[Any, np.dtype[np.float64]]
LabelArray = np.ndarray[Any, np.dtype[np.uint32]]


@dataclass(frozen=True)
class LawCurve:
    """A pressure-overclosure relationship at many overclosures.

    Attributes:
        kind: the law.
        overclosure: as asked for [length], positive when the bodies overlap.
        pressure: contact pressure [pressure], positive pushes the bodies apart.
        stiffness: slope of the pressure [pressure/length].
        energy: integral of the pressure [pressure*length].

    """

    kind: str
    overclosure: FloatArray
    pressure: FloatArray
    stiffness: FloatArray
    energy: FloatArray
