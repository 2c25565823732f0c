"""Elastic bars on a rigid wall and on each other (D13 to D17, D32): contact times, forces and speeds of wave theory."""

import math

import numpy as np
import pytest

from oracle.dynamics import curves, explicit, implicit, system, theory
from verification.dynamics import bars
from verification.dynamics.motion import HARD, UNDAMPED, Scene, linear, solve

TRUSS = {"length": 2.0, "area": 0.2, "young": 200e9, "density": 7800.0}
SPEED = 1.5
# Another bar: 0.35 long, of a polymer, at 4.
OTHER = {"length": 0.35, "area": 3e-4, "young": 2.5e9, "density": 1150.0}


def impedance(bar):
    """Density times wave speed times area."""
    return bar["density"] * theory.wave_speed(bar["young"], bar["density"]) * bar["area"]


def weights(elements):
    """Shares of lumped nodes in the mass of a bar."""
    nodal = np.ones(elements + 1)
    nodal[[0, -1]] = 0.5
    return nodal / elements


def on_wall(write_deck, tmp_path, bar, speed, gap, elements, explicitly, step, behavior=HARD, words=()):
    """The run of a bar that flies at the wall, the labels of its nodes, and the speed of its centre of mass."""
    scene = Scene(explicit=explicitly)
    labels = scene.bar(elements, **bar, start=gap, velocity=-speed)
    scene.pair(labels[:1], behavior, 1.0, words)
    run = solve(write_deck, tmp_path, scene.text(step(scene)))
    middle = sum(w * run.node(n, "V3") for w, n in zip(weights(elements), labels, strict=True))
    return run, labels, middle


def mean_force(run, node, begin, duration):
    """Mean of the contact force over the middle 80 % of the time in contact."""
    inside = (run.time > begin + 0.1 * duration) & (run.time < begin + 0.9 * duration)
    return run.force(node)[inside].mean()


@pytest.mark.parametrize("procedure", ["kinematic", "penalty", "implicit"])
@pytest.mark.parametrize(("bar", "speed", "gap"), [(TRUSS, SPEED, 0.001), (OTHER, 4.0, 0.0004)])
def test_d13_a_bar_on_a_rigid_wall(write_deck, tmp_path, procedure, bar, speed, gap):
    """Ten elements: it meets the wall at gap / v, for 2 L / c, with the force Z v; 3 % as meshes go. Explicit increments are automatic.

    The default penalty is as soft as six elements of any size: by penalties there are forty, and it is made ten times stiffer.
    """
    c, elements = theory.wave_speed(bar["young"], bar["density"]), 40 if procedure == "penalty" else 10
    duration, begin = 2.0 * bar["length"] / c, gap / speed
    dt, period = bar["length"] / elements / c / 4.0, begin + 2.0 * duration

    def step(scene):
        if procedure == "implicit":
            return scene.implicit(dt, int(period / dt))
        head = ["*STEP", "*DYNAMIC, EXPLICIT", f", {period!r}", "*BULK VISCOSITY", "0., 0."]
        controls = ["*CONTACT CONTROLS, CPSET=BARWALL, SCALE PENALTY=10."] if procedure == "penalty" else []
        return [*head, *scene.pairs, *controls, *scene.implicit(dt, 1)[3:]]

    words = [] if procedure == "implicit" else [f"MECHANICAL CONSTRAINT={procedure.upper()}", "CPSET=BARWALL"]
    explicitly = procedure != "implicit"
    run, labels, middle = on_wall(write_deck, tmp_path, bar, speed, gap, elements, explicitly, step, words=words)
    force = run.force(labels[0])
    touching = run.time[force > 0.01 * force.max()]
    size = np.diff(run.time).max()
    # A penalty pushes in the increment after the one in which surfaces meet.
    late = 2.01 if procedure == "penalty" else 1.01
    assert touching[0] == pytest.approx(begin, abs=late * size)
    assert touching[-1] - begin == pytest.approx(duration, rel=0.03, abs=late * size)
    assert mean_force(run, labels[0], begin, duration) == pytest.approx(impedance(bar) * speed, rel=0.03)
    mass = bar["density"] * bar["area"] * bar["length"]
    # The end node loses its energy, 1 / (2 n) of the speed; the implicit operator damps waves besides.
    assert middle[-1] == pytest.approx(speed, rel=0.1 if procedure == "implicit" else 0.06)
    sizes = np.diff(run.time, prepend=0.0)
    if explicitly:
        impulse = (force * sizes).sum()
        assert impulse == pytest.approx(2.0 * mass * speed, rel=0.04)
        assert sizes.max() <= bar["length"] / elements / c * (1.0 + 1e-9)
    assert run.energy("ALLSE").max() == pytest.approx(0.5 * mass * speed**2, rel=0.12)


PUBLISHED = {5: (1.35, 8892.0), 10: (1.425, 9126.0), 20: (1.4625, 9243.0), 100: (1.4925, 9336.6)}


@pytest.mark.parametrize("elements", PUBLISHED)
def test_d14_a_lumped_bar_at_courant_number_one(write_deck, tmp_path, elements):
    """Rebound, impulse and the end of contact; every increment that of the oracle."""
    dt = TRUSS["length"] / elements / theory.wave_speed(TRUSS["young"], TRUSS["density"])
    count = 3 * elements
    run, labels, middle = on_wall(
        write_deck, tmp_path, TRUSS, SPEED, 0.0, elements, True, lambda scene: scene.central(dt, count)
    )
    rebound, impulse = PUBLISHED[elements]
    force = run.force(labels[0])
    assert middle[-1] == pytest.approx(rebound, rel=1e-6)
    assert force.sum() * dt == pytest.approx(impulse, rel=1e-6)
    last = np.flatnonzero(force > 1e-6 * force.max())[-1]
    assert run.time[last] == pytest.approx(0.0007899367063, rel=1e-9)
    assert last == 2 * elements - 1
    mass, stiffness = system.bar(elements, **TRUSS)
    structure = system.Structure(mass, stiffness, system.wall(elements + 1, 0.0))
    other = explicit.march(structure, [-SPEED] * (elements + 1), dt, count, explicit.KINEMATIC)
    for i, label in enumerate(labels):
        assert run.node(label, "V3") == pytest.approx(other.velocity[:, i], abs=1e-8 * SPEED)
    assert force == pytest.approx(other.contact_force[:, 0], abs=1e-8 * force.max())
    assert run.energy("ALLKE")[1:] == pytest.approx(other.kinetic[1:], abs=1e-7 * other.kinetic[0])
    assert run.energy("ALLSE") == pytest.approx(other.strain, abs=1e-7 * other.kinetic[0])


@pytest.mark.parametrize("elements", [3, 8, 40])
@pytest.mark.parametrize(("bar", "speed"), [(TRUSS, 0.2), (OTHER, 7.0)])
def test_d32_the_end_node_loses_its_energy(write_deck, tmp_path, elements, bar, speed):
    """e = 1 - 1 / (2 n) of the centre of mass; the loss is that of half an element, and ETOTAL knows where it went."""
    dt = bar["length"] / elements / theory.wave_speed(bar["young"], bar["density"])
    run, _, middle = on_wall(
        write_deck, tmp_path, bar, speed, 0.0, elements, True, lambda scene: scene.central(dt, 4 * elements)
    )
    assert middle[-1] == pytest.approx(speed * (1.0 - 0.5 / elements), rel=1e-6)
    mass = bar["density"] * bar["area"] * bar["length"]
    lost = 0.5 * (0.5 * mass / elements) * speed**2
    energies = run.energy("ALLKE") + run.energy("ALLSE")
    assert run.energy("IMPACT_LOSS")[-1] == pytest.approx(lost, rel=1e-6)
    assert energies[-1] == pytest.approx(0.5 * mass * speed**2 - lost, rel=1e-6)
    assert run.energy("ETOTAL") == pytest.approx(run.energy("ETOTAL")[0], abs=1e-6 * 0.5 * mass * speed**2)


@pytest.mark.parametrize("procedure", ["implicit", "penalty", "kinematic"])
@pytest.mark.parametrize("ratio", [0.2, 1.5])
def test_d15_a_bar_on_softened_contact(write_deck, tmp_path, procedure, ratio):
    """Until the wave comes back, F = Z v (1 - exp(-K t / Z)); `ratio`: K (2 L / c) / Z over ten."""
    elements, bar, speed = 60, OTHER, 3.0
    z, c = impedance(bar), theory.wave_speed(bar["young"], bar["density"])
    duration = 2.0 * bar["length"] / c
    stiffness = 10.0 * ratio * z / duration
    dt = bar["length"] / elements / c / 2.0
    count = int(0.95 * duration / dt)
    explicitly = procedure != "implicit"
    words = [f"MECHANICAL CONSTRAINT={procedure.upper()}"] if explicitly else []
    run, labels, _ = on_wall(
        write_deck,
        tmp_path,
        bar,
        speed,
        0.0,
        elements,
        explicitly,
        lambda scene: scene.step(dt, count),
        behavior=[*linear(stiffness), *(UNDAMPED if explicitly else [])],
        words=words,
    )
    # Forces of explicit increments by penalties stand at their start, kinematic ones at their end.
    at = run.time - dt if procedure == "penalty" else run.time
    expected = z * speed * (1.0 - np.exp(-stiffness * at / z))
    assert run.force(labels[0]) == pytest.approx(expected, abs=0.04 * z * speed)
    mass, matrix = system.bar(elements, **bar)
    structure = system.Structure(mass, matrix, system.wall(elements + 1, 0.0, 1.0, curves.Linear(stiffness)))
    start = [-speed] * (elements + 1)
    if explicitly:
        other = explicit.march(structure, start, dt, count, procedure)
    else:
        other = implicit.march(structure, start, dt, count)
    assert run.force(labels[0]) == pytest.approx(other.contact_force[:, 0], abs=1e-8 * z * speed)


EQUAL = bars.Column(100, 1.0, 25e6, 1.0, 0.0)


@pytest.mark.parametrize("words", [["WEIGHT=1."], ["WEIGHT=0."], []])
def test_d16_equal_bars_exchange_their_motion(write_deck, tmp_path, words):
    """Columns of bricks, explicit, Courant number one: contact for 2 L / c, half the speed between, full exchange; pure and balanced."""
    striker = bars.Column(100, 1.0, 25e6, 1.0, -3.0)
    insist_on_an_exchange(write_deck, tmp_path, striker, EQUAL, words, ratio=1.0)


@pytest.mark.parametrize("parts", [0.5, 0.25])
def test_d17_a_shorter_striker_stops(write_deck, tmp_path, parts):
    """The same bar, shorter: it stops after 2 L1 / c, and the target flies with v L1 / L2."""
    striker = bars.Column(int(100 * parts), parts, 25e6, 1.0, -3.0)
    insist_on_an_exchange(write_deck, tmp_path, striker, EQUAL, ["WEIGHT=1."], ratio=parts)


def insist_on_an_exchange(write_deck, tmp_path, striker, target, words, ratio):
    """A striker from above stops; contact lasts its double passage; the interface moves with half its speed meanwhile."""
    c, v = theory.wave_speed(striker.young, striker.density), striker.velocity
    dt = striker.length / striker.elements / c
    duration = 2.0 * striker.length / c
    count = round(2.6 * target.length / c / dt)
    head = ["*STEP", "*DYNAMIC, EXPLICIT, DIRECT USER CONTROL", f"{dt!r}, {count * dt!r}", "*BULK VISCOSITY", "0., 0."]
    text = bars.deck(striker, target, HARD, head, ["MECHANICAL CONSTRAINT=KINEMATIC", *words])
    run = solve(write_deck, tmp_path, text)
    high, low = bars.boxes(striker, target)
    assert bars.speed(run, high)[-1] == pytest.approx(0.0, abs=0.01 * abs(v))
    assert bars.speed(run, low)[-1] == pytest.approx(ratio * v, rel=0.01)
    momentum = striker.mass * bars.speed(run, high) + target.mass * bars.speed(run, low)
    assert momentum == pytest.approx(striker.mass * v, rel=1e-11)
    # WEIGHT turns the pair round where the first surface is the primary one.
    (column,) = [name for name in run.history[0] if name.startswith("CFN3[")]
    force = np.abs(np.array([float(r[column]) for r in run.history]))
    last = run.time[np.flatnonzero(force > 1e-6 * force.max())[-1]]
    assert last == pytest.approx(duration, abs=2.01 * dt)
    end = [n for n, x in low.nodes.items() if x[2] == 0.0]
    inside = (run.time > 0.1 * duration) & (run.time < 0.9 * duration)
    for node in end:
        assert run.node(node, "V3")[inside] == pytest.approx(0.5 * v, rel=0.01)
    z = striker.density * c * striker.width**2
    assert force[inside] == pytest.approx(0.5 * z * abs(v), rel=0.01)


@pytest.mark.parametrize(
    ("second", "length"),
    [((25e6, 1.0), 1.0), ((100e6, 1.0), 2.0), ((25e6, 4.0), 1.0)],
)
def test_d17_bars_of_any_impedance_by_the_impact_algorithm(write_deck, tmp_path, second, length):
    """Implicit: two rows of bars with a hard gap. Interface velocity v Z1 / (Z1 + Z2), force Z1 Z2 v / (Z1 + Z2)."""
    first, speed, elements = (25e6, 1.0), 3.0, 100
    speeds = [theory.wave_speed(*data) for data in (first, second)]
    z1, z2 = speeds[0] * first[1], speeds[1] * second[1]
    duration = 2.0 * min(1.0 / speeds[0], length / speeds[1])
    dt = 0.5 / elements / max(speeds)
    count = int(1.5 * duration / dt)
    scene = Scene()
    near = scene.bar(elements, 1.0, 1.0, *first, start=1.0, velocity=speed)
    far = scene.bar(elements, length, 1.0, *second, start=2.0)
    scene.gap(near[-1], far[0], 0.0, HARD)
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    inside = (run.time > 0.2 * duration) & (run.time < 0.8 * duration)
    common = speed * z1 / (z1 + z2)
    assert run.node(near[-1], "V3")[inside].mean() == pytest.approx(common, rel=0.01)
    assert run.node(far[0], "V3")[inside].mean() == pytest.approx(common, rel=0.01)
    (name,) = {row["pair"] for row in run.result.table("contact")}
    force = np.array([float(r[f"CFNM[{name}]"]) for r in run.history])
    assert force[inside].mean() == pytest.approx(speed * z1 * z2 / (z1 + z2), rel=0.01)
    # The end nodes take a common velocity at once: half the reduced mass of two half elements.
    ends = 0.5 * first[1] / elements, 0.5 * second[1] * length / elements
    assert run.energy("IMPACT_LOSS")[count // 3] == pytest.approx(theory.plastic(ends, (speed, 0.0))[2], rel=1e-9)
    shares = weights(elements)
    after = [sum(w * run.node(n, "V3")[-1] for w, n in zip(shares, row, strict=True)) for row in (near, far)]
    masses = first[1], second[1] * length
    assert np.dot(masses, after) == pytest.approx(speed, rel=1e-9)
    if masses[0] == masses[1] and z1 == z2:
        assert after == pytest.approx((0.0, speed), abs=0.012 * speed)
    assert math.isclose(run.energy("ETOTAL")[-1], 0.5 * speed**2, rel_tol=0.01)
