"""Contact by brute force: every combination of point states is solved, and the one that keeps all conditions is the answer.

Per point, `h` is the overclosure (positive when bodies overlap), `F` the normal force (positive in compression). With the
contact compliance `W` and the overclosures `h_free` of the structure without contact, `h = h_free - W F`.
"""

import itertools
from dataclasses import dataclass

import numpy as np

CHUNK = 2048


@dataclass(frozen=True)
class Segment:
    """Piece `pressure = offset + slope * h` of a piecewise linear law, valid for lower <= h <= upper."""

    offset: float
    slope: float
    lower: float
    upper: float


@dataclass(frozen=True)
class Law:
    """Hard (no segments), or piecewise linear. `onset` is the overclosure at which pressure begins."""

    onset: float
    segments: tuple[Segment, ...]


def hard():
    """No overclosure, no tension."""
    return Law(0.0, ())


def linear(stiffness):
    """Pressure `stiffness * h` for positive overclosure."""
    return Law(0.0, (Segment(0.0, stiffness, 0.0, np.inf),))


def tabular(points):
    """Straight lines through (pressure, overclosure) points; the last slope goes on."""
    segments = []
    for (p0, h0), (p1, h1) in itertools.pairwise(points):
        slope = (p1 - p0) / (h1 - h0)
        segments.append(Segment(p0 - slope * h0, slope, h0, h1))
    last = segments.pop()
    segments.append(Segment(last.offset, last.slope, last.lower, np.inf))
    return Law(points[0][1], tuple(segments))


def state_count(law):
    """Open and closed for a hard point; open and every segment for a softened one."""
    return 1 + max(1, len(law.segments))


def pieces(law, weight, free, area):
    """Per state of a point: factors of its own force and of its row of W, right-hand side, least and largest h, least F."""
    rows = [(1.0, 0.0, 0.0, -np.inf, law.onset, -np.inf)]
    if not law.segments:
        rows.append((0.0, 1.0 / weight, free / weight, -np.inf, np.inf, 0.0))
    for piece in law.segments:
        slope = area * piece.slope
        rows.append((1.0, slope, area * piece.offset + slope * free, piece.lower, piece.upper, -np.inf))
    return np.array(rows)


def solve(compliance, free, areas, laws):
    """Forces and overclosures of the accepted combination, and the number of combinations tried.

    Raises ArithmeticError when none is acceptable or two acceptable ones differ: both would be a mistake in the deck.
    """
    count = len(free)
    choices = [pieces(*point) for point in zip(laws, np.diag(compliance), free, areas, strict=True)]
    states = itertools.product(*(range(len(rows)) for rows in choices))
    length = max(np.abs(free).max(), 1e-12)
    force = length / np.diag(compliance).min()
    accepted, tried = [], 0
    while batch := list(itertools.islice(states, CHUNK)):
        tried += len(batch)
        chosen = np.stack([rows[states] for rows, states in zip(choices, np.array(batch).T, strict=True)], axis=1)
        own, coupled, right, lower, upper, least = np.moveaxis(chosen, 2, 0)
        matrix = own[:, :, None] * np.eye(count) + coupled[:, :, None] * compliance
        forces = np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
        overclosures = free - forces @ compliance
        slack = 1e-11 * length
        good = (overclosures >= lower - slack) & (overclosures <= upper + slack) & (forces >= least - 1e-11 * force)
        for row in np.flatnonzero(good.all(axis=1)):
            accepted.append((forces[row], overclosures[row]))
    if not accepted:
        raise ArithmeticError("no combination of contact states keeps all conditions")
    first = accepted[0]
    for other in accepted[1:]:
        if np.abs(other[0] - first[0]).max() > 1e-8 * force:
            raise ArithmeticError("two combinations of contact states keep all conditions")
    return first[0], first[1], tried


def exponential_pressure(overclosure, clearance, pressure):
    """Pressure and slope of the exponential law: `p0/(e-1) u (e^u - 1)`, `u = 1 + h/c0`, straight beyond `u = 7`."""
    u = 1.0 + overclosure / clearance
    scale = pressure / np.expm1(1.0)
    if u <= 0.0:
        return 0.0, 0.0
    bent = min(u, 7.0)
    slope = scale / clearance * ((bent + 1.0) * np.exp(bent) - 1.0)
    return scale * bent * np.expm1(bent) + slope * (u - bent) * clearance, slope


def exponential_energy(overclosure, clearance, pressure):
    """Integral of `exponential_pressure` from separation."""
    u = 1.0 + overclosure / clearance
    if u <= 0.0:
        return 0.0
    bent = min(u, 7.0)
    curve = pressure * clearance / np.expm1(1.0) * ((bent - 1.0) * np.exp(bent) + 1.0 - 0.5 * bent * bent)
    at_bend, slope = exponential_pressure((bent - 1.0) * clearance, clearance, pressure)
    rest = (u - bent) * clearance
    return curve + at_bend * rest + 0.5 * slope * rest * rest


def solve_exponential(compliance, free, areas, parameters):
    """The same for exponential points with `parameters` (c0, p0) each: Newton with halving on the convex potential in h."""
    inverse = np.linalg.inv(compliance)
    h = free.copy()

    def potential(at):
        stored = sum(a * exponential_energy(v, *c) for a, v, c in zip(areas, at, parameters, strict=True))
        return 0.5 * (free - at) @ inverse @ (free - at) + stored

    for _ in range(200):
        law = np.array([exponential_pressure(v, *c) for v, c in zip(h, parameters, strict=True)])
        gradient = inverse @ (h - free) + areas * law[:, 0]
        step = -np.linalg.solve(inverse + np.diag(areas * law[:, 1]), gradient)
        factor, before = 1.0, potential(h)
        while factor > 1e-6 and potential(h + factor * step) > before + 1e-4 * factor * (gradient @ step) + 1e-14 * abs(
            before
        ):
            factor *= 0.5
        h = h + factor * step
        if np.abs(step).max() <= 1e-15 * np.abs(h).max():
            break
    forces = np.array([a * exponential_pressure(v, *c)[0] for a, v, c in zip(areas, h, parameters, strict=True)])
    return forces, h
