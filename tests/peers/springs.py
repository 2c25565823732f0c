"""Statics of a small deck with the contact laws of CalculiX's node-to-surface springs, or with ours; dense Newton method.

CalculiX 2.20, LINEAR with the items K and s:  p = K h (1/2 + atan(h / e) / pi),  e = pi s / K,  also for h < 0, where it pulls
with up to s.
A spring exists only where the clearance is below c0 sqrt(area), c0 = 0.001 unless a third item gives it.
Ours:  p = K h for h > 0, else 0.
EXPONENTIAL, the same in both:  p = p0 100^(h / c0),  cut to 0 below h = -c0.
"""

import math
from dataclasses import dataclass

import numpy as np

# Newton ends when forces balance to this part of the largest force of the structure: a rounding of its terms.
BALANCE = 1e-14
ITERATIONS_MAX = 60


@dataclass(frozen=True)
class Exact:
    """p = K h for h > 0."""

    slope: float

    def pressure(self, h):
        """Pressures."""
        return np.where(h > 0.0, self.slope * h, 0.0)

    def stiffness(self, h):
        """Slopes."""
        return np.where(h > 0.0, self.slope, 0.0)


@dataclass(frozen=True)
class Smoothed:
    """The law of the springs, for areas that the cut-off needs."""

    slope: float
    tension: float
    areas: np.ndarray
    cut_off: float = 1e-3

    def curve(self, h):
        """Pressures without the cut-off."""
        return self.slope * h * (0.5 + np.arctan(h / self.width()) / math.pi)

    def width(self):
        """e, the overclosure over which the curve bends."""
        return math.pi * self.tension / self.slope

    def exists(self, h):
        """Which springs exist."""
        return h > -self.cut_off * np.sqrt(self.areas)

    def pressure(self, h):
        """Pressures."""
        return np.where(self.exists(h), self.curve(h), 0.0)

    def stiffness(self, h):
        """Slopes."""
        ratio = h / self.width()
        slope = self.slope * (0.5 + np.arctan(ratio) / math.pi + ratio / (math.pi * (1.0 + ratio**2)))
        return np.where(self.exists(h), slope, 0.0)


@dataclass(frozen=True)
class Exponential:
    """p = p0 100^(h / c0) down to h = -c0."""

    clearance: float
    pressure_at_touch: float

    @property
    def slope(self):
        """Slope at touch, for the start."""
        return self.pressure_at_touch * math.log(100.0) / self.clearance

    def pressure(self, h):
        """Pressures."""
        value = self.pressure_at_touch * np.exp(math.log(100.0) * np.minimum(h / self.clearance, 5.0))
        return np.where(h > -self.clearance, value, 0.0)

    def stiffness(self, h):
        """Slopes."""
        return self.pressure(h) * math.log(100.0) / self.clearance


def free_basis(deck):
    """Displacements u = T q + u0 that keep supports and equations: T (dofs, free) and u0."""
    count = len(deck.forces)
    constraints = [{dof: 1.0} for dof in deck.fixed] + [dict(terms) for terms in deck.equations]
    values = list(deck.fixed.values()) + [0.0] * len(deck.equations)
    matrix = np.zeros((len(constraints), count))
    for row, terms in enumerate(constraints):
        for dof, coefficient in terms.items():
            matrix[row, dof] += coefficient
    u0 = np.linalg.lstsq(matrix, np.array(values), rcond=None)[0]
    _, singular, right = np.linalg.svd(matrix)
    rank = int((singular > 1e-12 * singular[0]).sum())
    return right[rank:].T, u0


def solve(deck, law, areas):
    """Displacements by dof and overclosures by point."""
    basis, u0 = free_basis(deck)
    stiffness = basis.T @ deck.stiffness @ basis
    load = basis.T @ (deck.forces - deck.stiffness @ u0)
    rows = deck.rows @ basis
    start = deck.initial + deck.rows @ u0
    q = np.zeros(basis.shape[1])
    # Every point a spring of that slope at first: so a body that only contact holds is held.
    tangent = np.full(len(areas), law.slope)
    pressure, h = law.slope * start, start
    for _ in range(ITERATIONS_MAX):
        residual = load - stiffness @ q - rows.T @ (areas * pressure)
        moved = np.abs(start) + np.abs(rows) @ np.abs(q)
        scale = max(np.abs(load).max(), (np.abs(stiffness) @ np.abs(q)).max(), (areas * law.slope * moved).max())
        if np.array_equal(pressure, law.pressure(h)) and np.abs(residual).max() <= BALANCE * scale:
            return basis @ q + u0, h
        q = q + np.linalg.solve(stiffness + rows.T @ ((areas * tangent)[:, None] * rows), residual)
        h = start + rows @ q
        pressure, tangent = law.pressure(h), law.stiffness(h)
    raise ArithmeticError("Newton's method did not converge")
