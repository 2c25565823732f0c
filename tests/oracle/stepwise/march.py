"""The oracle marches through a plan: in each increment it looks for the state of every point that keeps all its conditions."""

from dataclasses import dataclass

import numpy as np

from .problem import Problem, Unsuitable
from .structure import Structure

AUGMENTATIONS_MAX = 200


@dataclass
class Answer:
    """The end of an increment. Contact arrays are by point; shear is (points, 2); status as in the contact table."""

    step: int
    displacement: np.ndarray
    reaction: np.ndarray
    pressure: np.ndarray
    viscous: np.ndarray
    overclosure: np.ndarray
    allowed: np.ndarray
    shear: np.ndarray
    status: list
    active: np.ndarray


@dataclass
class Memory:
    """What contact keeps from increment to increment, by point."""

    closed: np.ndarray
    latched: np.ndarray
    multiplier: np.ndarray
    overclosure: np.ndarray
    slip: np.ndarray
    origin: np.ndarray


class March:
    """Answers for all increments of a plan, and the augmentations of each step."""

    def __init__(self, plan):
        self.plan, self.structure = plan, Structure(plan)
        s = self.structure
        self.areas, self.pairs, self.size = s.points.areas, s.points.pairs, s.size
        self.behaviors = [plan.behaviors[p] for p in self.pairs]
        self.weight = float(np.diag(s.compliance)[: self.size].mean())

    def run(self):
        """All increments; Unsuitable when one has no answer or several."""
        s, none = self.structure, np.zeros(self.size, dtype=bool)
        zero, pairs_of_numbers = np.zeros(self.size), np.zeros((self.size, 2))
        memory = Memory(none, none, zero, s.initial.copy(), pairs_of_numbers, pairs_of_numbers)
        answers, augmentations, carried = [], [], np.zeros(3 * self.size)
        for number, step in enumerate(self.plan.steps):
            active = np.array([step.active[p] for p in self.pairs])
            # What a removed pair carried goes to zero over the step; it forgets the rest.
            removed = np.where(np.tile(active, 3), 0.0, carried)
            memory.closed, memory.latched = memory.closed & active, memory.latched & active
            memory.multiplier = np.where(active, memory.multiplier, 0.0)
            count = 0
            for increment in range(1, step.increments + 1):
                fraction = increment / step.increments
                given = (1.0 - fraction) * removed
                answer, memory, more, carried = self.increment(number, fraction, memory, active, given)
                answers.append(answer)
                count += more
            augmentations.append(count)
        return answers, augmentations

    def increment(self, number, fraction, memory, active, given):
        """One increment under forces of pairs that go: answer, memory after it, augmentations, contact forces by row."""
        s, step = self.structure, self.plan.steps[number]
        unloaded, load = s.unloaded(number, fraction)
        free = s.rows @ unloaded - s.compliance @ given
        free[: self.size] += s.initial
        allowed = self.allowed(number, fraction)
        duration = step.period / step.increments
        problem = Problem(self, free, allowed, memory, active, step, duration)
        count = 0
        while True:
            solution = problem.solve()
            again = problem.augmented(solution)
            if again is None:
                break
            problem.multiplier, count = again, count + 1
            if count > AUGMENTATIONS_MAX:
                raise Unsuitable("augmentation does not end")
        forces = solution.forces + given
        u = s.displaced(unloaded, forces)
        reaction = s.reactions(u, load, forces)
        shape = (-1, 3)
        slip = solution.slip
        after = Memory(
            solution.closed,
            memory.latched | (solution.closed & np.array([not b.separation for b in self.behaviors])),
            problem.multiplier,
            solution.overclosure,
            slip,
            np.where((memory.closed & solution.closed)[:, None], memory.origin, memory.slip),
        )
        answer = Answer(
            number,
            u.reshape(shape),
            reaction.reshape(shape),
            solution.pressure,
            solution.viscous,
            solution.overclosure,
            allowed,
            solution.shear,
            self.statuses(solution, problem),
            active,
        )
        return answer, after, count, solution.forces

    def allowed(self, number, fraction):
        """Allowable interference of each point."""
        found = np.zeros(self.size)
        for pair, given in enumerate(self.plan.steps[number].interference):
            mine = self.pairs == pair
            if given == "shrink":
                found[mine] = np.maximum(0.0, self.structure.initial[mine]) * (1.0 - fraction)
            elif given is not None:
                found[mine] = given * (1.0 - fraction)
        return found

    def statuses(self, solution, problem):
        """OP, CL, ST, VD."""
        found = []
        for i in range(self.size):
            if solution.closed[i]:
                found.append("ST" if self.behaviors[i].rough else "CL")
            else:
                found.append("VD" if solution.viscous[i] != 0.0 else "OP")
        return found
