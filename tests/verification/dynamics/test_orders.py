"""Both time operators are of second order, alpha costs what its spectral radius says, and tests/README.md shows the figures (D25)."""

import math

import pytest

from oracle.dynamics import curves, implicit, system
from verification.dynamics import orders, published
from verification.dynamics.motion import Scene, linear, solve


@pytest.fixture(scope="module")
def errors(tmp_path_factory):
    """Measured errors by row."""
    return orders.measure(tmp_path_factory.mktemp("orders"))


def test_smooth_motion_converges_with_the_square_of_the_increment(errors):
    for name, found in errors.items():
        if "three masses" in name:
            assert orders.orders(found)[-1] == pytest.approx(2.0, abs=0.1), (name, found)


def test_contact_times_converge(errors):
    """Interpolated impacts by the square; the first increment of explicit contact by the increment itself, never more than one."""
    assert orders.orders(errors["implicit: time of a hard impact"])[-1] == pytest.approx(2.0, abs=0.15)
    first = errors["explicit: first increment of a hard contact"]
    assert orders.orders(first)[-1] == pytest.approx(1.0, abs=0.1)
    assert all(error < 1.0 / n for error, n in zip(first, (5, 10, 20, 40), strict=True))
    for name in ("implicit", "explicit, penalty"):
        found = errors[f"{name}: time in contact with a straight law"]
        assert found[-1] < 1e-3 and found[-1] < 0.2 * found[0], (name, found)


def test_alpha_takes_the_amplitude_that_its_spectral_radius_says(tmp_path):
    rows = orders.measure_alpha(tmp_path)
    for alpha, per_period, kept, expected in rows:
        # Energy swings within a period where alpha is large and increments are, and periods are longer then.
        assert kept == pytest.approx(expected, rel=1e-3 if per_period > 10 else 4e-3), (alpha, per_period)
        if alpha == 0.0:
            assert kept == pytest.approx(1.0, abs=1e-9)
    assert published.shown("alpha") == orders.alpha_table(rows), (
        "renew it: python -m verification.dynamics.orders --write"
    )


def test_the_readme_shows_the_measured_errors(errors):
    assert published.shown("orders") == orders.table(errors), "renew it: python -m verification.dynamics.orders --write"


# Alpha, mass, stiffness, increment, speed; the first is published.
OPERATOR = [(-0.05, 1.0, 1e4, 1e-3, 1.0), (0.0, 2.0, 300.0, 0.01, 0.2), (-1.0 / 3.0, 0.3, 5e3, 2e-3, 4.0)]
LAST = (0.008408637181706482, 0.5409607544914448, -83.79560298922911)


@pytest.mark.parametrize(("alpha", "mass", "stiffness", "dt", "speed"), OPERATOR)
@pytest.mark.parametrize("held", ["contact", "spring"])
def test_d25_ten_increments_of_the_operator(write_deck, tmp_path, alpha, mass, stiffness, dt, speed, held):
    """A mass that stays in straight contact, or on a spring: place, speed and acceleration of the oracle; the published ones."""
    scene = Scene()
    node = scene.node(0.0, -speed, mass)
    if held == "contact":
        scene.pair([node], linear(stiffness))
    else:
        scene.spring([node], stiffness)
    run = solve(write_deck, tmp_path, scene.text(scene.implicit(dt, 10, alpha=alpha)))
    structure = system.Structure(*system.chain([mass], []), system.wall(1, 0.0, 1.0, curves.Linear(stiffness)))
    other = implicit.march(structure, [-speed], dt, 10, alpha)
    for column, values in (("U3", other.displacement), ("V3", other.velocity), ("A3", other.acceleration)):
        assert run.node(node, column) == pytest.approx(values[:, 0], rel=1e-9)
    if alpha == -0.05:
        last = [-run.node(node, column)[-1] for column in ("U3", "V3", "A3")]
        assert last == pytest.approx(LAST, rel=1e-8)


@pytest.mark.parametrize("factor", [1.0, -2.0])
def test_initial_accelerations_reach_what_an_equation_ties(write_deck, tmp_path, factor):
    """A massless node that a mass follows, pushed at once: u = F t^2 / (2 m) from the first increment on."""
    mass, force, dt = 2.0, 4.0, 0.1
    scene = Scene()
    lead, tied = scene.node(1.0), scene.node(2.0, mass=mass)
    scene.cards += ["*EQUATION", "2", f"{tied}, 3, 1., {lead}, 3, {-factor!r}"]
    run = solve(write_deck, tmp_path, scene.text(scene.implicit(dt, 4, "*CLOAD", f"{lead}, 3, {force!r}")))
    # The lever: the node that leads has factor^2 of the mass.
    expected = 0.5 * force / (factor**2 * mass) * run.time**2
    assert run.node(lead, "U3") == pytest.approx(expected, rel=1e-10)
    assert run.node(tied, "U3") == pytest.approx(factor * expected, rel=1e-10)


def test_d25_parameters():
    run = implicit.Implicit(system.Structure(*system.chain([1.0], []), system.wall(1, 1.0)), [0.0], [0.0])
    assert (run.beta, run.gamma) == pytest.approx((0.275625, 0.55), rel=1e-14)
    assert orders.amplification(-0.05, 0.1) == pytest.approx(0.999999439, rel=1e-9)
    assert orders.amplification(-0.05, 1e6) == pytest.approx(0.9047619047619048, rel=1e-6)
    assert math.isclose(orders.amplification(0.0, 0.3), 1.0, rel_tol=1e-12)
