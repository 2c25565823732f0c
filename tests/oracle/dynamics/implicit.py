"""The implicit operator of Hilber, Hughes and Taylor on a small structure, with the impact algorithm for hard contact.

`M a1 + (1 + alpha) r1 - alpha r0 + constraint forces = 0`, where r is internal less external force. Contact that is a law of the
overclosure is part of r. Hard points are constraints with multipliers; they change at events inside an increment: the time at which
they change is interpolated, the increment ends there, velocities jump by the impulse equations, accelerations follow from the
equations of motion, and the march goes on for the rest of the increment.
"""

import numpy as np

from .system import History

EVENTS_MAX = 60


class Implicit:
    """State of a march."""

    def __init__(self, structure, displacement, velocity, alpha=-0.05, restart=1.0):
        """`restart`: part of the rest of an increment that the first step after an event takes."""
        self.s, self.alpha, self.restart = structure, alpha, restart
        self.beta, self.gamma = 0.25 * (1.0 - alpha) ** 2, 0.5 - alpha
        self.time = 0.0
        self.u, self.v = np.array(displacement, float), np.array(velocity, float)
        contact = structure.contact
        self.offset = np.zeros(len(contact.initial))
        self.closed = np.zeros(len(contact.initial), bool)
        self.multiplier = np.zeros(len(contact.initial))
        self.loss, self.viscous, self.events = 0.0, 0.0, []
        # Points that open and close again and again at one time: they stay closed until time goes on.
        self.forget()
        self.accelerate()

    def forget(self):
        """Time goes on: nothing has opened at this time yet, and nothing is kept closed."""
        self.opened, self.kept = (np.zeros(len(self.s.contact.initial), bool) for _ in range(2))

    def overclosure(self, u):
        """Of every point, with the shifts that events have made."""
        return self.s.contact.initial + self.offset + self.s.contact.rows @ u

    def residual(self, time, u, v):
        """Internal less external force, and its tangents over u and v."""
        s, c = self.s, self.s.contact
        force = s.stiffness @ u + s.damping @ v - s.force(time)
        over_u, over_v = s.stiffness.copy(), s.damping.copy()
        h = self.overclosure(u)
        if c.law is not None:
            p, slope = c.pressures(h)
            force = force + c.rows.T @ (c.areas * p)
            over_u += c.rows.T @ np.diag(c.areas * slope) @ c.rows
        if c.damping is not None:
            mu, ramp = c.viscosity(h)
            speed = c.rows @ v
            force = force + c.rows.T @ (c.areas * mu * speed)
            over_u += c.rows.T @ np.diag(c.areas * ramp * speed) @ c.rows
            over_v += c.rows.T @ np.diag(c.areas * mu) @ c.rows
        return force, over_u, over_v

    def constrained(self, matrix, right, values):
        """Solves with the closed points' rows as constraints `rows x = values`; returns x and the multipliers of all points."""
        rows = self.s.contact.rows[self.closed]
        size, count = len(right), len(rows)
        whole = np.block([[matrix, rows.T], [rows, np.zeros((count, count))]])
        solved = np.linalg.solve(whole, np.concatenate([right, values]))
        multipliers = np.zeros(len(self.closed))
        multipliers[self.closed] = solved[size:]
        return solved[:size], multipliers

    def accelerate(self):
        """Accelerations from the equations of motion; points that would be pulled open, unless they have just done so in vain."""
        while True:
            force, _, _ = self.residual(self.time, self.u, self.v)
            self.a, self.multiplier = self.constrained(self.s.mass, -force, np.zeros(self.closed.sum()))
            pulled = self.closed & (self.multiplier < -self.rounding(self.s.mass @ np.abs(self.a))) & ~self.kept
            if not pulled.any():
                return
            self.closed &= ~pulled
            self.opened |= pulled

    def impulse(self, candidates):
        """Velocities after impact; points whose impulse would pull take no part."""
        if not candidates.any():
            return
        acting = candidates.copy()
        while True:
            rows = self.s.contact.rows[acting]
            if not len(rows):
                return
            inverse = np.linalg.solve(self.s.mass, rows.T)
            impulses = np.linalg.lstsq(rows @ inverse, rows @ self.v, rcond=None)[0]
            if (impulses >= 0.0).all():
                break
            acting[np.flatnonzero(acting)[impulses < 0.0]] = False
        after = self.v - inverse @ impulses
        lost = 0.5 * (self.v @ self.s.mass @ self.v - after @ self.s.mass @ after)
        self.loss += lost
        self.events.append((self.time, float(impulses.sum()), lost))
        self.v = after
        # A closed point that took no part moves away.
        leaving = self.closed & ~acting & (self.s.contact.rows @ self.v < 0.0) & ~self.kept
        self.opened |= leaving
        self.closed &= ~leaving

    def trial(self, dt):
        """(u, v, a, multipliers) at the end of a step with the present contact set."""
        s, c = self.s, self.s.contact
        al, be, ga = self.alpha, self.beta, self.gamma
        before, _, _ = self.residual(self.time, self.u, self.v)
        a, multipliers, last = self.a.copy(), self.multiplier, np.inf
        for _ in range(200):
            u = self.u + dt * self.v + dt * dt * ((0.5 - be) * self.a + be * a)
            v = self.v + dt * ((1.0 - ga) * self.a + ga * a)
            force, over_u, over_v = self.residual(self.time + dt, u, v)
            tangent = s.mass + (1.0 + al) * (be * dt * dt * over_u + ga * dt * over_v)
            right = -(s.mass @ a + (1.0 + al) * force - al * before)
            gap = -self.overclosure(u)[self.closed] / (be * dt * dt)
            change, multipliers = self.constrained(tangent, right, gap)
            a = a + change
            if c.law is None and c.damping is None and _:
                break
            # Rounding is reached where corrections no longer shrink.
            size = np.abs(change).max() / (np.abs(a).max() + 1e-300)
            if size <= 1e-15 or (size < 1e-9 and size >= 0.1 * last):
                break
            last = size
        u = self.u + dt * self.v + dt * dt * ((0.5 - be) * self.a + be * a)
        v = self.v + dt * ((1.0 - ga) * self.a + ga * a)
        return u, v, a, multipliers

    def accept(self, dt, state):
        """Takes a step."""
        c, old = self.s.contact, self.v
        self.viscous += 0.5 * dt * (self.dissipation(self.u, old) + self.dissipation(state[0], state[1]))
        self.time += dt
        self.u, self.v, self.a, self.multiplier = state
        if c.law is None:
            self.u = self.u.copy()

    def dissipation(self, u, v):
        """Power of dashpots."""
        c = self.s.contact
        power = v @ self.s.damping @ v
        if c.damping is not None:
            mu, _ = c.viscosity(self.overclosure(u))
            power += float(c.areas * mu @ (c.rows @ v) ** 2)
        return power

    def advance(self, dt):
        """One increment, with the events inside it."""
        end, first = self.time + dt, False
        for _ in range(EVENTS_MAX):
            rest = end - self.time
            if rest <= 1e-12 * dt:
                return
            size = self.restart * rest if first else rest
            state = self.trial(size)
            if self.s.contact.law is not None:
                self.accept(size, state)
                first = False
                continue
            listed, fraction = self.violations(state, size)
            if not listed.any():
                self.accept(size, state)
                self.forget()
                first = False
                continue
            self.accept(
                fraction * size,
                self.trial(fraction * size) if fraction > 0.0 else (self.u, self.v, self.a, self.multiplier),
            )
            closing = listed & ~self.closed
            if fraction > 0.0:
                self.forget()
            self.kept |= closing & self.opened
            h = self.overclosure(self.u)
            self.offset[closing] -= h[closing]
            self.closed ^= listed
            if closing.any():
                self.impulse(self.closed.copy())
            self.accelerate()
            first = True
        raise RuntimeError("too many events in an increment")

    def rounding(self, values):
        """What is nothing beside these values."""
        return 1e-12 * np.abs(values).max()

    def violations(self, state, size):
        """Points that break the hard conditions at the end of a step, and the mean fraction at which they do."""
        h0, h1, multipliers = self.overclosure(self.u), self.overclosure(state[0]), state[3]
        closing = ~self.closed & (h1 > 1e-13 * np.abs(h0 - h1).max(initial=0.0))
        opening = self.closed & ~self.kept & (multipliers < -self.rounding(self.s.mass @ np.abs(self.v)) / size)
        fractions = np.zeros(len(h0))
        fractions[closing] = (-h0 / np.where(h1 == h0, 1.0, h1 - h0))[closing].clip(0.0, 1.0)
        held = np.maximum(self.multiplier, 0.0)
        fractions[opening] = (held / np.where(held == multipliers, 1.0, held - multipliers))[opening]
        listed = closing | opening
        return listed, float(fractions[listed].mean()) if listed.any() else 0.0

    def keep(self, history):
        """Writes the present state."""
        s, c = self.s, self.s.contact
        h = self.overclosure(self.u)
        force = self.multiplier.copy()
        if c.law is not None:
            force = c.areas * c.pressures(h)[0]
        if c.damping is not None:
            force = force + c.areas * c.viscosity(h)[0] * (c.rows @ self.v)
        history.time.append(self.time)
        for name, value in (("displacement", self.u), ("velocity", self.v), ("acceleration", self.a)):
            getattr(history, name).append(value.copy())
        history.overclosure.append(h)
        history.contact_force.append(force)
        history.kinetic.append(0.5 * self.v @ s.mass @ self.v)
        history.strain.append(0.5 * self.u @ s.stiffness @ self.u)
        history.stored.append(c.energy(h))
        history.impact_loss.append(self.loss)
        history.viscous.append(self.viscous)
        history.events = list(self.events)


def march(structure, velocity, dt, increments, alpha=-0.05, displacement=None, restart=1.0):
    """History of equal increments from rest positions, or from `displacement`."""
    begin = np.zeros(len(structure.mass)) if displacement is None else displacement
    run, history = Implicit(structure, begin, velocity, alpha, restart), History()
    for number in range(1, increments + 1):
        run.advance(number * dt - run.time)
        run.keep(history)
    return history.arrays()
