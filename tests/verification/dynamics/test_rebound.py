"""A mass that meets a softened law and flies off again (D01 to D05, D22, D26, D27, D30): time, depth, restitution, energy."""

import math

import numpy as np
import pytest

import support
from oracle.dynamics import curves, explicit, implicit, system, theory
from verification.dynamics.motion import UNDAMPED, Scene, crossing, exponential, frequency, linear, solve, tabular

PENALTY, KINEMATIC = "MECHANICAL CONSTRAINT=PENALTY", "MECHANICAL CONSTRAINT=KINEMATIC"
PROCEDURES = ["implicit", "penalty", "kinematic"]
# Increments per contact.
STEPS = 200


def cards(law):
    """`*SURFACE BEHAVIOR` of a law of the oracle."""
    if isinstance(law, curves.Linear):
        return linear(law.stiffness)
    if isinstance(law, curves.Table):
        return tabular(law.points)
    return exponential(law.clearance, law.pressure, law.ceiling if law.ceiling < math.inf else None)


def fly(write_deck, tmp_path, procedure, law, *, mass, area, speed, dt, increments, flight=2.5, extra=()):
    """A mass that begins `flight` increments before the onset of its law; the run, the oracle's, and the label of the mass."""
    away = max(-law.onset, 0.0) + flight * dt * speed
    scene = Scene(explicit=procedure != "implicit")
    node = scene.node(away, -speed, mass)
    word = [] if procedure == "implicit" else [PENALTY if procedure == "penalty" else KINEMATIC]
    scene.pair([node], [*cards(law), *extra, *(UNDAMPED if scene.explicit else [])], area, word)
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, increments)))
    structure = system.Structure(*system.chain([mass], []), system.wall(1, away, area, law))
    if procedure == "implicit":
        other = implicit.march(structure, [-speed], dt, increments)
    else:
        other = explicit.march(structure, [-speed], dt, increments, procedure)
    return run, other, node, away


def insist_on_the_oracle(run, other, node, tolerance=1e-9):
    """Places, speeds, accelerations and forces at every increment."""
    for column, values in (
        ("U3", other.displacement),
        ("V3", other.velocity),
        ("A3", other.acceleration),
    ):
        scale = np.abs(values).max()
        assert run.node(node, column) == pytest.approx(values[:, 0], abs=tolerance * scale), column
    force = other.contact_force[:, 0]
    assert run.force(node) == pytest.approx(force, abs=tolerance * np.abs(force).max())


# Mass, area, law, speed; the first of each kind are the published cases.
LINEAR = [(1.0, 1e-3, 1e9, 0.5), (2.5, 0.2, 3e4, 1.7), (0.04, 1.0, 9e5, 12.0)]
EXPONENTIAL = [
    (1.0, 1e-3, curves.Exponential(1e-4, 1e6), 0.5, 0.00080656124325),
    (1.0, 1e-3, curves.Exponential(1e-4, 1e6), 0.05, 0.00211679788804),
    (1.0, 1e-3, curves.Exponential(1e-4, 1e6), 5.0, 0.000209135874905),
    (3.0, 0.5, curves.Exponential(0.02, 40.0), 0.3, None),
    # Deep: beyond 6 c0 the law is straight.
    (0.7, 2.0, curves.Exponential(0.001, 2.0), 9.0, None),
]
TABLES = [
    (1.0, 1.0, curves.Table(((0.0, 0.0), (2.0, 0.01), (10.0, 0.02), (40.0, 0.03))), 0.6),
    (2.0, 0.1, curves.Table(((0.0, -1e-4), (1e5, 0.0), (1e6, 1e-4))), 0.05),
    (0.5, 3.0, curves.Table(((0.0, 0.002), (5.0, 0.004), (6.0, 0.008))), 1.1),
]


def insist_on_a_rebound(run, node, law, away, speed, duration, depth, dt, kinematic=False):
    """Time within an increment, depth within 0.5 %, speed within 0.5 %, energy."""
    place = away + run.node(node, "U3")
    at = run.time
    begin, end = crossing(at, place, -law.onset, False), crossing(at, place, -law.onset, True)
    assert end - begin == pytest.approx(duration, abs=dt)
    assert -place.min() - law.onset == pytest.approx(depth - law.onset, rel=0.005)
    assert run.node(node, "V3")[-1] == pytest.approx(speed, rel=0.005)
    assert run.energy("ALLKE")[-1] == pytest.approx(run.energy("ALLKE")[0], rel=0.01)


@pytest.mark.parametrize("procedure", ["implicit", "penalty"])
@pytest.mark.parametrize(("mass", "area", "stiffness", "speed"), LINEAR)
def test_d01_a_linear_law_returns_a_mass_after_half_a_period(
    write_deck, tmp_path, procedure, mass, area, stiffness, speed
):
    w = frequency(mass, area * stiffness)
    dt, law = math.pi / w / STEPS, curves.Linear(stiffness)
    run, other, node, away = fly(
        write_deck,
        tmp_path,
        procedure,
        law,
        mass=mass,
        area=area,
        speed=speed,
        dt=dt,
        increments=STEPS + 10,
    )
    insist_on_a_rebound(run, node, law, away, speed, math.pi / w, speed / w, dt)
    assert run.force(node).max() == pytest.approx(speed * math.sqrt(mass * area * stiffness), rel=0.005)
    insist_on_the_oracle(run, other, node)


@pytest.mark.parametrize("procedure", ["implicit", "penalty"])
@pytest.mark.parametrize(("mass", "area", "law", "speed", "published"), EXPONENTIAL)
def test_d02_an_exponential_law_returns_a_mass(write_deck, tmp_path, procedure, mass, area, law, speed, published):
    duration, depth = theory.rebound(law, area, mass, speed, [6.0 * law.clearance])
    if published:
        assert duration == pytest.approx(published, rel=1e-9)
    if procedure == "penalty" and depth > 6.0 * law.clearance:
        pytest.skip("penalty contact bends this law where its slope is the default penalty")
    dt = duration / STEPS
    given = {"mass": mass, "area": area, "speed": speed, "dt": dt, "increments": STEPS + 10}
    run, other, node, away = fly(write_deck, tmp_path, procedure, law, **given)
    insist_on_a_rebound(run, node, law, away, speed, duration, depth, dt)
    insist_on_the_oracle(run, other, node, 1e-8)


@pytest.mark.parametrize("procedure", ["implicit", "penalty"])
@pytest.mark.parametrize(("mass", "area", "law", "speed"), TABLES)
def test_d03_a_table_returns_a_mass(write_deck, tmp_path, procedure, mass, area, law, speed):
    duration, depth = theory.rebound(law, area, mass, speed, [h for _, h in law.points])
    dt = duration / STEPS
    given = {"mass": mass, "area": area, "speed": speed, "dt": dt, "increments": STEPS + 10}
    run, other, node, away = fly(write_deck, tmp_path, procedure, law, **given)
    insist_on_a_rebound(run, node, law, away, speed, duration, depth, dt)
    insist_on_the_oracle(run, other, node, 1e-8)


CEILINGS = [
    (1.0, 1e-3, curves.Exponential(1e-4, 1e6, 3e10), 0.5),
    (1.0, 1e-3, curves.Exponential(1e-4, 1e6, 3e9), 0.5),
    # The ceiling is reached while surfaces are still apart.
    (1.0, 1e-3, curves.Exponential(1e-4, 1e6, 3e9), 0.05),
    (2.0, 0.3, curves.Exponential(0.01, 5.0, 2e4), 1.5),
]


@pytest.mark.parametrize(("mass", "area", "law", "speed"), CEILINGS)
def test_d04_an_exponential_law_with_a_ceiling_returns_a_mass(write_deck, tmp_path, mass, area, law, speed):
    kink = law.clearance * (law.last - 1.0)
    duration, depth = theory.rebound(law, area, mass, speed, [kink])
    assert depth > kink, "the ceiling is not reached"
    dt = duration / STEPS
    given = {"mass": mass, "area": area, "speed": speed, "dt": dt, "increments": STEPS + 10}
    run, other, node, away = fly(write_deck, tmp_path, "penalty", law, **given)
    insist_on_a_rebound(run, node, law, away, speed, duration, depth, dt)
    insist_on_the_oracle(run, other, node, 1e-8)


@pytest.mark.parametrize("explicitly", [False, True])
@pytest.mark.parametrize(
    ("mass", "gravity", "height", "stiffness"),
    [(1.0, 9.81, 0.1, 1e4), (3.0, 9.81, 0.002, 500.0), (0.2, 50.0, 1.0, 2e3)],
)
def test_d05_a_mass_dropped_on_a_spring(write_deck, tmp_path, explicitly, mass, gravity, height, stiffness):
    """Depth (m g / K)(1 + sqrt(1 + 2 H K / (m g))), time in contact, and back to its height."""
    duration, depth = theory.drop(mass, gravity, height, stiffness)
    fall = math.sqrt(2.0 * height / gravity)
    dt = duration / 400
    increments = int((2.0 * fall + duration) / dt) + 1
    scene = Scene(explicit=explicitly)
    node = scene.node(height, mass=mass)
    scene.pair([node], [*linear(stiffness), *(UNDAMPED if explicitly else [])], 1.0, [PENALTY] if explicitly else ())
    weight = ["*DLOAD", f"S{scene.number}, GRAV, {gravity!r}, 0., 0., -1."]
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, increments, *weight)))
    place = height + run.node(node, "U3")
    begin, end = crossing(run.time, place, 0.0, False), crossing(run.time, place, 0.0, True)
    assert end - begin == pytest.approx(duration, rel=0.005)
    assert -place.min() == pytest.approx(depth, rel=0.005)
    assert place[int((begin + end) / dt / 2) :].max() == pytest.approx(height, rel=0.01)
    fallen = -run.node(node, "U3")
    if explicitly:
        # Energies of explicit increments stand at their start.
        fallen = np.concatenate([[0.0], fallen[:-1]])
    assert run.energy("ALLWK") == pytest.approx(mass * gravity * fallen, abs=1e-9 * mass * gravity * height)


@pytest.mark.parametrize("theta", [0.02, 0.1, 0.5, 3.0])
def test_d22_softened_kinematic_contact_takes_energy(write_deck, tmp_path, theta):
    """Every increment in contact: h = d / (1 + theta^2), theta = dt sqrt(K / m); stable however stiff."""
    mass, area, stiffness, speed = 2.0, 0.5, 4e4, 0.8
    dt = theta / frequency(mass, area * stiffness)
    count = int(math.pi / math.atan(theta)) + 12
    law = curves.Linear(stiffness)
    given = {"mass": mass, "area": area, "speed": speed, "dt": dt, "increments": count, "flight": 1.5}
    run, other, node, away = fly(write_deck, tmp_path, "kinematic", law, **given)
    insist_on_the_oracle(run, other, node, 1e-10)
    h = np.maximum(-(away + run.node(node, "U3")), 0.0)
    assert run.force(node) == pytest.approx(area * stiffness * h, abs=1e-9 * area * stiffness * h.max())
    back = run.node(node, "V3")[-1]
    assert 0.0 <= back <= speed * (1.0 + 1e-12)
    if theta <= 0.1:
        estimate = (1.0 + theta**2) ** (-math.pi / (2.0 * math.atan(theta)))
        assert back / speed == pytest.approx(estimate, abs=1.5 * theta**2 + 0.002)


@pytest.mark.parametrize("law", [case[2] for case in (EXPONENTIAL[0], EXPONENTIAL[3], TABLES[0], TABLES[1])])
def test_softened_kinematic_contact_of_curved_laws(write_deck, tmp_path, law):
    """The corrected place obeys the law; the exponential acts before surfaces touch."""
    mass, area = 1.0, 1e-3
    speed = 0.5 if isinstance(law, curves.Exponential) else 0.02
    duration, _ = theory.rebound(law, area, mass, speed, getattr(law, "points", ()) and [h for _, h in law.points])
    given = {"mass": mass, "area": area, "speed": speed, "dt": duration / 60, "increments": 80}
    run, other, node, away = fly(write_deck, tmp_path, "kinematic", law, **given)
    insist_on_the_oracle(run, other, node, 1e-8)
    h = -(away + run.node(node, "U3"))
    force = np.array([area * law(x)[0] for x in h])
    assert run.force(node) == pytest.approx(force, abs=1e-8 * force.max())


@pytest.mark.parametrize(
    ("mass", "area", "clearance", "pressure", "published"),
    [(1.0, 1e-3, 1e-4, 1e6, 0.24124193393133922), (4.0, 0.2, 0.01, 30.0, None)],
)
def test_d26_a_start_that_is_not_in_equilibrium(write_deck, tmp_path, mass, area, clearance, pressure, published):
    """Surfaces that touch under an exponential law: p0 at once, and off with the energy of the law; a warning tells."""
    law = curves.Exponential(clearance, pressure)
    leaving = math.sqrt(2.0 * area * law.energy(0.0) / mass)
    if published:
        assert leaving == pytest.approx(published, rel=1e-12)
    dt = clearance / leaving / 200
    scene = Scene(explicit=True)
    node = scene.node(0.0, mass=mass)
    scene.pair([node], [*exponential(clearance, pressure), *UNDAMPED], area, [PENALTY])
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, 2000)))
    assert run.point(node, "CPRESS")[0] == pytest.approx(pressure, rel=1e-10)
    assert run.force(node)[0] == pytest.approx(area * pressure, rel=1e-10)
    assert run.node(node, "A3")[0] == pytest.approx(area * pressure / mass, rel=1e-10)
    assert run.node(node, "V3")[-1] == pytest.approx(leaving, rel=0.005)
    messages = " ".join(d["message"] for d in run.summary["diagnostics"])
    assert "thrown apart" in messages, messages


@pytest.mark.parametrize("enforcement", ["penalty", "kinematic"])
@pytest.mark.parametrize(("mass", "area", "stiffness", "speed"), LINEAR[:2])
def test_d27_a_linear_law_that_cannot_part_swings_for_ever(
    write_deck, tmp_path, enforcement, mass, area, stiffness, speed
):
    """Latched at first closure: p = k h of both signs. By penalties the amplitude stays; the kinematic method damps it."""
    w = frequency(mass, area * stiffness)
    dt, law = 0.05 / w, curves.Linear(stiffness, tension=True)
    scene = Scene(explicit=True)
    gap = 3.5 * dt * speed
    node = scene.node(gap, -speed, mass)
    behavior = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR, NO SEPARATION", f"{stiffness!r},", *UNDAMPED]
    scene.pair([node], behavior, area, [PENALTY if enforcement == "penalty" else KINEMATIC])
    count = int(6.0 * math.pi / 0.05)
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    h = -(gap + run.node(node, "U3"))
    begin = int(np.flatnonzero(h > 0.0)[0])
    # From the first point inside the march of the oracle with a law of both signs is the same.
    structure = system.Structure(*system.chain([mass], []), system.wall(1, gap, area, law))
    mover = explicit.Explicit(structure, [-speed], enforcement, clip=False)
    mover.u, history = np.array([-(h[begin] + gap)]), system.History()
    if enforcement == "penalty":
        for _ in range(count - begin - 1):
            mover.advance(dt, history)
        assert run.node(node, "U3")[begin + 1 :] == pytest.approx(
            np.array(history.displacement)[:, 0], abs=1e-9 * speed / w
        )
        assert h[begin:].max() == pytest.approx(speed / w, rel=0.005)
        assert h[begin:].min() == pytest.approx(-speed / w, rel=0.005)
        rising = crossing(run.time[begin:], -h[begin:], 0.0, True) - crossing(run.time, -h, 0.0, False)
        assert rising == pytest.approx(math.pi / w, rel=0.002)
    else:
        ratio = abs(h[begin:].min()) / h[begin:].max()
        assert ratio == pytest.approx((1.0 + 0.05**2) ** (-math.pi / (2.0 * math.atan(0.05))), rel=0.01)
    assert run.force(node).min() < -0.5 * area * stiffness * speed / w


@pytest.mark.parametrize(
    ("masses", "speeds", "stiffness", "area"),
    [((2.0, 3.0), (4.0, -1.0), 5e4, 1.0), ((1.0, 1.0), (2.0, 0.0), 300.0, 0.4), ((0.1, 40.0), (-1.0, -3.0), 1e5, 2.0)],
)
def test_d30_two_masses_with_softened_contact_exchange_their_speeds(
    write_deck, tmp_path, masses, speeds, stiffness, area
):
    """Implicit softened contact knows no impulse: it is elastic, for pi sqrt(m1 m2 / (m1 + m2) / K); a warning tells that it bounces."""
    together = masses[0] * masses[1] / sum(masses)
    duration = math.pi / frequency(together, area * stiffness)
    dt = duration / STEPS
    gap = 1.5 * dt * (speeds[0] - speeds[1])
    scene = Scene()
    near, far = scene.node(1.0, speeds[0], masses[0]), scene.node(1.5, speeds[1], masses[1])
    scene.gap(near, far, gap, linear(stiffness), area)
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, STEPS + 20)))
    after = theory.elastic(masses, speeds)
    found = run.node(near, "V3")[-1], run.node(far, "V3")[-1]
    assert found == pytest.approx(after, abs=0.002 * (speeds[0] - speeds[1]))
    momentum = masses[0] * run.node(near, "V3") + masses[1] * run.node(far, "V3")
    assert momentum == pytest.approx(np.full(len(momentum), np.dot(masses, speeds)), abs=1e-9 * together * 10.0)
    closed = (np.array([float(r["CAREA[" + pair_name(run) + "]"]) for r in run.history]) > 0).sum() * dt
    assert closed == pytest.approx(duration, abs=2.0 * dt)
    assert run.energy("IMPACT_LOSS").max() == 0.0
    assert run.energy("ALLKE")[-1] == pytest.approx(run.energy("ALLKE")[0], rel=0.002)
    messages = " ".join(d["message"] for d in run.summary["diagnostics"])
    assert "elastic" in messages and "bounce" in messages, messages


def pair_name(run):
    """The only pair of a run."""
    (name,) = {row["pair"] for row in run.result.table("contact")}
    return name


def test_implicit_softened_contact_with_automatic_increments(write_deck, tmp_path):
    """Automatic increments resolve the contact by themselves: D02 to 1 %."""
    law, mass, area, speed = curves.Exponential(1e-4, 1e6), 1.0, 1e-3, 0.5
    duration, depth = theory.rebound(law, area, mass, speed, [6e-4])
    scene = Scene()
    node = scene.node(3e-4, -speed, mass)
    scene.pair([node], exponential(1e-4, 1e6), area)
    step = ["*STEP, INC=100000", "*DYNAMIC", f"{duration / 50!r}, {4.0 * duration!r}", *scene.implicit(1.0, 1)[3:]]
    run = solve(write_deck, tmp_path, scene.text(step), clean=False)
    place = 3e-4 + run.node(node, "U3")
    assert -place.min() == pytest.approx(depth, rel=0.03)
    assert run.node(node, "V3")[-1] == pytest.approx(speed, rel=0.01)
    span = crossing(run.time, place, 1e-4, True) - crossing(run.time, place, 1e-4, False)
    assert span == pytest.approx(duration, rel=0.01)
    assert support.close(run.time[-1], 4.0 * duration, 1e-12)
