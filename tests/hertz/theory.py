"""Hertz's contact of half spaces (K. L. Johnson, Contact Mechanics, sections 4.2 and 4.3), and what a finite ball changes.

Symbols: E* with 1/E* = sum of (1 - nu^2)/E over the bodies that deform; R radius; F force; a contact radius or half width; p_max
peak pressure; d approach. Any consistent units.
"""

import math
from dataclasses import dataclass


def profile_error(profile, contact):
    """Distance between computed and exact pressures, relative, in the norm of the secondary nodes' areas.

    profile: (distance, pressure, area) by node.
    """
    wrong = sum(area * (pressure - contact.pressure(r)) ** 2 for r, pressure, area in profile)
    return math.sqrt(wrong / sum(area * contact.pressure(r) ** 2 for r, _, area in profile))


def plane_modulus(*bodies):
    """E* of bodies given as (Young's modulus, Poisson's ratio); a rigid one is left out."""
    return 1.0 / sum((1.0 - poisson**2) / young for young, poisson in bodies)


@dataclass(frozen=True)
class Contact:
    """Radius (half width) of the contact, peak pressure, and approach (none for line contact)."""

    a: float
    p_max: float
    approach: float | None = None

    def pressure(self, r):
        """Pressure at a distance r from the centre."""
        return self.p_max * math.sqrt(max(0.0, 1.0 - (r / self.a) ** 2))


def point_contact(radius, force, modulus):
    """Ball on a flat: a^3 = 3 F R / (4 E*), p_max = 3 F / (2 pi a^2), d = a^2 / R."""
    a = (0.75 * force * radius / modulus) ** (1.0 / 3.0)
    return Contact(a, 1.5 * force / (math.pi * a**2), a**2 / radius)


def line_contact(radius, force_per_length, modulus):
    """Cylinder on a flat: a^2 = 4 F' R / (pi E*), p_max = 2 F' / (pi a)."""
    a = math.sqrt(4.0 * force_per_length * radius / (math.pi * modulus))
    return Contact(a, 2.0 * force_per_length / (math.pi * a))


def ball_between_flats(radius, force, young, poisson):
    """Approach of the equator of a whole ball pressed between two rigid flats [length].

    Hertz's a^2/R less what the force on the far flat pulls the near contact along (Y. Tatara, J. Eng. Mater. Technol. 113 (1991)
    285, leading order in a/R): F/(pi E) ((1 + nu)/(4 R) + (1 - nu^2)/(2 R)).
    """
    hertz = point_contact(radius, force, plane_modulus((young, poisson)))
    far = force / (math.pi * young * radius) * (0.25 * (1.0 + poisson) + 0.5 * (1.0 - poisson**2))
    return hertz.approach - far
