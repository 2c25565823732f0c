"""The dynamic oracle meets the closed forms of impact before it judges anyone."""

import math

import numpy as np
import pytest

from oracle.dynamics import curves, explicit, implicit, system, theory

EXPONENTIAL = curves.Exponential(1e-4, 1e6)
BAR = {"length": 2.0, "area": 0.2, "young": 200e9, "density": 7800.0}


def on_wall(mass=1.0, gap=0.0, area=1.0, law=None, damping=None):
    """A mass in front of a wall."""
    matrices = system.chain([mass], [])
    return system.Structure(*matrices, system.wall(1, gap, area, law, damping))


def out(history):
    """Last velocity of the first node."""
    return float(history.velocity[-1][0])


def test_the_operator_of_hilber_hughes_and_taylor():
    """Ten increments in linear contact; parameters by their definition."""
    run = implicit.Implicit(on_wall(law=curves.Linear(1e4)), [0.0], [-1.0])
    assert (run.beta, run.gamma) == pytest.approx((0.275625, 0.55), rel=1e-14)
    history = implicit.march(on_wall(law=curves.Linear(1e4)), [-1.0], 1e-3, 10)
    last = [-history.displacement[-1][0], -history.velocity[-1][0], -history.acceleration[-1][0]]
    assert last == pytest.approx([0.008408637181706482, 0.5409607544914448, -83.79560298922911], rel=1e-12)


def test_central_differences_on_a_penalty():
    history = explicit.march(on_wall(law=curves.Linear(1e4)), [-1.0], 0.004, 6, explicit.PENALTY)
    depth = [0.004, 0.00736, 0.0095424, 0.010198016, 0.00922194944, 0.0067703709696]
    speed = [1.0, 0.84, 0.5456, 0.163904, -0.24401664, -0.6128946176]
    assert -history.displacement[:, 0] == pytest.approx(np.array(depth), rel=1e-13)
    assert -history.velocity[:, 0] == pytest.approx(np.array(speed), rel=1e-13)


@pytest.mark.parametrize("speed", [0.5, 0.05, 5.0])
@pytest.mark.parametrize(
    "law", [EXPONENTIAL, curves.Linear(1e9), curves.Table(((0.0, -1e-4), (1e5, 0.0), (1e6, 1e-4)))]
)
@pytest.mark.parametrize("procedure", ["implicit", "penalty"])
def test_elastic_rebound(law, speed, procedure):
    """Time and depth by energy, with 400 increments per contact."""
    kinks = [h for _, h in getattr(law, "points", ())]
    duration, depth = theory.rebound(law, 1e-3, 1.0, speed, kinks)
    structure = on_wall(gap=-law.onset, area=1e-3, law=law)
    if procedure == "implicit":
        history = implicit.march(structure, [-speed], duration / 400, 480)
    else:
        history = explicit.march(structure, [-speed], duration / 400, 480, explicit.PENALTY)
    assert out(history) == pytest.approx(speed, rel=1e-4)
    assert history.overclosure.max() - law.onset == pytest.approx(depth - law.onset, rel=1e-3)
    touching = (history.contact_force[:, 0] > 0.0).sum() * duration / 400
    assert touching == pytest.approx(duration, rel=0.006)


@pytest.mark.parametrize("fraction", [0.01, 0.03, 0.1, 0.3, 0.7])
@pytest.mark.parametrize("clip", [True, False])
def test_damped_rebound(fraction, clip):
    law, dt = curves.Linear(1.0), 0.002
    history = explicit.march(on_wall(law=law), [-1.0], dt, 2600, explicit.PENALTY, fraction=fraction, clip=clip)
    assert out(history) == pytest.approx(theory.restitution(fraction, not clip), rel=0.003)


def test_plastic_impact_of_two_masses():
    matrices = system.chain([2.0, 3.0], [0.0])
    contact = system.Contact(np.array([[1.0, -1.0]]), np.array([-0.01]), np.array([1.0]))
    history = implicit.march(system.Structure(*matrices, contact), [4.0, -1.0], 0.004, 3)
    ((time, impulse, loss),) = history.events
    assert (time, impulse, loss) == pytest.approx((0.002, 6.0, 15.0), rel=1e-12)
    assert history.velocity[-1] == pytest.approx(np.array([1.0, 1.0]), rel=1e-12)


def test_the_time_of_an_impact_is_interpolated():
    history = implicit.march(on_wall(2.0, 0.01), [-1.0], 0.004, 4)
    assert history.events == [pytest.approx((0.01, 2.0, 1.0), rel=1e-12)]
    assert history.displacement[-1][0] == pytest.approx(-0.01, rel=1e-12)


def test_a_consistent_bar_jumps_further_in():
    """One element: M = m/6 [2 1; 1 2]; the far node gains half the speed that the near one loses."""
    mass, stiffness = system.bar(1, 1.0, 1.0, 1.0, 6.0, consistent=True)
    history = implicit.march(system.Structure(mass, 0.0 * stiffness, system.wall(2, 0.0)), [-1.0, -1.0], 0.1, 1)
    assert history.velocity[0] == pytest.approx(np.array([0.0, -1.5]), abs=1e-12)
    assert history.impact_loss[0] == pytest.approx(6.0 / 8.0, rel=1e-12)


def test_impact_and_release_of_two_masses_on_a_spring():
    matrices = system.chain([1.0, 4.0], [900.0])
    history = implicit.march(system.Structure(*matrices, system.wall(2, 0.0)), [-2.0, -2.0], 5e-4, 800)
    force = history.contact_force[:, 0]
    assert force.max() == pytest.approx(120.0, rel=1e-4)
    assert history.time[np.flatnonzero(force)[-1]] == pytest.approx(0.20943951, abs=1e-3)
    assert history.impact_loss[-1] == pytest.approx(2.0, rel=1e-12)
    assert history.velocity[-1] @ [0.2, 0.8] == pytest.approx(1.6, rel=1e-4)


@pytest.mark.parametrize("elements", [5, 10, 20, 100])
def test_bars_on_a_wall_at_courant_number_one(elements):
    """Rebound of the centre of mass 1 - 1 / (2 n), impulse, and the end of contact after 2 n increments."""
    mass, stiffness = system.bar(elements, **BAR)
    structure = system.Structure(mass, stiffness, system.wall(elements + 1, 0.0))
    dt = BAR["length"] / elements / theory.wave_speed(BAR["young"], BAR["density"])
    history = explicit.march(structure, [-1.5] * (elements + 1), dt, 3 * elements, explicit.KINEMATIC)
    nodal = structure.nodal
    assert history.velocity[-1] @ nodal / nodal.sum() == pytest.approx(1.5 * (1.0 - 0.5 / elements), rel=1e-10)
    force = history.contact_force[:, 0]
    assert force.sum() * dt == pytest.approx(4680.0 * (2.0 - 0.5 / elements), rel=1e-10)
    assert np.flatnonzero(force > 1e-6 * force.max())[-1] + 1 == 2 * elements


def test_the_kinematic_corrector_of_a_node_on_a_plate_of_four():
    """Mass 2 on 6, penetration 3e-4, increment 0.01; momentum stays."""
    contact = system.Contact(np.array([[-1.0, 0.25, 0.25, 0.25, 0.25]]), np.zeros(1), np.ones(1))
    structure = system.Structure(np.diag([2.0, 1.5, 1.5, 1.5, 1.5]), np.zeros((5, 5)), contact)
    history = explicit.march(structure, [-0.03, 0.0, 0.0, 0.0, 0.0], 0.01, 1, explicit.KINEMATIC)
    assert history.acceleration[0] == pytest.approx(np.array([2.25, *[-0.75] * 4]), rel=1e-12)
    assert history.contact_force[0, 0] == pytest.approx(4.5, rel=1e-12)
    assert history.overclosure[0, 0] == pytest.approx(0.0, abs=1e-18)


def test_softened_kinematic_contact_obeys_its_law_and_keeps_momentum():
    """Linear: h = d / (1 + theta^2) against a wall; a pair of masses pressed together settles where A p(h) is the force."""
    law, dt = curves.Linear(1e6), 1e-3
    history = explicit.march(on_wall(law=law), [-1.0], dt, 1, explicit.KINEMATIC)
    assert history.overclosure[0, 0] == pytest.approx(1e-3 / (1.0 + 1e6 * dt**2), rel=1e-12)
    contact = system.Contact(np.array([[-1.0, 1.0]]), np.zeros(1), np.array([2.0]), EXPONENTIAL)
    structure = system.Structure(np.eye(2), np.zeros((2, 2)), contact, force=lambda t: np.array([-3e6, 3e6]))
    history = explicit.march(structure, [0.0, 0.0], 1e-4, 3000, explicit.KINEMATIC)
    assert 2.0 * EXPONENTIAL(history.overclosure[-1, 0])[0] == pytest.approx(3e6, rel=1e-9)
    assert np.abs(history.velocity.sum(axis=1)).max() < 1e-12 * np.abs(history.velocity).max()


def test_an_unbalanced_start_flies_off_with_the_energy_of_its_law():
    history = explicit.march(on_wall(area=1e-3, law=EXPONENTIAL), [0.0], 1e-6, 2000, explicit.PENALTY)
    assert history.contact_force[0, 0] == pytest.approx(1000.0, rel=1e-12)
    assert out(history) == pytest.approx(math.sqrt(2e-3 * EXPONENTIAL.energy(0.0)), rel=1e-3)
    assert out(history) == pytest.approx(0.24124193393133922, rel=1e-3)


def test_both_marches_are_of_second_order():
    """Error of a mass on a spring after one period over the size of the increment; alpha costs amplitude of third order."""
    matrices = system.chain([1.0], [], [(0, 1.0)])
    away = system.Structure(*matrices, system.wall(1, 100.0))
    for solve in (implicit.march, lambda *given: explicit.march(*given, explicit.KINEMATIC)):
        errors = []
        for count in (40, 80):
            begin = math.cos(math.pi / count) if solve is not implicit.march else 1.0
            history = solve(away, [begin], 2.0 * math.pi / count, count // 2)
            errors.append(np.abs(history.displacement[:, 0] - np.sin(history.time)).max())
        assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
