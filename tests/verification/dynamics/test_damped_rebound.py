"""Contact damping of moving masses (D06, D29): restitution, time, energy."""

import math

import numpy as np
import pytest

from oracle.dynamics import curves, explicit, implicit, system, theory
from verification.dynamics.motion import Scene, crossing, frequency, linear, solve

PENALTY = "MECHANICAL CONSTRAINT=PENALTY"
FRACTIONS = [0.01, 0.03, 0.1, 0.3, 0.7]
# Fraction, restitution and frequency times time: released at zero overclosure, at zero force.
PUBLISHED = {
    0.01: (0.969070903976423, 0.9692647504644925, 3.141749745004427, 3.121748411564418),
    0.03: (0.9100186185297249, 0.9116591124589392, 3.1430073252589352, 3.082971299318924),
    0.1: (0.7292476142876709, 0.7440793977217797, 3.1574194169982763, 2.9560753247495497),
    0.3: (0.3723261049265864, 0.45097545289312846, 3.2932839419151545, 2.6544745637853566),
    0.7: (0.04598791026026774, 0.21028456437847837, 4.399109624950494, 2.2275622815320664),
}


@pytest.mark.parametrize("fraction", FRACTIONS)
def test_the_closed_forms_are_the_published_ones(fraction):
    found = [f(fraction, tension) for f in (theory.restitution, theory.damped_time) for tension in (True, False)]
    assert found == pytest.approx(PUBLISHED[fraction], rel=1e-10)


def fractions(value):
    """`*CONTACT DAMPING` by the critical damping fraction."""
    return ["*CONTACT DAMPING, DEFINITION=CRITICAL DAMPING FRACTION", f"{value!r},"]


def coefficient(value):
    """`*CONTACT DAMPING` by the coefficient."""
    return ["*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", f"{value!r},"]


def bounce(write_deck, tmp_path, damping, fraction, *, mass=2.0, area=0.5, stiffness=8e3, speed=1.3, scaled=0.002):
    """The run of a mass that begins half an increment before the wall, the oracle's, and its label; `scaled`: frequency times dt."""
    w = frequency(mass, area * stiffness)
    dt, count = scaled / w, int(4.8 / scaled)
    gap = 0.5 * dt * speed
    scene = Scene(explicit=True)
    node = scene.node(gap, -speed, mass)
    scene.pair([node], [*linear(stiffness), *damping], area, [PENALTY])
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    structure = system.Structure(*system.chain([mass], []), system.wall(1, gap, area, curves.Linear(stiffness)))
    other = explicit.march(structure, [-speed], dt, count, explicit.PENALTY, fraction=fraction)
    assert run.node(node, "V3") == pytest.approx(other.velocity[:, 0], abs=1e-9 * speed)
    assert run.force(node) == pytest.approx(other.contact_force[:, 0], abs=1e-9 * other.contact_force.max())
    return run, node, speed, w


@pytest.mark.parametrize("fraction", FRACTIONS)
@pytest.mark.parametrize("kind", ["fraction", "coefficient"])
def test_d06_restitution_of_damped_penalty_contact(write_deck, tmp_path, fraction, kind):
    """No adhesion: released at zero force. f = 2 xi sqrt(m K) v, or mu0 A v with the same."""
    mu0 = 2.0 * fraction * math.sqrt(2.0 * 0.5 * 8e3) / 0.5
    damping = fractions(fraction) if kind == "fraction" else coefficient(mu0)
    run, node, speed, w = bounce(write_deck, tmp_path, damping, fraction)
    expected = PUBLISHED[fraction][1]
    assert run.node(node, "V3")[-1] / speed == pytest.approx(expected, rel=0.005)
    force = run.force(node)
    touching = np.flatnonzero(force > 0.0)
    assert w * (run.time[touching[-1]] - run.time[touching[0]]) == pytest.approx(PUBLISHED[fraction][3], rel=0.005)
    assert force.min() >= 0.0
    lost = 0.5 * 2.0 * speed**2 * (1.0 - expected**2)
    # What a spring keeps that is released before it is slack counts as lost.
    assert run.energy("ALLVD")[-1] + run.energy("IMPACT_LOSS")[-1] == pytest.approx(lost, rel=0.01)
    assert run.energy("ETOTAL") == pytest.approx(run.energy("ETOTAL")[0], abs=2e-3 * 0.5 * 2.0 * speed**2)


@pytest.mark.parametrize("fraction", [0.01, 0.03, 0.1])
def test_d06_at_large_increments(write_deck, tmp_path, fraction):
    """Frequency times dt = 0.05: restitution to 0.5 %."""
    run, node, speed, _ = bounce(write_deck, tmp_path, fractions(fraction), fraction, scaled=0.05)
    assert run.node(node, "V3")[-1] / speed == pytest.approx(PUBLISHED[fraction][1], rel=0.005)


def test_d29_the_default_is_a_fraction_of_three_percent(write_deck, tmp_path):
    """Penalty contact without *CONTACT DAMPING returns 0.911659112 of the speed; a coefficient of zero all of it."""
    run, node, speed, _ = bounce(write_deck, tmp_path, [], 0.03)
    assert run.node(node, "V3")[-1] / speed == pytest.approx(0.911659112, rel=0.001)
    run, node, speed, _ = bounce(write_deck, tmp_path / "undamped", coefficient(0.0), 0.0)
    assert run.node(node, "V3")[-1] / speed == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize(("mass", "area", "stiffness", "speed"), [(0.01, 3.0, 5e5, 20.0), (30.0, 0.02, 1e4, 0.004)])
@pytest.mark.parametrize("fraction", [0.05, 0.5])
def test_d29_restitution_does_not_depend_on_the_numbers(write_deck, tmp_path, mass, area, stiffness, speed, fraction):
    """A function of the fraction alone."""
    given = {"mass": mass, "area": area, "stiffness": stiffness, "speed": speed}
    run, node, _, _ = bounce(write_deck, tmp_path, fractions(fraction), fraction, **given)
    assert run.node(node, "V3")[-1] / speed == pytest.approx(theory.restitution(fraction, False), rel=0.005)


@pytest.mark.parametrize("fraction", FRACTIONS)
def test_d06_implicit_damping_holds_until_surfaces_part(write_deck, tmp_path, fraction):
    """*DYNAMIC: damping pressure of either sign, within a clearance that is next to nothing: released at h = 0."""
    mass, area, stiffness, speed, scaled = 2.0, 0.5, 8e3, 1.3, 0.002
    w = frequency(mass, area * stiffness)
    dt, count = scaled / w, int(5.2 / scaled)
    mu0, gap = 2.0 * fraction * math.sqrt(mass * area * stiffness) / area, 0.5 * dt * speed
    tiny = 1e-9 * speed / w
    scene = Scene()
    node = scene.node(gap, -speed, mass)
    damping = ["*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", f"{mu0!r}, {tiny!r}"]
    scene.pair([node], [*linear(stiffness), *damping], area)
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    span = crossing(run.time, gap + run.node(node, "U3"), 0.0, True) - gap / speed
    assert w * span == pytest.approx(PUBLISHED[fraction][2], rel=0.005)
    assert run.node(node, "V3")[-1] / speed == pytest.approx(PUBLISHED[fraction][0], rel=0.005)
    assert run.force(node).min() < 0.0
    lost = 0.5 * mass * speed**2 * (1.0 - PUBLISHED[fraction][0] ** 2)
    assert run.energy("ALLVD")[-1] == pytest.approx(lost, rel=0.01)
    structure = system.Structure(
        *system.chain([mass], []), system.wall(1, gap, area, curves.Linear(stiffness), (mu0, tiny, 0.0))
    )
    other = implicit.march(structure, [-speed], dt, count)
    assert run.node(node, "V3") == pytest.approx(other.velocity[:, 0], abs=2e-3 * speed)


def test_implicit_damping_within_a_clearance(write_deck, tmp_path):
    """A mass that passes through the damped clearance of hard contact loses mu(c) v all the way: v(c) in closed form."""
    mass, area, speed, mu0, c0, eta = 2.0, 0.7, 3.0, 5.0, 0.4, 0.25
    scene = Scene()
    node = scene.node(c0 + 0.1, -speed, mass)
    damping = ["*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", f"{mu0!r}, {c0!r}, {eta!r}"]
    scene.pair([node], ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD", *damping], area)
    dt, count = 1e-3, 160
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    clearance = c0 + 0.1 + run.node(node, "U3")
    assert clearance.min() > 0.0, "the mass is to stay open"

    def passed(c):
        """Integral of the coefficient from c0 to c: m dv = -A mu dc."""
        edge = eta * c0
        ramp = mu0 / (c0 - edge)
        outer = max(c, edge)
        return 0.5 * ramp * (c0 - min(outer, c0)) ** 2 + (mu0 * (edge - c) if c < edge else 0.0)

    expected = [speed - area * passed(c) / mass for c in clearance]
    assert -run.node(node, "V3") == pytest.approx(expected, abs=2e-4 * speed)
    assert {row["status"] for row in run.contact[node]} >= {"VD"}
    lost = run.energy("ALLKE")[0] - run.energy("ALLKE")[-1]
    assert run.energy("ALLVD")[-1] == pytest.approx(lost, rel=2e-3)
