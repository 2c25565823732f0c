"""Pressures over overclosures for the dynamic oracle: value, slope and energy per area, written from the formulas alone."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Linear:
    """`p = k h`; below zero nothing, unless the surfaces cannot part."""

    stiffness: float
    tension: bool = False

    def __call__(self, h):
        """Pressure and slope."""
        return (self.stiffness * h, self.stiffness) if h > 0.0 or self.tension else (0.0, 0.0)

    def energy(self, h):
        """Energy stored per area."""
        return 0.5 * self.stiffness * h * h if h > 0.0 or self.tension else 0.0

    onset = 0.0


@dataclass(frozen=True)
class Table:
    """Straight lines through (pressure, overclosure); the last slope goes on, nothing before the first point."""

    points: tuple

    @property
    def onset(self):
        """Overclosure at which pressure begins."""
        return self.points[0][1]

    def pieces(self):
        """(pressure, overclosure, slope, end) of every line."""
        lines = []
        for (p, h), (q, g) in zip(self.points, self.points[1:], strict=False):
            lines.append([p, h, (q - p) / (g - h), g])
        lines[-1][3] = math.inf
        return lines

    def __call__(self, h):
        """Pressure and slope."""
        for p, start, slope, end in self.pieces():
            if start <= h <= end:
                return p + slope * (h - start), slope
        return 0.0, 0.0

    def energy(self, h):
        """Energy stored per area."""
        total = 0.0
        for p, start, slope, end in self.pieces():
            x = min(h, end) - start
            if x > 0.0:
                total += p * x + 0.5 * slope * x * x
        return total


@dataclass(frozen=True)
class Exponential:
    """`p0 / (e - 1) u (exp(u) - 1)` with `u = 1 + h / c0`; straight beyond 6 c0, or where its slope reaches `ceiling`."""

    clearance: float
    pressure: float
    ceiling: float = math.inf

    @property
    def onset(self):
        """Overclosure at which pressure begins."""
        return -self.clearance

    @property
    def last(self):
        """Where the straight line begins, as u."""
        high = 7.0
        if self.curve(high)[1] <= self.ceiling:
            return high
        low = 0.0
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.curve(middle)[1] < self.ceiling else (low, middle)
        return 0.5 * (low + high)

    def curve(self, u):
        """Pressure and slope of the curved part."""
        a = self.pressure / (math.e - 1.0)
        return a * u * math.expm1(u), a / self.clearance * (math.expm1(u) + u * math.exp(u))

    def curved_energy(self, u):
        """Its integral: a series where the closed form cancels."""
        scale = self.pressure / (math.e - 1.0) * self.clearance
        if u < 0.5:
            return scale * sum(u ** (k + 2) / (math.factorial(k) * (k + 2)) for k in range(1, 25))
        return scale * ((u - 1.0) * math.exp(u) + 1.0 - 0.5 * u * u)

    def __call__(self, h):
        """Pressure and slope."""
        u, last = 1.0 + h / self.clearance, self.last
        if u <= 0.0:
            return 0.0, 0.0
        if u <= last:
            return self.curve(u)
        p, slope = self.curve(last)
        return p + slope * self.clearance * (u - last), slope

    def energy(self, h):
        """Energy stored per area."""
        u, last = 1.0 + h / self.clearance, self.last
        if u <= 0.0:
            return 0.0
        if u <= last:
            return self.curved_energy(u)
        (p, slope), x = self.curve(last), self.clearance * (u - last)
        return self.curved_energy(last) + p * x + 0.5 * slope * x * x
