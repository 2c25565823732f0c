"""A small structure with contact: matrices, contact rows, and the state that both marches carry."""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Contact:
    """Contact points: overclosure `h = initial + rows @ u`, so the force on u is `-rows.T @ (areas * pressure)`.

    `law` is one law for all points, none for hard contact. `damping` is (mu0, c0, eta) of Abaqus/Standard.
    """

    rows: np.ndarray
    initial: np.ndarray
    areas: np.ndarray
    law: object = None
    damping: tuple | None = None

    def pressures(self, h):
        """Pressure and slope at every point."""
        values = [self.law(x) for x in h]
        return np.array([v[0] for v in values]), np.array([v[1] for v in values])

    def energy(self, h):
        """Energy stored in the law."""
        return (
            0.0 if self.law is None else float(sum(a * self.law.energy(x) for a, x in zip(self.areas, h, strict=True)))
        )

    def viscosity(self, h):
        """Coefficient over the clearance, and its slope over the overclosure."""
        if self.damping is None:
            return np.zeros_like(h), np.zeros_like(h)
        mu0, c0, eta = self.damping
        ramp = mu0 / (c0 * (1.0 - eta))
        c = -h
        mu = np.where(c <= eta * c0, mu0, np.where(c < c0, ramp * (c0 - c), 0.0))
        return mu, np.where((c > eta * c0) & (c < c0), ramp, 0.0)


@dataclass
class Structure:
    """`mass a + damping v + stiffness u = force(t) + contact`; every direction is free."""

    mass: np.ndarray
    stiffness: np.ndarray
    contact: Contact
    damping: np.ndarray | None = None
    force: object = None

    def __post_init__(self):
        if self.damping is None:
            self.damping = np.zeros_like(self.mass)
        if self.force is None:
            size = len(self.mass)
            self.force = lambda t: np.zeros(size)

    @property
    def nodal(self):
        """Row sums of the mass matrix."""
        return self.mass.sum(axis=1)


@dataclass
class History:
    """What a march leaves at the end of every increment: one entry each."""

    time: list = field(default_factory=list)
    displacement: list = field(default_factory=list)
    velocity: list = field(default_factory=list)
    acceleration: list = field(default_factory=list)
    overclosure: list = field(default_factory=list)
    contact_force: list = field(default_factory=list)
    kinetic: list = field(default_factory=list)
    strain: list = field(default_factory=list)
    stored: list = field(default_factory=list)
    impact_loss: list = field(default_factory=list)
    viscous: list = field(default_factory=list)
    events: list = field(default_factory=list)

    def arrays(self):
        """Entries as arrays."""
        for name, value in vars(self).items():
            setattr(self, name, value if name == "events" else np.array(value))
        return self

    @property
    def total(self):
        """Energies that are stored and lost."""
        return self.kinetic + self.strain + self.stored + self.impact_loss + self.viscous


def chain(masses, springs, ground=()):
    """Lumped masses in a row: `springs[i]` between i and i + 1, `ground` as (index, stiffness)."""
    size = len(masses)
    stiffness = np.zeros((size, size))
    for i, k in enumerate(springs):
        stiffness[i : i + 2, i : i + 2] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
    for i, k in ground:
        stiffness[i, i] += k
    return np.diag(np.asarray(masses, dtype=float)), stiffness


def bar(elements, length, area, young, density, consistent=False):
    """Mass and stiffness of a bar of equal two-node elements, from its near end."""
    size = length / elements
    mass, stiffness = np.zeros((elements + 1, elements + 1)), np.zeros((elements + 1, elements + 1))
    unit = density * area * size * (np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0 if consistent else 0.5 * np.eye(2))
    for e in range(elements):
        mass[e : e + 2, e : e + 2] += unit
        stiffness[e : e + 2, e : e + 2] += young * area / size * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return mass, stiffness


def wall(size, gap, area=1.0, law=None, damping=None, node=0, speed_sign=-1.0):
    """One node that meets a fixed wall after `gap`, moving in the direction `speed_sign`."""
    rows = np.zeros((1, size))
    rows[0, node] = speed_sign
    return Contact(rows, np.array([-gap]), np.array([area]), law, damping)
