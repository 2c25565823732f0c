"""Steps, amplitudes and loads over time: a column of two bricks above a wall, linear contact, closed form at every increment."""

import pytest

import support
from verification.columns import LAWS, Block, stack

# Each half of the column has a stiffness of 2000, contact one of 500.
COLUMN = {
    "TOP": Block((0.0, 0.0, 0.0), (1.0, 2.0, 1.0), (1, 1, 2), 500.0),
    "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 2.5, 0.0), (1, 1, 1), 1000.0),
}
MIDDLE = ["*NSET, NSET=MIDDLE", "5, 6, 7, 8"]
SUPPORTS = ["*BOUNDARY", "BOTTOM_ALL, 1, 3", "TOP_ALL, 1, 2"]
OUTPUT = ["*NODE PRINT, NSET=TOP_HIGH, TOTALS=YES", "U, RF", "*END STEP"]


def contact_force(push, load=0.0):
    """Contact force of the column pushed down at its top, with a load down on its middle."""
    return 400.0 * (load + 2000.0 * push) / 2400.0


def solve(write_deck, tmp_path, steps, model=()):
    """(step, time within the run, contact force, displacement of the top) of every increment."""
    deck = write_deck(stack(COLUMN, LAWS["linear"], [*MIDDLE, *model, *SUPPORTS, *steps]))
    result = support.run(deck, tmp_path)
    nodes = {row["time"]: float(row["U3"]) for row in result.table("nodes")}
    rows = result.table("history")
    found = [(int(r["step"]), float(r["time"]), float(r["CFN3[TOP_DOWN_BOTTOM_UP]"]), nodes[r["time"]]) for r in rows]
    return found, result


def step(*lines, increment=0.25, period=1.0):
    """A step with fixed increments."""
    return ["*STEP", "*STATIC, DIRECT", f"{increment}, {period}", *lines, *OUTPUT]


def test_displacements_ramp_from_step_to_step(write_deck, tmp_path):
    steps = step("*BOUNDARY", "TOP_HIGH, 3, 3, -0.04") + step("*BOUNDARY", "TOP_HIGH, 3, 3, -0.08", period=2.0)
    rows, result = solve(write_deck, tmp_path, steps)
    assert [row[0] for row in rows] == [1] * 4 + [2] * 8
    for number, time, force, displacement in rows:
        push = 0.04 * time if number == 1 else 0.04 + 0.02 * (time - 1.0)
        assert displacement == pytest.approx(-push, rel=1e-13)
        assert force == pytest.approx(contact_force(push), rel=1e-12)
    summary = result.summary()["steps"]
    assert [s["increments"] for s in summary] == [4, 8]
    assert [s["time_reached"] for s in summary] == [1.0, 3.0]
    assert sum(s["factorizations"] for s in summary) == 1, "the wall has no free direction, the column is factored once"


def test_an_amplitude_is_followed_up_and_down(write_deck, tmp_path):
    model = ["*AMPLITUDE, NAME=CYCLE", "0., 0., 0.5, 1., 1., 0.25, 1.5, -0.5"]
    steps = step("*BOUNDARY, AMPLITUDE=CYCLE", "TOP_HIGH, 3, 3, -0.08", increment=0.125, period=1.5)
    rows, _ = solve(write_deck, tmp_path, steps, model)
    assert len(rows) == 12
    for _, time, force, displacement in rows:
        factor = 2.0 * time if time <= 0.5 else 1.0 - 1.5 * (time - 0.5)
        assert displacement == pytest.approx(-0.08 * factor, rel=1e-12, abs=1e-15)
        assert force == pytest.approx(contact_force(max(0.0, 0.08 * factor)), rel=1e-11, abs=1e-12)


def test_loads_ramp_stay_and_are_removed(write_deck, tmp_path):
    steps = step("*BOUNDARY", "TOP_HIGH, 3, 3, -0.04")
    steps += step("*CLOAD", "MIDDLE, 3, -15.")
    steps += step("*BOUNDARY", "TOP_HIGH, 3, 3, -0.06")
    steps += step("*CLOAD, OP=NEW")
    rows, _ = solve(write_deck, tmp_path, steps)
    for number, time, force, _ in rows:
        push = 0.04 * min(time, 1.0) + 0.02 * min(max(time - 2.0, 0.0), 1.0)
        load = 60.0 * min(max(time - 1.0, 0.0), 1.0)
        if number < 4:
            assert force == pytest.approx(contact_force(push, load), rel=1e-12), (number, time)
    assert rows[-1][2] == pytest.approx(contact_force(0.06), rel=1e-12)


def test_gravity_hangs_on_top_and_presses_below(write_deck, tmp_path):
    """Gravity 10 on density 3 over a volume of 2: half of the weight hangs on each half of the column."""
    deck = stack(COLUMN, LAWS["linear"], [*MIDDLE, *SUPPORTS, *step("*DLOAD", "ETOP, GRAV, 10., 0., 0., -1.")])
    heavy = deck.replace("*ELASTIC\n500.0, 0.", "*ELASTIC\n500.0, 0.\n*DENSITY\n3.", 1)
    assert heavy != deck
    path = write_deck(heavy.replace("TOP_ALL, 1, 2", "TOP_ALL, 1, 2\nTOP_HIGH, 3, 3"))
    row = support.run(path, tmp_path).last("history")[0]
    # Nodal forces of the weight 60: 15 at the top, 30 in the middle, 15 at the bottom; two springs of 2000 in a row.
    # Middle v and bottom w, downwards: 4000 v - 2000 w = 30, -2000 v + 2500 w = 15.
    middle = (30.0 + 0.8 * 15.0) / 2400.0
    bottom = (15.0 + 2000.0 * middle) / 2500.0
    assert float(row["CFN3[TOP_DOWN_BOTTOM_UP]"]) == pytest.approx(500.0 * bottom, rel=1e-12)
    assert float(row["RF3[TOP_HIGH]"]) == pytest.approx(60.0 - 500.0 * bottom, rel=1e-12)


def test_a_pressure_acts_into_the_body(write_deck, tmp_path):
    """Pressure 5 on the top face of a column held at its middle: nothing reaches the contact, the middle carries 10."""
    lines = ["*DSLOAD", "TOP_UP, P, 5.", "*NODE PRINT, NSET=MIDDLE, TOTALS=YES", "RF"]
    deck = stack(COLUMN, LAWS["linear"], [*MIDDLE, *SUPPORTS, "MIDDLE, 3, 3", *step(*lines)])
    row = support.run(write_deck(deck), tmp_path).last("history")[0]
    assert float(row["RF3[MIDDLE]"]) == pytest.approx(10.0, rel=1e-12)
    assert abs(float(row["CFN3[TOP_DOWN_BOTTOM_UP]"])) < 1e-12
