"""Central differences with lumped masses on a small structure, with kinematic and penalty contact.

The end of an increment from t_n to t_{n+1} shows u at t_{n+1}, the velocity between the two, the acceleration and the contact force
of the increment; energies stand at t_n. Kinematic contact corrects the predicted place of points so that they end on the surface
(hard) or obey their law there; penalty contact acts by the law at the present place.
"""

import numpy as np

from .system import History

KINEMATIC, PENALTY = "kinematic", "penalty"


def reduced(rows, mass):
    """Rows over the masses: entry (i, j) is what a force at j moves point i by, per time squared."""
    return rows @ (rows / mass).T


def hard_correction(rows, mass, secondary, depth, dt):
    """Accelerations of hard kinematic contact: forces that would bring every secondary node back, resisted by both sides. Points that
    would be pulled, because others push their primary away, take no part.

    `secondary[i]` is the degree of freedom of point i's own node; the other entries of its row are the shape functions of the primary.
    """
    active = depth > 0.0
    while True:
        correction, forces = corrected(rows, mass, secondary, depth, dt, np.flatnonzero(active))
        pulled = active & (forces < 0.0)
        if not pulled.any():
            return correction, forces
        active &= ~pulled


def corrected(rows, mass, secondary, depth, dt, active):
    """The corrector with these points."""
    push, inertia, correction = np.zeros(len(mass)), mass.copy(), np.zeros(len(mass))
    primary = {i: [j for j in np.flatnonzero(rows[i]) if j != secondary[i]] for i in active}
    for i in active:
        for j in primary[i]:
            push[j] += abs(rows[i, j]) * mass[secondary[i]] * depth[i] / dt**2
            inertia[j] += abs(rows[i, j]) * mass[secondary[i]]
    moved = np.where(push > 0.0, push / inertia, 0.0)
    forces = np.zeros(len(depth))
    for i in active:
        sign = -np.sign(rows[i, secondary[i]])
        back = depth[i] / dt**2 - sum(abs(rows[i, j]) * moved[j] for j in primary[i])
        correction[secondary[i]] += sign * back
        forces[i] = mass[secondary[i]] * back
        correction[primary[i]] = -sign * moved[primary[i]]
    return correction, forces


def soft_forces(law, areas, rows, mass, predicted, dt, tension=False, damping=None, present=None):
    """Forces F with `h = predicted - dt^2 rows M^-1 rows^T F`, `F = A p(h) + c (h - present) / dt`."""
    coupling = dt**2 * reduced(rows, mass)
    forces = np.zeros(len(areas))
    c = np.zeros(len(areas)) if damping is None else damping
    h = predicted.copy()
    for _ in range(500):
        values = [law(x) for x in h]
        p, slope = (np.array([v[k] for v in values]) for k in (0, 1))
        touching = np.array([tension or x > law.onset for x in h])
        target = areas * p + np.where(touching, c * (h - (present if present is not None else h)) / dt, 0.0)
        gradient = areas * slope + np.where(touching, c / dt, 0.0)
        residual = h - predicted + coupling @ target
        step = np.linalg.solve(np.eye(len(h)) + coupling @ np.diag(gradient), residual)
        scale = 1.0
        while scale > 1e-10:
            trial = h - scale * step
            again = np.array([a * law(x)[0] for a, x in zip(areas, trial, strict=True)])
            again = again + np.where(
                [tension or x > law.onset for x in trial],
                c * (trial - (present if present is not None else trial)) / dt,
                0.0,
            )
            if (
                np.abs(trial - predicted + coupling @ again).max() <= np.abs(residual).max() * (1.0 - 1e-4 * scale)
                or not residual.any()
            ):
                break
            scale *= 0.5
        h, forces = trial, again
        if np.abs(scale * step).max() <= 1e-16 * max(np.abs(h).max(), np.abs(predicted).max(), 1e-300):
            break
    return forces, h


class Explicit:
    """State of a march. `secondary`: degree of freedom of each point's own node. `fraction`: critical damping fraction of penalties and
    softened laws; `coefficient`: their damping pressure per velocity; `clip`: whether contact cannot pull."""

    def __init__(self, structure, velocity, enforcement, secondary=None, fraction=0.0, coefficient=0.0, clip=True):
        self.s, self.enforcement = structure, enforcement
        self.mass = structure.nodal
        self.u, self.v = np.zeros(len(self.mass)), np.array(velocity, float)
        self.secondary = [0] * len(structure.contact.initial) if secondary is None else secondary
        self.fraction, self.coefficient, self.clip = fraction, coefficient, clip
        self.time, self.size = 0.0, None
        self.viscous, self.work, self.lost = 0.0, 0.0, 0.0

    def overclosure(self, u):
        """Of every point."""
        return self.s.contact.initial + self.s.contact.rows @ u

    def viscosity(self, slope):
        """Force per velocity of each point, given the stiffness of its law per area."""
        c = self.s.contact
        own = np.array([self.mass[i] for i in self.secondary])
        return self.coefficient * c.areas + 2.0 * self.fraction * np.sqrt(own * c.areas * slope)

    def penalty(self, h):
        """Forces at the present place, and their viscous part."""
        c = self.s.contact
        p, slope = c.pressures(h)
        touching = (h > c.law.onset) | getattr(c.law, "tension", False)
        viscous = np.where(touching, self.viscosity(slope) * (c.rows @ self.v), 0.0)
        force = c.areas * p + viscous
        if self.clip and not getattr(c.law, "tension", False):
            force = np.maximum(force, 0.0)
        return force, force - c.areas * p

    def advance(self, dt, history):
        """One increment."""
        s, c = self.s, self.s.contact
        mean = dt if self.size is None else 0.5 * (self.size + dt)
        internal = s.stiffness @ self.u + s.damping @ self.v
        a = (s.force(self.time) - internal) / self.mass
        h = self.overclosure(self.u)
        viscous = np.zeros(len(h))
        if self.enforcement == PENALTY:
            force, viscous = self.penalty(h)
            a = a - (c.rows.T @ force) / self.mass
        else:
            square = mean * dt
            predicted = self.overclosure(self.u + dt * self.v + square * a)
            if c.law is None:
                correction, force = hard_correction(c.rows, self.mass, self.secondary, predicted, np.sqrt(square))
                a = a + correction
            else:
                tension = getattr(c.law, "tension", False)
                damping = None
                if self.coefficient or self.fraction:
                    damping = self.viscosity(c.pressures(np.maximum(h, 0.0))[1])
                force, _ = soft_forces(
                    c.law, c.areas, c.rows, self.mass, predicted, np.sqrt(square), tension, damping, h
                )
                a = a - (c.rows.T @ force) / self.mass
        before = self.v
        self.v = self.v + mean * a
        self.keep(history, before, a, force, viscous, h)
        self.u = self.u + dt * self.v
        self.time, self.size = self.time + dt, dt
        history.time.append(self.time)
        history.displacement.append(self.u.copy())
        history.overclosure.append(self.overclosure(self.u))

    def keep(self, history, before, a, force, viscous, h):
        """Velocity, acceleration, force and energies of an increment."""
        s, c = self.s, self.s.contact
        history.velocity.append(self.v.copy())
        history.acceleration.append(a.copy())
        history.contact_force.append(force.copy())
        history.kinetic.append(0.5 * before @ (self.mass * self.v))
        history.strain.append(0.5 * self.u @ s.stiffness @ self.u)
        history.stored.append(c.energy(h) if self.enforcement == PENALTY else 0.0)
        history.impact_loss.append(0.0)
        history.viscous.append(self.viscous)
        if self.enforcement == PENALTY:
            self.viscous += float(viscous @ (c.rows @ (0.5 * (before + self.v)))) * (self.size or 0.0)


def march(structure, velocity, dt, increments, enforcement, **options):
    """History of equal increments."""
    run, history = Explicit(structure, velocity, enforcement, **options), History()
    for _ in range(increments):
        run.advance(dt, history)
    return history.arrays()
