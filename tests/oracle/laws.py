"""Contact laws of the oracle by value, for any of its descriptions: `Law`, or (c0, p0) of an exponential one."""

import numpy as np

from .enumeration import Law, exponential_pressure


def is_hard(law):
    """Whether the law is a constraint."""
    return isinstance(law, Law) and not law.segments


def pressure(law, overclosure):
    """Pressure and slope of a softened law."""
    if not isinstance(law, Law):
        return exponential_pressure(overclosure, *law)
    for piece in law.segments:
        if overclosure <= piece.upper:
            closed = overclosure >= law.onset
            return (piece.offset + piece.slope * overclosure, piece.slope) if closed else (0.0, 0.0)
    raise ValueError(f"overclosure {overclosure} is not a number")


def onset(law):
    """Overclosure at which pressure begins."""
    return law.onset if isinstance(law, Law) else -law[0]


def violation(law, area, overclosure, force, length, strength):
    """How far a point is from its law: 0 is exact, relative to a length and a force of the deck."""
    if is_hard(law):
        product = min(abs(overclosure) / length, abs(force) / strength)
        return max(overclosure / length, -force / strength, product)
    value, slope = pressure(law, overclosure)
    # A stiff law turns rounding of the overclosure into a force.
    return abs(force - area * value) / (strength + area * slope * length)


def tangent(law, area, overclosure, weight):
    """Linear law `F = c + k h` that touches the law at an overclosure; a hard point gets a stiff spring of `weight`."""
    if is_hard(law):
        return (0.0, weight) if overclosure > 0.0 else (0.0, 0.0)
    value, slope = pressure(law, overclosure)
    return area * (value - slope * overclosure), area * slope


def energy(law, area, overclosure, weight):
    """Integral of the force from separation, by pieces; hard points as in `tangent`."""
    if is_hard(law):
        return 0.5 * weight * max(overclosure, 0.0) ** 2
    if not isinstance(law, Law):
        from .enumeration import exponential_energy

        return area * exponential_energy(overclosure, *law)
    total = 0.0
    for piece in law.segments:
        top = min(overclosure, piece.upper)
        if top <= piece.lower:
            break
        total += (top - piece.lower) * (piece.offset + 0.5 * piece.slope * (top + piece.lower))
    return area * total if np.isfinite(total) else np.inf
