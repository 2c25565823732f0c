"""Explicit contact increment by increment (D18 to D21, D23, D24, D28, D31): penalties, the kinematic corrector, stable increments."""

import math

import numpy as np
import pytest

from oracle.dynamics import curves, explicit, system, theory
from verification.dynamics.motion import HARD, UNDAMPED, Scene, exponential, frequency, linear, solve

PENALTY, KINEMATIC = "MECHANICAL CONSTRAINT=PENALTY", "MECHANICAL CONSTRAINT=KINEMATIC"
CORNERS = (5, 6, 7, 8)


def shares(x, y, side=2.0):
    """Shape functions of a square face at (x, y), in the order of its corners."""
    a, b = 2.0 * x / side, 2.0 * y / side
    return 0.25 * np.array([(1 - a) * (1 - b), (1 + a) * (1 - b), (1 + a) * (1 + b), (1 - a) * (1 + b)])


def plate_rows(places):
    """Rows of points over a plate: own directions first, then the four corners."""
    size = len(places) + 4
    rows = np.zeros((len(places), size))
    for i, place in enumerate(places):
        rows[i, i] = -1.0
        rows[i, len(places) :] = shares(*place)
    return rows


@pytest.mark.parametrize(
    ("mass", "stiffness", "dt", "speed"), [(1.0, 1e4, 0.004, 1.0), (3.0, 200.0, 0.1, 0.3), (0.02, 5e5, 1e-4, 40.0)]
)
def test_d21_penalty_contact_step_by_step(write_deck, tmp_path, mass, stiffness, dt, speed):
    """Force of the place at the start of an increment, none at h = 0; the initial velocity is that of the half step before."""
    scene = Scene(explicit=True)
    node = scene.node(0.0, -speed, mass)
    scene.pair([node], [*linear(stiffness), *UNDAMPED], 1.0, [PENALTY])
    # At w dt = 0.8 the audit speaks of the energy that so coarse an increment makes.
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, 6)), clean="contact has made energy")
    h, v, rows = 0.0, speed, []
    for _ in range(6):
        v -= dt * stiffness * max(h, 0.0) / mass
        h += dt * v
        rows.append((h, v))
    if mass == 1.0:
        published = [(0.004, 1.0), (0.00736, 0.84), (0.0095424, 0.5456), (0.010198016, 0.163904)]
        published += [(0.00922194944, -0.24401664), (0.0067703709696, -0.6128946176)]
        assert np.array(rows) == pytest.approx(np.array(published), rel=1e-13)
    assert -run.node(node, "U3") == pytest.approx([row[0] for row in rows], rel=1e-12)
    assert -run.node(node, "V3") == pytest.approx([row[1] for row in rows], rel=1e-12)


@pytest.mark.parametrize("rigid", [True, False])
def test_d23_the_corrector_of_a_node_on_a_plate(write_deck, tmp_path, rigid):
    """Mass 2 on 6 over four corners, penetration 3e-4, dt 0.01: force 4.5, corrections 2.25 and 0.75; on a wall 6 and 3."""
    slave, plate, depth, dt = 2.0, 6.0, 3e-4, 0.01
    scene = Scene(explicit=True, plate=None if rigid else ([plate / 4] * 4, 0.0))
    node = scene.node(0.0, -depth / dt, slave)
    scene.pair([node], HARD, 1.0, [KINEMATIC])
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, 1)))
    if rigid:
        assert run.node(node, "A3")[0] == pytest.approx(3.0, rel=1e-11)
        assert run.force(node)[0] == pytest.approx(6.0, rel=1e-11)
        assert run.node(node, "U3")[0] == pytest.approx(0.0, abs=1e-14)
        return
    assert run.node(node, "A3")[0] == pytest.approx(2.25, rel=1e-11)
    assert run.force(node)[0] == pytest.approx(4.5, rel=1e-11)
    moved = []
    for corner in CORNERS:
        assert run.node(corner, "A3")[0] == pytest.approx(-0.75, rel=1e-10)
        moved.append(run.node(corner, "U3")[0])
    residual = slave * run.node(node, "A3")[0] + sum(plate / 4 * run.node(n, "A3")[0] for n in CORNERS)
    assert residual == pytest.approx(0.0, abs=1e-11 * 4.5)
    assert run.node(node, "U3")[0] - np.mean(moved) == pytest.approx(0.0, abs=1e-11 * depth)


# Masses and places of the nodes, corners of the plate, speeds, increment.
PLATES = [
    ([2.0], [(0.4, -0.3)], [1.0, 2.0, 0.5, 3.0], [1.0], 0.01),
    ([1.0, 4.0, 0.3], [(0.4, -0.3), (-0.7, 0.1), (0.2, 0.9)], [1.0, 2.0, 0.5, 3.0], [1.0, 0.2, 2.0], 0.003),
    ([5.0, 5.0], [(-0.5, -0.5), (0.5, 0.5)], [0.1, 0.1, 0.1, 0.1], [0.7, 0.9], 0.02),
]


@pytest.mark.parametrize(("masses", "places", "corners", "speeds", "dt"), PLATES)
@pytest.mark.parametrize("law", [None, curves.Linear(300.0), curves.Exponential(0.02, 5.0, 2e3)])
@pytest.mark.parametrize("enforcement", ["kinematic", "penalty"])
def test_d24_momentum_is_exact(write_deck, tmp_path, masses, places, corners, speeds, dt, law, enforcement):
    """Several nodes on one plate, off its middle: forces by shape functions, total momentum and every acceleration."""
    if law is None and enforcement == "penalty":
        pytest.skip("the automatic penalty has no closed form here")
    scene = Scene(explicit=True, plate=(corners, 0.1))
    gap, area = 0.3 * dt, 0.6
    nodes = [scene.node(gap, -v, m, at=xy) for m, xy, v in zip(masses, places, speeds, strict=True)]
    behavior = (
        HARD
        if law is None
        else linear(law.stiffness)
        if isinstance(law, curves.Linear)
        else exponential(law.clearance, law.pressure, law.ceiling)
    )
    scene.pair(
        nodes,
        [*behavior, *([] if law is None else UNDAMPED)],
        area,
        [KINEMATIC if enforcement == "kinematic" else PENALTY],
    )
    count = 12
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    labels, inertia = [*nodes, *CORNERS], np.array([*masses, *corners])
    begin = np.dot(masses, [-v for v in speeds]) + 0.1 * sum(corners)
    momentum = sum(m * run.node(n, "V3") for m, n in zip(inertia, labels, strict=True))
    strength = inertia @ np.abs([*speeds, *[0.1] * 4])
    assert momentum == pytest.approx(begin, abs=1e-11 * strength)
    size = len(nodes)
    contact = system.Contact(plate_rows(places), np.full(size, -gap), np.full(size, area), law)
    structure = system.Structure(np.diag(inertia), np.zeros((size + 4, size + 4)), contact)
    start = [*(-v for v in speeds), *[0.1] * 4]
    other = explicit.march(structure, start, dt, count, enforcement, secondary=list(range(size)))
    for i, label in enumerate(labels):
        scale = np.abs(other.velocity).max()
        assert run.node(label, "V3") == pytest.approx(other.velocity[:, i], abs=1e-9 * scale)
    for i, node in enumerate(nodes):
        assert run.force(node) == pytest.approx(other.contact_force[:, i], abs=1e-9 * other.contact_force.max())


@pytest.mark.parametrize(("masses", "speeds"), [((2.0, 3.0), (4.0, -1.0)), ((1.0, 8.0), (0.5, -0.1))])
def test_d28_two_free_masses_by_penalty_and_by_the_corrector(write_deck, tmp_path, masses, speeds):
    """Elastic by the penalty, plastic by the corrector; the deck's upper mass is the first."""
    together, impulse, lost = theory.plastic(masses, speeds)
    closing = speeds[0] - speeds[1]
    found = {}
    stiffness = 1e5
    w = frequency(masses[0] * masses[1] / sum(masses), stiffness)
    for name, word in (("penalty", PENALTY), ("kinematic", KINEMATIC)):
        dt = 0.05 / w
        scene = Scene(explicit=True, plate=([masses[1] / 4] * 4, -speeds[1]))
        node = scene.node(2.5 * dt * closing, -speeds[0], masses[0])
        behavior = HARD if name == "kinematic" else [*linear(stiffness), *UNDAMPED]
        scene.pair([node], behavior, 1.0, [word])
        run = solve(write_deck, tmp_path / name, scene.text(scene.step(dt, 75)), f"{name}.inp")
        after = -run.node(node, "V3")[-1], -run.node(5, "V3")[-1]
        found[name] = run
        if name == "kinematic":
            assert after == pytest.approx((together, together), rel=1e-9)
            assert run.energy("ALLKE")[-1] == pytest.approx(run.energy("ALLKE")[0] - lost, rel=1e-9)
            assert run.energy("IMPACT_LOSS")[-1] == pytest.approx(lost, rel=1e-9)
            assert (run.force(node) * dt).sum() == pytest.approx(impulse, rel=1e-9)
        else:
            assert after[0] - after[1] == pytest.approx(-closing, rel=0.01)
            assert run.energy("ALLKE")[-1] == pytest.approx(run.energy("ALLKE")[0], rel=0.01)


def test_two_masses_pressed_together_reach_the_law(write_deck, tmp_path):
    """Softened kinematic contact with a deformable primary: damped by dashpots it settles where A p(h) is the force."""
    for number, law in enumerate((curves.Linear(4e4), curves.Exponential(0.01, 30.0))):
        mass, force, area = 1.5, 60.0, 0.8
        scene = Scene(explicit=True, plate=([mass / 4] * 4, 0.0))
        node = scene.node(0.02, mass=mass)
        behavior = linear(law.stiffness) if number == 0 else exponential(law.clearance, law.pressure)
        scene.pair([node], [*behavior, *UNDAMPED], area, [KINEMATIC])
        for label, c in ((node, 40.0), *((n, 10.0) for n in CORNERS)):
            scene.dashpot([label], c)
        load = ["*CLOAD", f"{node}, 3, {-force!r}", *(f"{n}, 3, {force / 4!r}" for n in CORNERS)]
        text = scene.text(
            scene.step(
                2e-4,
                10000,
                *load,
                output=[
                    "*NODE PRINT, NSET=MOVING, FREQUENCY=100",
                    "U",
                    "*CONTACT PRINT, FREQUENCY=100",
                    "CSTR, CDIS",
                    "*END STEP",
                ],
            )
        )
        run = solve(write_deck, tmp_path / str(number), text, f"deck{number}.inp")
        overclosure, pressure = -run.point(node, "COPEN")[-1], run.point(node, "CPRESS")[-1]
        assert pressure == pytest.approx(force / area, rel=1e-6)
        assert area * law(overclosure)[0] == pytest.approx(force, rel=1e-6)
        total = mass * run.node(node, "V3")[-1] + sum(mass / 4 * run.node(n, "V3")[-1] for n in CORNERS)
        assert abs(total) < 1e-9


@pytest.mark.parametrize("fraction", [0.0, 0.03, 0.2])
@pytest.mark.parametrize(("mass", "stiffness"), [(2.0, 1e6), (0.05, 30.0)])
def test_d18_automatic_increments_keep_to_the_contact_spring(write_deck, tmp_path, fraction, mass, stiffness):
    """In contact dt = 2 / w (sqrt(1 + xi^2) - xi) at most, and not much less."""
    w = frequency(mass, stiffness)
    limit = 2.0 / w * (math.sqrt(1.0 + fraction**2) - fraction)
    scene = Scene(explicit=True)
    node = scene.node(0.0, -1.0, mass)
    behavior = [*linear(stiffness), "*CONTACT DAMPING, DEFINITION=CRITICAL DAMPING FRACTION", f"{fraction!r},"]
    scene.pair([node], behavior, 1.0, [PENALTY])
    step = ["*STEP", "*DYNAMIC, EXPLICIT", f", {3000.0 / w!r}", "*BULK VISCOSITY", "0., 0.", *scene.pairs]
    # At the limit itself a bounce makes energy, and the audit says so.
    run = solve(write_deck, tmp_path, scene.text([*step, *scene.implicit(1.0, 1)[3:]]), clean="contact has made energy")
    sizes = np.array([float(row["dt"]) for row in run.history])
    touching = run.force(node) > 0.0
    assert touching.any()
    assert sizes[touching].max() <= limit * (1.0 + 1e-9)
    assert sizes[touching].min() > 0.85 * limit


def test_d31_automatic_increments_keep_to_the_slope_of_a_curved_law(write_deck, tmp_path):
    """2 sqrt(m / (A p'(h))) at the depth that contact has reached."""
    law, mass, area, speed = curves.Exponential(1e-4, 1e6), 1.0, 1e-3, 0.5
    scene = Scene(explicit=True)
    node = scene.node(1e-4, -speed, mass)
    scene.pair([node], [*exponential(1e-4, 1e6), *UNDAMPED], area, [PENALTY])
    step = ["*STEP", "*DYNAMIC, EXPLICIT", ", 0.0012", "*BULK VISCOSITY", "0., 0.", *scene.pairs]
    run = solve(write_deck, tmp_path, scene.text([*step, *scene.implicit(1.0, 1)[3:]]))
    sizes = np.array([float(row["dt"]) for row in run.history])
    before = 1e-4 + np.concatenate([[0.0], run.node(node, "U3")[:-1]])
    for size, h in zip(sizes[:-1], -before[:-1], strict=True):
        slope = law(h)[1]
        if slope > 0.0:
            assert size <= 2.0 * math.sqrt(mass / (area * slope)) * (1.0 + 1e-9)
    assert run.node(node, "V3")[-1] == pytest.approx(speed, rel=0.2)


@pytest.mark.parametrize("elements", [1, 10])
def test_d19_d20_the_default_penalty_costs_at_most_four_percent(write_deck, tmp_path, elements):
    """Automatic increments of a bar by hard penalty contact: those of the bar before, at least 0.96 of them in contact; 1 / sqrt(1 + q)
    is the nodal estimate for a penalty of q times 4 m / dt^2."""
    length, area, young, density, speed = 2.0, 0.2, 200e9, 7800.0, 1.5
    free = length / elements * math.sqrt(density / young)
    runs = []
    for scale in (1.0, 30.0):
        scene = Scene(explicit=True)
        labels = scene.bar(elements, length, area, young, density, start=3.0 * free * speed, velocity=-speed)
        scene.pair(labels[:1], [*HARD, *UNDAMPED], 1.0, [PENALTY, "CPSET=BARWALL"])
        controls = [f"*CONTACT CONTROLS, CPSET=BARWALL, SCALE PENALTY={scale!r}"]
        step = ["*STEP", "*DYNAMIC, EXPLICIT", f", {60.0 * length * math.sqrt(density / young)!r}"]
        step += ["*BULK VISCOSITY", "0., 0.", *scene.pairs, *controls]
        name = f"scale{int(scale)}"
        runs.append(
            (
                scale,
                labels[0],
                solve(
                    write_deck,
                    tmp_path / name,
                    scene.text([*step, *scene.implicit(1.0, 1)[3:]]),
                    f"{name}.inp",
                    clean=False,
                ),
            )
        )
    kappa = 1.0 / 0.96**2 - 1.0
    end = 0.5 * density * area * length / elements
    for scale, node, run in runs:
        sizes = np.array([float(row["dt"]) for row in run.history])
        touching = run.force(node) > 0.0
        assert sizes.max() <= free * (1.0 + 1e-9)
        assert (
            sizes[touching].min() >= free / math.sqrt(1.0 + scale * kappa) * (1.0 - 1e-9)
            or sizes[touching].argmin() == len(sizes) - 1
        )
        before = np.concatenate([[3.0 * free * speed], 3.0 * free * speed + run.node(node, "U3")[:-1]])
        pressed = touching & (before < -1e-9 * speed * free)
        stiffness = np.median(run.force(node)[pressed] / -before[pressed])
        assert stiffness == pytest.approx(scale * kappa * 4.0 * end / free**2, rel=0.1)
