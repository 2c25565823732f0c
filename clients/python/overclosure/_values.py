"""Results as users see them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

FloatArray = np.ndarray[Any, np.dtype[np.float64]]
LabelArray = np.ndarray[Any, np.dtype[np.uint32]]


@dataclass(frozen=True)
class LawCurve:
    """A pressure-overclosure relationship, or contact damping, at many overclosures.

    Arrays that the kind does not have are empty: those of the pressure for ``damping``, those of the damping for a law.

    Attributes:
        kind: the law.
        overclosure: as asked for [length], positive when the bodies overlap.
        pressure: contact pressure [pressure], positive pushes the bodies apart.
        stiffness: slope of the pressure [pressure/length].
        energy: integral of the pressure [pressure*length].
        coefficient: of ``damping``: viscous pressure per closing speed [pressure*time/length].
        coefficient_slope: of ``damping``: its slope over the overclosure [pressure*time/length^2].

    """

    kind: str
    overclosure: FloatArray
    pressure: FloatArray
    stiffness: FloatArray
    energy: FloatArray
    coefficient: FloatArray
    coefficient_slope: FloatArray
