"""Closed forms of impact: one degree of freedom on a law, damped contact, plastic impact, bars on a wall."""

import itertools
import math

import numpy as np


def rebound(law, area, mass, speed, kinks=()):
    """Contact time and largest overclosure of a mass that meets a law at `speed`, by energy; `kinks` of the slope split the integral."""
    work = 0.5 * mass * speed**2
    low = high = law.onset
    step = abs(law.onset) or speed * 1e-6
    while area * law.energy(high) < work:
        low, high, step = high, high + step, 2.0 * step
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if area * law.energy(middle) < work else (low, middle)
    depth = 0.5 * (low + high)
    # h = depth - w^2 takes the root at the turning point away.
    edges = [math.sqrt(depth - k) for k in (*kinks, law.onset) if k < depth] + [0.0]
    edges = sorted({*edges, *np.linspace(0.0, math.sqrt(depth - law.onset), 9)})
    places, weights = np.polynomial.legendre.leggauss(60)
    half = 0.0
    for a, b in itertools.pairwise(edges):
        for x, weight in zip(0.5 * (a + b) + 0.5 * (b - a) * places, 0.5 * (b - a) * weights, strict=True):
            left = work - area * law.energy(depth - x * x)
            half += weight * 2.0 * x / math.sqrt(2.0 * left / mass)
    return float(2.0 * half), float(depth)


def drop(mass, gravity, height, stiffness):
    """Contact time and largest overclosure of a mass that falls onto a spring."""
    w, sag = math.sqrt(stiffness / mass), mass * gravity / stiffness
    speed = math.sqrt(2.0 * gravity * height)
    depth = sag * (1.0 + math.sqrt(1.0 + 2.0 * height / sag))
    return 2.0 / w * (math.pi - math.atan(speed / (w * sag))), depth


def restitution(fraction, tension):
    """Coefficient of restitution of a linear law with a dashpot: released at zero overclosure, or at zero force."""
    damped = math.sqrt(1.0 - fraction**2)
    if tension:
        return math.exp(-math.pi * fraction / damped)
    return math.exp(-2.0 * fraction / damped * math.atan(damped / fraction))


def damped_time(fraction, tension):
    """Natural frequency times contact time."""
    damped = math.sqrt(1.0 - fraction**2)
    return math.pi / damped if tension else 2.0 / damped * math.atan(damped / fraction)


def plastic(masses, speeds):
    """Common speed, impulse and loss of two masses that meet and stay together."""
    (m, n), (v, w) = masses, speeds
    together = m * n / (m + n)
    return (m * v + n * w) / (m + n), together * abs(v - w), 0.5 * together * (v - w) ** 2


def elastic(masses, speeds):
    """Speeds of two masses after an elastic impact."""
    (m, n), (v, w) = masses, speeds
    common = (m * v + n * w) / (m + n)
    return 2.0 * common - v, 2.0 * common - w


def wave_speed(young, density):
    """Of a bar."""
    return math.sqrt(young / density)
