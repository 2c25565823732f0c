"""The impact algorithm of implicit dynamics with hard contact (D08 to D12): times, impulses, losses, release."""

import math

import numpy as np
import pytest

from oracle.dynamics import implicit, system, theory
from verification.dynamics.motion import HARD, Scene, crossing, solve

MASSES = [((2.0, 3.0), (4.0, -1.0)), ((1.0, 1.0), (3.0, 0.0)), ((0.02, 50.0), (-1.0, -7.0)), ((5.0, 0.3), (0.0, -2.0))]


@pytest.mark.parametrize("gap", [0.0, 0.0117])
@pytest.mark.parametrize(("masses", "speeds"), MASSES)
def test_d08_two_masses_meet_and_stay_together(write_deck, tmp_path, masses, speeds, gap):
    """Common velocity, loss m1 m2 / (m1 + m2) dv^2 / 2 and momentum."""
    scene = Scene()
    near, far = scene.node(1.0, speeds[0], masses[0]), scene.node(1.5, speeds[1], masses[1])
    scene.gap(near, far, gap, HARD)
    dt, count = 0.004, 6
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    together, _, lost = theory.plastic(masses, speeds)
    when = gap / (speeds[0] - speeds[1])
    for label, speed in ((near, speeds[0]), (far, speeds[1])):
        met = run.time >= when
        assert run.node(label, "V3")[met] == pytest.approx(together, rel=1e-12)
        place = np.where(met, speed * when + together * (run.time - when), speed * run.time)
        assert run.node(label, "U3") == pytest.approx(place, rel=1e-10, abs=1e-13)
    assert run.energy("IMPACT_LOSS")[-1] == pytest.approx(lost, rel=1e-12)
    begin = 0.5 * np.dot(masses, np.square(speeds))
    assert run.energy("ALLKE")[-1] == pytest.approx(begin - lost, rel=1e-11)
    assert run.energy("ETOTAL") == pytest.approx(run.energy("ETOTAL")[0], abs=1e-11 * begin)


def test_masses_that_part_do_not_meet(write_deck, tmp_path):
    scene = Scene()
    near, far = scene.node(1.0, -1.0, 2.0), scene.node(1.5, 0.5, 3.0)
    scene.gap(near, far, 0.0, HARD)
    run = solve(write_deck, tmp_path, scene.text(scene.step(0.01, 3)))
    assert run.node(near, "V3") == pytest.approx(-1.0, rel=1e-13)
    assert run.node(far, "V3") == pytest.approx(0.5, rel=1e-13)
    assert run.energy("IMPACT_LOSS").max() == 0.0


@pytest.mark.parametrize("elements", [1, 2, 5])
@pytest.mark.parametrize("lumped", [True, False])
def test_d09_a_consistent_mass_spreads_the_jump(write_deck, tmp_path, elements, lumped):
    """Velocities of a bar without stiffness to speak of after its end has met the wall; loss by the jump of the end."""
    length, area, density, speed, dt, gap = 1.3, 0.5, 12.0, 2.0, 0.01, 0.005
    scene = Scene()
    labels = scene.bar(elements, length, area, 1e-12, density, gap, -speed)
    scene.pair(labels[:1], HARD)
    words = ["MASS=LUMPED" if lumped else "MASS=CONSISTENT"]
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, 3, words=words)))
    mass, _ = system.bar(elements, length, area, 1e-12, density, consistent=not lumped)
    structure = system.Structure(mass, np.zeros_like(mass), system.wall(elements + 1, gap))
    other = implicit.march(structure, [-speed] * (elements + 1), dt, 3)
    if elements == 1:
        whole = density * area * length
        assert other.velocity[-1] == pytest.approx([0.0, -speed if lumped else -1.5 * speed], abs=1e-12)
        assert other.impact_loss[-1] == pytest.approx(whole * speed**2 * (0.25 if lumped else 0.125), rel=1e-12)
    run = run.at(other.time)
    for i, label in enumerate(labels):
        assert run.node(label, "V3") == pytest.approx(other.velocity[:, i], abs=1e-10 * speed)
        assert run.node(label, "U3") == pytest.approx(other.displacement[:, i], abs=1e-10 * speed * dt)
    assert run.energy("IMPACT_LOSS") == pytest.approx(other.impact_loss, rel=1e-10)
    assert run.energy("ALLKE") == pytest.approx(other.kinetic, rel=1e-9)


# Mass, gap, speed, increment; the first is published.
INTERPOLATED = [(2.0, 0.01, 1.0, 0.004), (0.3, 0.0731, 2.0, 0.01), (50.0, 1e-5, 3e-4, 0.02), (1.0, 0.012, 1.0, 0.004)]


def count_of(gap, speed, dt):
    """The gap, where it is met at the end of an increment."""
    return gap if abs(gap / speed / dt - round(gap / speed / dt)) < 1e-9 else None


@pytest.mark.parametrize(("mass", "gap", "speed", "dt"), INTERPOLATED)
def test_d10_the_time_of_an_impact_is_interpolated(write_deck, tmp_path, mass, gap, speed, dt):
    """tau = c_start / (c_start - c_end) of the increment; the mass then rests on the wall."""
    scene = Scene()
    node = scene.node(gap, -speed, mass)
    scene.pair([node], HARD)
    count = math.ceil(gap / speed / dt - 1e-9) + 2
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    met = run.time > gap / speed * (1.0 + 1e-12)
    assert run.node(node, "U3") == pytest.approx(np.where(met, -gap, -speed * run.time), rel=1e-10)
    for column in ("V3", "A3"):
        assert run.node(node, column)[met] == pytest.approx(0.0, abs=1e-10 * speed)
    assert run.energy("IMPACT_LOSS")[-1] == pytest.approx(0.5 * mass * speed**2, rel=1e-10)
    assert run.point(node, "COPEN")[-1] == pytest.approx(0.0, abs=1e-15)
    (change,) = [c for c in run.summary["status_changes"] if c["to"] == "CL"]
    # Where it falls on the end of an increment, the next one begins with it.
    assert change["time"] == pytest.approx(gap / speed, rel=1e-10, abs=dt if gap == count_of(gap, speed, dt) else 0.0)


# Masses, gaps, speeds, increment, increment of the impact (from 0), mean fraction.
TOGETHER = [
    ((1.0, 4.0), (0.010, 0.011), (1.0, 1.0), 0.004, 2, 0.625),
    ((2.0, 2.0, 0.5), (0.021, 0.029, 0.0475), (1.0, 1.5, 2.0), 0.01, None, None),
    ((3.0, 1.0), (0.0, 0.003), (0.5, 1.0), 0.004, 0, 0.0),
]


@pytest.mark.parametrize(("masses", "gaps", "speeds", "dt", "number", "fraction"), TOGETHER)
def test_d11_points_that_close_in_one_increment_close_at_their_mean(
    write_deck, tmp_path, masses, gaps, speeds, dt, number, fraction
):
    """All of them change together at the mean fraction, and their clearance there counts as zero from then on."""
    scene = Scene(side=4.0)
    nodes = [
        scene.node(gap, -speed, mass, at=(0.3 * i, 0.0))
        for i, (mass, gap, speed) in enumerate(zip(masses, gaps, speeds, strict=True))
    ]
    scene.pair(nodes, HARD)
    count = 12
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    size = len(nodes)
    contact = system.Contact(-np.eye(size), -np.array(gaps), np.ones(size))
    other = implicit.march(
        system.Structure(np.diag(masses), np.zeros((size, size)), contact), [-s for s in speeds], dt, count
    )
    if fraction is not None and number:
        (event,) = other.events
        assert event[0] == pytest.approx((number + fraction) * dt, rel=1e-12)
    run = run.at(other.time)
    for i, node in enumerate(nodes):
        assert run.node(node, "U3") == pytest.approx(other.displacement[:, i], rel=1e-10)
        assert run.node(node, "V3") == pytest.approx(other.velocity[:, i], abs=1e-10)
        assert run.point(node, "COPEN")[-1] == pytest.approx(0.0, abs=1e-14)
    assert run.energy("IMPACT_LOSS")[-1] == pytest.approx(0.5 * np.dot(masses, np.square(speeds)), rel=1e-10)


@pytest.mark.parametrize(("mass", "press", "rate"), [(2.0, 10.0, 100.0), (0.1, 3.0, 7.0)])
def test_d11_a_point_opens_where_its_force_ends(write_deck, tmp_path, mass, press, rate):
    """`tau = la_start / (la_start - la_end)`, no jump of velocity; then u = rate (t - t0)^3 / (6 m)."""
    leave = press / rate
    dt, count = leave / 7.3, 40
    scene = Scene()
    node = scene.node(0.0, mass=mass)
    scene.pair([node], HARD)
    end = dt * count
    amplitude = ["*AMPLITUDE, NAME=RISE", f"0., {-press!r}, {2.0 * end!r}, {rate * 2.0 * end - press!r}"]
    load = ["*CLOAD, AMPLITUDE=RISE", f"{node}, 3, 1."]
    scene.cards += amplitude
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count, *load, alpha=0.0)))
    flown = np.maximum(run.time - leave, 0.0)
    assert run.node(node, "U3") == pytest.approx(rate * flown**3 / (6.0 * mass), abs=0.01 * rate * end**3 / mass / 6)
    assert run.node(node, "V3") == pytest.approx(rate * flown**2 / (2.0 * mass), abs=0.005 * rate * end**2 / mass / 2)
    held = run.time < leave
    assert run.force(node)[held] == pytest.approx(press - rate * run.time[held], rel=1e-9)
    assert run.force(node)[~held] == pytest.approx(0.0, abs=1e-9 * press)
    assert run.energy("IMPACT_LOSS").max() == 0.0
    (change,) = [c for c in run.summary["status_changes"] if c["to"] == "OP"]
    assert change["time"] == pytest.approx(leave, rel=1e-9)


# Front, rear, spring, speed; the first is published.
SPRUNG = [(1.0, 4.0, 900.0, 2.0), (2.0, 1.0, 5e3, 0.7), (0.1, 9.0, 40.0, 3.0)]


@pytest.mark.parametrize(("front", "rear", "stiffness", "speed"), SPRUNG)
@pytest.mark.parametrize("gap", [0.0, 0.013])
def test_d12_impact_then_release(write_deck, tmp_path, front, rear, stiffness, speed, gap):
    """The front mass stops, the rear one swings half a period, the centre of mass comes back with m_rear / m of the speed."""
    half = math.pi * math.sqrt(rear / stiffness)
    dt = half / 400
    count = int((gap / speed + 1.6 * half) / dt)
    scene = Scene()
    near, far = scene.node(gap, -speed, front), scene.node(gap + 1.0, -speed, rear)
    scene.spring([near, far], stiffness)
    scene.pair([near], HARD)
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    begin, whole = gap / speed, front + rear
    assert run.energy("IMPACT_LOSS")[-1] == pytest.approx(0.5 * front * speed**2, rel=1e-10)
    force = run.force(near)
    assert force.max() == pytest.approx(speed * math.sqrt(rear * stiffness), rel=0.002)
    assert run.time[np.flatnonzero(force > 0.0)[-1]] - begin == pytest.approx(half, abs=2.0 * dt)
    first = np.flatnonzero(run.time > begin)[0]
    assert force[first] < 0.02 * force.max()
    together = (front * run.node(near, "V3") + rear * run.node(far, "V3")) / whole
    assert together[-1] == pytest.approx(speed * rear / whole, rel=0.002)
    vibration = run.energy("ALLKE")[-1] + run.energy("ALLSE")[-1] - 0.5 * whole * together[-1] ** 2
    assert vibration == pytest.approx(0.5 * front * rear / whole * speed**2, rel=0.01)
    assert np.abs(np.diff(run.energy("ETOTAL"))).max() < 1e-3 * 0.5 * whole * speed**2


def test_d12_follows_the_oracle(write_deck, tmp_path):
    """Places and speeds of the published case with both marches at the same increments."""
    dt, count = 5e-4, 800
    scene = Scene()
    near, far = scene.node(0.0, -2.0, 1.0), scene.node(1.0, -2.0, 4.0)
    scene.spring([near, far], 900.0)
    scene.pair([near], HARD)
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    structure = system.Structure(*system.chain([1.0, 4.0], [900.0]), system.wall(2, 0.0))
    other = implicit.march(structure, [-2.0, -2.0], dt, count)
    run = run.at(other.time)
    for i, label in enumerate((near, far)):
        assert run.node(label, "U3") == pytest.approx(other.displacement[:, i], abs=2e-4)
        assert run.node(label, "V3") == pytest.approx(other.velocity[:, i], abs=2e-3)
    assert crossing(run.time, run.node(near, "U3"), 1e-9, True) == pytest.approx(0.2094, abs=2e-3)


@pytest.mark.parametrize("seed", range(6))
def test_random_chains_of_masses_follow_the_oracle(write_deck, tmp_path, seed):
    """Three to six masses on springs, with hard gaps between some of them and a wall: places of the oracle at small increments."""
    rng = np.random.default_rng((seed, 63))
    size = int(rng.integers(3, 7))
    masses = rng.uniform(0.5, 2.0, size)
    springs = rng.uniform(50.0, 400.0, size - 1) * (rng.random(size - 1) < 0.6)
    speeds = rng.uniform(-2.0, 0.5, size)
    gap, dt, count = float(rng.uniform(0.01, 0.05)), 5e-4, 600
    scene = Scene()
    labels = [scene.node(gap + i, float(v), float(m)) for i, (v, m) in enumerate(zip(speeds, masses, strict=True))]
    rows, initial = [np.eye(size)[0] * -1.0], [-gap]
    scene.pair(labels[:1], HARD)
    for i, k in enumerate(springs):
        if k:
            scene.spring(labels[i : i + 2], float(k))
        else:
            between = float(rng.uniform(0.005, 0.05))
            # The gap opens where the upper node moves up.
            scene.gap(labels[i], labels[i + 1], between, HARD)
            row = np.zeros(size)
            row[i : i + 2] = 1.0, -1.0
            rows.append(row)
            initial.append(-between)
    run = solve(write_deck, tmp_path, scene.text(scene.step(dt, count)))
    contact = system.Contact(np.array(rows), np.array(initial), np.ones(len(rows)))
    other = implicit.march(system.Structure(*system.chain(masses, springs), contact), speeds, dt, count)
    # After an event the solver takes small increments first: the difference is that of the time operator.
    run = run.at(other.time)
    for i, label in enumerate(labels):
        assert run.node(label, "U3") == pytest.approx(other.displacement[:, i], abs=2e-3)
    begin = 0.5 * masses @ speeds**2
    assert run.energy("IMPACT_LOSS")[-1] == pytest.approx(other.impact_loss[-1], abs=5e-3 * begin)
    assert run.energy("ETOTAL") == pytest.approx(begin, abs=5e-3 * begin)
