"""Contact of constrained structures with free motions: a state that fulfils every condition, and the proof that it does.

The problem is convex, so a state that keeps equilibrium, constraints and the law of every point is the solution; how it was found
does not matter. It is looked for by switching states from a smoothed guess, and if that fails among all combinations of states.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from . import laws
from .enumeration import state_count

CERTAIN = 1e-10
COMBINATIONS_MAX = 20000


@dataclass
class State:
    """Solution: displacements, multipliers of the constraints, contact forces and overclosures, and how it was found."""

    displacement: np.ndarray
    multipliers: np.ndarray
    forces: np.ndarray
    overclosures: np.ndarray
    combinations: int


class Contact:
    """The contact problem of a structure under one load."""

    def __init__(self, structure, load, values):
        self.structure, self.load, self.values = structure, load, values
        self.laws = [structure.deck.pairs[p].law for p in structure.points.pairs]
        self.areas = structure.points.areas
        self.unloaded = structure.unloaded(load, values)
        self.free = structure.points.overclosures + structure.rows @ self.unloaded[: len(load)]
        self.weight = np.diag(structure.compliance).mean()
        self.balance = structure.held.T @ load
        slip = structure.loose.T @ load
        if slip.size and np.abs(slip).max() > 1e-11 * np.abs(load).max():
            raise ArithmeticError("a load acts along a motion that nothing holds")

    def equilibrium(self):
        """The solution; ArithmeticError when none is found."""
        state = None
        for soft in (1e-3, 1e-5, 1e-7):
            state = state or self.switching(self.smoothed_guess(soft / self.weight))
        if state is None:
            state = self.enumeration()
        if state is None:
            raise ArithmeticError("no state keeps all conditions")
        return state

    def smoothed_guess(self, soft):
        """Overclosures with weak springs on the free motions and stiff springs for hard points, by Newton's method."""
        s = self.structure
        free = self.free + s.coupling @ self.balance / soft
        compliance = s.compliance + s.coupling @ s.coupling.T / soft + 1e-7 * self.weight * np.eye(len(free))
        inverse = np.linalg.inv(compliance)
        stiff = 1e3 / self.weight

        def potential(at):
            stored = sum(laws.energy(law, a, h, stiff) for law, a, h in zip(self.laws, self.areas, at, strict=True))
            return 0.5 * (free - at) @ inverse @ (free - at) + stored

        h = self.free.copy()
        for _ in range(60):
            line = np.array(
                [laws.tangent(law, a, v, stiff) for law, a, v in zip(self.laws, self.areas, h, strict=True)]
            )
            gradient = inverse @ (h - free) + line[:, 0] + line[:, 1] * h
            step = -np.linalg.solve(inverse + np.diag(line[:, 1]), gradient)
            factor, before, slope = 1.0, potential(h), gradient @ step
            while factor > 1e-6 and potential(h + factor * step) > before + 1e-4 * factor * slope:
                factor *= 0.5
            h = h + factor * step
            if np.abs(step).max() <= 1e-9 * np.abs(h).max():
                break
        return h

    def switching(self, h):
        """Newton's method on the laws: each point takes the piece in which it was found, until none changes."""
        hard = np.array([laws.is_hard(law) for law in self.laws])
        active = hard & (h > 0.0)
        state = None
        for count in range(1, 60):
            lines = [laws.tangent(law, a, v, 0.0) for law, a, v in zip(self.laws, self.areas, h, strict=True)]
            forces, h, motion = self.linear(lines, active)
            before, state = state, self.certified(forces, motion, count)
            if before:
                return state or before  # one iteration more than enough: curved laws converge quadratically
            active = hard & (forces / self.areas.mean() * self.weight + np.where(active, 0.0, h) > 0.0)
        return state

    def enumeration(self):
        """Every combination of open, closed and (tables) segments, unless a law is curved or there are too many."""
        if any(not isinstance(law, laws.Law) for law in self.laws):
            return None
        counts = [state_count(law) for law in self.laws]
        if np.prod(counts, dtype=float) > COMBINATIONS_MAX:
            return None
        for tried, combination in enumerate(itertools.product(*map(range, counts)), 1):
            lines, active = [], np.zeros(len(counts), dtype=bool)
            for i, (law, state) in enumerate(zip(self.laws, combination, strict=True)):
                piece = law.segments[state - 1] if law.segments and state else None
                lines.append((self.areas[i] * piece.offset, self.areas[i] * piece.slope) if piece else (0.0, 0.0))
                active[i] = state > 0 and not law.segments
            forces, _, motion = self.linear(lines, active)
            if state := self.certified(forces, motion, tried):
                return state
        return None

    def linear(self, lines, active):
        """Forces, overclosures and motions when point i follows `F = c + k h`, or has h = 0 where active.

        Least squares: dependent points share their force, motions that the closed points do not hold stay at zero.
        """
        s, w = self.structure, self.weight
        count, motions = len(self.free), s.coupling.shape[1]
        offset, slope = np.array(lines).T
        matrix = np.zeros((count + motions, count + motions))
        right = np.zeros(count + motions)
        share = np.where(active, 0.0, 1.0 / (1.0 + slope * w))
        follow = np.where(active, 1.0 / w, slope * share)
        matrix[:count, :count] = np.diag(share) + follow[:, None] * s.compliance
        matrix[:count, count:] = -follow[:, None] * w * s.coupling
        right[:count] = np.where(active, 0.0, offset * share) + follow * self.free
        matrix[count:, :count] = s.coupling.T
        right[count:] = self.balance
        solved = np.linalg.lstsq(matrix, right, rcond=1e-12)[0]
        forces, motion = solved[:count], w * solved[count:]
        return forces, self.free - s.compliance @ forces + s.coupling @ motion, motion

    def certified(self, forces, motion, combinations):
        """The state if it keeps every condition of the full, uncondensed problem; None otherwise."""
        s = self.structure
        count = len(self.load)
        forces = np.where(np.abs(forces) < 1e-14 * (np.abs(forces).max() or 1.0), 0.0, forces)
        everything = self.unloaded - s.influence @ forces
        u = everything[:count] + s.held @ motion
        multipliers = s.scale * everything[count : count + len(s.constraints)]
        h = s.points.overclosures + s.rows @ u
        length = max(np.abs(u).max(), np.abs(s.points.overclosures).max())
        strength = max(np.abs(forces).max(), np.abs(self.load).max(), 1e-3 * length / self.weight)
        for law, area, overclosure, force in zip(self.laws, self.areas, h, forces, strict=True):
            if not laws.violation(law, area, overclosure, force, length, strength) <= CERTAIN:
                return None
        inner = s.matrix @ u
        residual = inner + s.constraints.T @ multipliers + s.rows.T @ forces - self.load
        target = np.zeros(len(s.constraints))
        target[: len(s.prescribed)] = [self.values[d] for d in s.prescribed]
        if np.abs(residual).max() > CERTAIN * max(strength, np.abs(inner).max()):
            return None
        if target.size and np.abs(s.constraints @ u - target).max() > CERTAIN * length:
            return None
        return State(u, multipliers, forces, h, combinations)
