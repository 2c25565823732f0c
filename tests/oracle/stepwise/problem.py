"""One increment of the oracle: the state of every point that keeps all its conditions."""

import itertools
from dataclasses import dataclass

import numpy as np

from . import curves

CERTAIN = 1e-11
CHANGES_MAX = 12


class Unsuitable(Exception):
    """The plan has no clear answer: another one is drawn."""


@dataclass
class Solution:
    """State of all points: forces by row, what they consist of, and who is closed."""

    forces: np.ndarray
    pressure: np.ndarray
    viscous: np.ndarray
    overclosure: np.ndarray
    slip: np.ndarray
    shear: np.ndarray
    closed: np.ndarray


class Problem:
    """One increment with given multipliers."""

    def __init__(self, march, free, allowed, memory, active, step, duration):
        self.march, self.free, self.allowed, self.memory, self.active = march, free, allowed, memory, active
        self.step, self.duration = step, duration
        self.size, self.areas = march.size, march.areas
        self.compliance = march.structure.compliance
        self.multiplier = memory.multiplier.copy()
        self.behaviors = march.behaviors
        self.controls = [step.controls[p] for p in march.pairs]
        self.hard = np.array([b.kind == "hard" for b in self.behaviors])
        self.length = max(np.abs(free[: self.size]).max(), 1e-12)
        self.weight = march.weight

    def curve(self, i):
        """Pressure over overclosure of a point that is not hard."""
        b, scale = self.behaviors[i], self.controls[i].scale or 1.0
        if b.kind == "linear":
            return curves.line(b.stiffness)
        stiffness = b.stiffness * scale
        if b.kind == "nonlinear":
            return curves.nonlinear(stiffness, b.clearance, *b.nonlinear)
        shift = self.multiplier[i] / stiffness if b.kind == "augmented" else 0.0
        return curves.line(stiffness, b.clearance + shift)

    def dashpot(self, i):
        """Viscous pressure of a point, none without damping."""
        b = self.behaviors[i]
        if b.damping is None or not self.active[i]:
            return None
        return curves.dashpot(*b.damping, self.memory.overclosure[i], self.duration)

    def solve(self):
        """The state that keeps all conditions."""
        if any(c.modified for c in self.controls):
            return self.state_table()
        rough = any(b.rough for b in self.behaviors)
        found = None if rough else self.switching()
        return found if found is not None else self.enumeration()

    def switching(self):
        """Active sets from several starts; frictionless problems without damping have one answer at most."""
        for start in (self.memory.closed, self.free[: self.size] > self.allowed, np.ones(self.size, dtype=bool)):
            closed = (start | self.memory.latched) & self.active
            for _ in range(30):
                solution = self.with_closed(closed)
                if solution is None:
                    break
                if self.keeps(solution):
                    return solution
                closed = self.next_closed(solution) & self.active
        return None

    def next_closed(self, solution):
        """Who would be closed next: hard points by the signs of force and overclosure, others by their curve."""
        pushed = solution.pressure * self.areas * self.weight + np.where(
            solution.closed, 0.0, solution.overclosure - self.allowed
        )
        curved = np.array([not hard and solution.pressure[i] > 0.0 for i, hard in enumerate(self.hard)])
        return np.where(self.hard, pushed > 0.0, curved) | self.memory.latched

    def enumeration(self):
        """Every combination of closed points; the one that keeps all conditions, or Unsuitable."""
        open_to_choice = np.flatnonzero(self.active & ~self.memory.latched)
        accepted = []
        for chosen in itertools.product((False, True), repeat=len(open_to_choice)):
            closed = self.memory.latched & self.active
            closed[open_to_choice] = chosen
            solution = self.with_closed(closed)
            if solution is not None and self.keeps(solution):
                accepted.append(solution)
        if not accepted:
            raise Unsuitable("no combination of contact states keeps all conditions")
        for other in accepted[1:]:
            if np.abs(other.forces - accepted[0].forces).max() * self.weight > 1e-8 * self.length:
                raise Unsuitable("two combinations of contact states keep all conditions")
        return accepted[0]

    def with_closed(self, closed):
        """Equilibrium with these points closed: hard ones at their wall, rough ones stuck, curves as they are. Newton's method."""
        n, c = self.size, self.compliance
        forces = np.zeros(3 * n)
        curve = {i: self.curve(i) for i in range(n) if not self.hard[i] and self.active[i]}
        dashpots = {i: d for i in range(n) if (d := self.dashpot(i)) is not None}
        stuck = closed & np.array([b.rough for b in self.behaviors])
        old = np.where(self.memory.closed[:, None], self.memory.origin, self.memory.slip)
        best = None
        for _ in range(60):
            z = self.free - c @ forces
            residual, jacobian = np.zeros(3 * n), np.zeros((3 * n, 3 * n))
            for i in range(n):
                h, area = z[i], self.areas[i]
                viscous, rate = dashpots[i](h) if i in dashpots else (0.0, 0.0)
                if self.hard[i] and closed[i]:
                    # In lengths, brought to forces by the mean compliance.
                    residual[i] = (self.allowed[i] - h) / self.weight
                    jacobian[i] = c[i] / self.weight
                else:
                    value, slope = curve[i](h - self.allowed[i]) if i in curve else (0.0, 0.0)
                    residual[i] = forces[i] - area * (value + viscous)
                    jacobian[i] = area * (slope + rate) * c[i]
                    jacobian[i, i] += 1.0
                for j, row in enumerate((n + i, 2 * n + i)):
                    if stuck[i]:
                        residual[row] = (old[i, j] - z[row]) / self.weight
                        jacobian[row] = c[row] / self.weight
                    else:
                        residual[row] = forces[row]
                        jacobian[row, row] = 1.0
            size = np.abs(residual).max() * self.weight / self.length
            if best is not None and size >= best[0] and best[0] < CERTAIN:
                break
            if best is None or size < best[0]:
                best = (size, forces.copy())
            try:
                forces = forces - np.linalg.solve(jacobian, residual)
            except np.linalg.LinAlgError:
                return None
        if best[0] > CERTAIN:
            return None
        return self.solution(best[1], closed, curve, dashpots)

    def solution(self, forces, closed, curve, dashpots):
        """Forces taken apart."""
        n = self.size
        z = self.free - self.compliance @ forces
        viscous = np.array([dashpots[i](z[i])[0] if i in dashpots else 0.0 for i in range(n)])
        pressure = forces[:n] / self.areas - viscous
        for i, evaluate in curve.items():
            pressure[i] = evaluate(z[i] - self.allowed[i])[0]
        pressure = np.where(self.hard & ~closed, 0.0, pressure)
        told = np.where(self.hard, closed, pressure > 0.0) & self.active
        shear = np.column_stack([forces[n : 2 * n], forces[2 * n :]]) / self.areas[:, None]
        slip = np.column_stack([z[n : 2 * n], z[2 * n :]])
        solution = Solution(forces, pressure, viscous, z[:n], slip, shear, told)
        solution.stuck = closed
        return solution

    def keeps(self, solution):
        """Whether every point keeps its conditions; Unsuitable when one of them hangs by a hair."""
        for i in range(self.size):
            if not self.active[i] or (self.memory.latched[i] and solution.closed[i]):
                continue
            if self.hard[i]:
                over = (solution.overclosure[i] - self.allowed[i]) / self.length
                push = solution.pressure[i] * self.areas[i] * self.weight / self.length
                measure = push if solution.closed[i] else -over
            else:
                # A rough point sticks where its curve pushes, and nowhere else.
                if not self.behaviors[i].rough:
                    continue
                measure = 1.0 if solution.closed[i] == solution.stuck[i] else -1.0
            if abs(measure) < 1e-9:
                raise Unsuitable("a point hangs between open and closed")
            if measure < 0.0:
                return False
        return True

    def state_table(self):
        """Modified hard contact: statuses change by the table of the manual until none does, at most CHANGES_MAX times."""
        start = self.memory.closed.copy()
        now = start.copy()
        for _ in range(CHANGES_MAX):
            solution = self.with_closed(now & self.active)
            if solution is None:
                raise Unsuitable("no equilibrium")
            change = self.changes(solution, now, start)
            if not change.any():
                return solution
            now = now ^ change
        raise Unsuitable("chatter")

    def changes(self, solution, now, start):
        """Points whose status changes, by the table; tolerated violations change too where there are more than MAXCHP."""
        certain, tolerated = np.zeros(self.size, dtype=bool), np.zeros(self.size, dtype=bool)
        for i in np.flatnonzero(self.active):
            count, overclosure_max, tension_max = self.controls[i].modified or (0, 0.0, 0.0)
            h, p, changed = solution.overclosure[i] - self.allowed[i], solution.pressure[i], now[i] != start[i]
            clear(h if not now[i] else p * self.areas[i] * self.weight, self.length)
            if now[i]:
                certain[i] = p <= 0.0 if changed else p < -tension_max
                tolerated[i] = not changed and -tension_max <= p < 0.0
                clear((p + tension_max) * self.areas[i] * self.weight, self.length)
            else:
                certain[i] = h > 0.0 if changed else h > overclosure_max
                tolerated[i] = not changed and 0.0 < h <= overclosure_max
                clear(h - overclosure_max, self.length)
        for pair in set(self.march.pairs):
            mine = self.march.pairs == pair
            count = (self.step.controls[pair].modified or (0, 0.0, 0.0))[0]
            if (tolerated & mine).sum() > count:
                certain |= tolerated & mine
        return certain

    def augmented(self, solution):
        """Multipliers for another series, or none when every penetration is within its tolerance."""
        points = [i for i, b in enumerate(self.behaviors) if b.kind == "augmented" and self.active[i]]
        over = False
        for i in points:
            h, tolerance = solution.overclosure[i] - self.allowed[i], self.controls[i].tolerance
            clear(h - tolerance, self.length)
            over = over or h > tolerance
            # A point that pushes may be no further apart either.
            if solution.pressure[i] > 0.0:
                apart = -(h + self.behaviors[i].clearance)
                clear(apart - tolerance, self.length)
                over = over or apart > tolerance
        if not over:
            return None
        found = self.multiplier.copy()
        for i in points:
            found[i] = solution.pressure[i]
        return found


def clear(distance, length):
    """Raises where a decision hangs by a hair."""
    if abs(distance) < 1e-9 * length:
        raise Unsuitable("a decision hangs by a hair")
