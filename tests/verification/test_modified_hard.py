"""Modified hard contact (B17 to B20): tolerances, their limit in number, and the reversal of changes."""

import pytest

import support
from verification.columns import Block, stack
from verification.points import (
    Point,
    amplitude,
    controls,
    deck,
    driver,
    node,
    point,
    rows,
    springs,
    step,
)

HARD = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
# The published loop: u, status, pressure, overclosure. Exact ties (0.02, -0.06) may go either way.
U_PATH = [0.0, 0.01, 0.02, 0.021, 0.03, 0.01, -0.01, -0.05, -0.06, -0.061, -0.02, 0.015, 0.025]
LOOP = [
    *[("OP", 0.0, 0.0), ("OP", 0.0, 0.01), None, ("CL", 1.05, 0.0), ("CL", 1.5, 0.0), ("CL", 0.5, 0.0)],
    *[("CL", -0.5, 0.0), ("CL", -2.5, 0.0), None, ("OP", 0.0, -0.061), ("OP", 0.0, -0.02), ("OP", 0.0, 0.015)],
    ("CL", 1.25, 0.0),
]
NEAR = [0.0, 0.01, 0.0199999, 0.021, 0.03, 0.01, -0.01, -0.05, -0.0599999, -0.061, -0.02, 0.015, 0.025]
# Stiffness, area, UERRMX, PERRMX and path of the other loops.
OTHERS = [
    (100.0, 2.0, 0.02, 3.0, NEAR),
    (2500.0, 0.5, 0.004, 12.0, [0.003, 0.0041, 0.001, -0.0023, -0.0025, 0.0039, 0.0039, 0.0042, -0.0023, -0.003]),
    (40.0, 1.0, 0.0, 0.7, [0.001, -0.017, -0.018, 0.0, 0.002, -0.01]),
    (40.0, 4.0, 0.05, 0.0, [0.049, 0.06, 0.01, -0.001, 0.05, 0.051]),
]


def loop(stiffness, area, overclosure_max, tension_max, path):
    """The state table for one point: rows (status, pressure, overclosure)."""
    found, closed = [], False
    for at in path:
        # No tolerance in the increment of a change: a point that closes must push, one that opens must be apart.
        if not closed and at > overclosure_max:
            closed = stiffness * at / area > 0.0
        elif closed and stiffness * at / area < -tension_max:
            closed = at > 0.0
        found.append(("CL", stiffness * at / area, 0.0) if closed else ("OP", 0.0, at))
    return found


def modified(points, overclosure, tension):
    """Controls of modified hard contact."""
    return controls(f"MAXCHP={points}", f"UERRMX={overclosure!r}", f"PERRMX={tension!r}")


def check(found, expected):
    """Statuses, pressures and overclosures of one point, to 1e-12."""
    assert len(found) == len(expected)
    for number, (row, wanted) in enumerate(zip(found, expected, strict=True), 1):
        status, pressure, overclosure = wanted
        assert row.status == status, (number, row, wanted)
        assert row.pressure == pytest.approx(pressure, abs=1e-12), (number, row, wanted)
        assert row.overclosure == pytest.approx(overclosure, abs=1e-12), (number, row, wanted)


def solve(write_deck, tmp_path, text, name="deck.inp"):
    """Points by increment; a tolerated violation is no finding of the audit."""
    result = support.run(write_deck(text, name), tmp_path / f"out_{name}")
    assert result.summary()["audit"] == []
    return rows(result)


def driven(path, stiffness, area, card, one_step):
    """A point on a spring whose far end follows a path, an increment per value: in one step by an amplitude, or a step each."""
    if one_step:
        move = ["*BOUNDARY, AMPLITUDE=PATH", f"{driver()}, 3, 3, -1."]
        steps = step(card, *move, increments=len(path), period=float(len(path)))
        model = amplitude("PATH", [0.0, *path], float(len(path)))
    else:
        steps, model = [], []
        for at in path:
            steps += step(card, "*BOUNDARY", f"{driver()}, 3, 3, {-at!r}")
    return deck([Point(driver=stiffness)], HARD, steps, area=area, model=model)


@pytest.mark.parametrize("one_step", [True, False])
def test_b17_the_published_loop(write_deck, tmp_path, one_step):
    text = driven(U_PATH[1:], 100.0, 2.0, modified(1, 0.02, 3.0), one_step)
    found = [row for (row,) in solve(write_deck, tmp_path, text)]
    kept = [(row, wanted) for row, wanted in zip(found, LOOP[1:], strict=True) if wanted]
    check([row for row, _ in kept], [wanted for _, wanted in kept])
    # At a tie either status is right, with its own balance.
    for index, at in ((2, 0.02), (8, -0.06)):
        row = found[index - 1]
        wanted = ("CL", 100.0 * at / 2.0, 0.0) if row.status == "CL" else ("OP", 0.0, at)
        check([row], [wanted])


@pytest.mark.parametrize("one_step", [True, False])
@pytest.mark.parametrize(("stiffness", "area", "overclosure", "tension", "path"), OTHERS)
def test_b17_loops_of_other_sizes(write_deck, tmp_path, stiffness, area, overclosure, tension, path, one_step):
    text = driven(path, stiffness, area, modified(1, overclosure, tension), one_step)
    found = [row for (row,) in solve(write_deck, tmp_path, text)]
    check(found, loop(stiffness, area, overclosure, tension, path))


def test_b17_a_column_of_four_points_takes_four_violations(write_deck, tmp_path):
    """The published loop with a column (EA/L = 100, area 2) in place of spring and node; three violations are not enough."""
    blocks = {
        "TOP": Block((0.0, 0.0, 0.0), (1.0, 2.0, 1.0), (1, 1, 1), 50.0),
        "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 2.5, 0.0), (1, 1, 1), 1000.0),
    }
    for count in (4, 3):
        lines = [*amplitude("PATH", [0.0, *NEAR[1:]], 12.0), "*BOUNDARY", "BOTTOM_ALL, 1, 3", "TOP_ALL, 1, 2"]
        card = modified(count, 0.02, 3.0).replace("MASTER=WALL, SLAVE=POINTS", "MASTER=BOTTOM_UP, SLAVE=TOP_DOWN")
        lines += step(card, "*BOUNDARY, AMPLITUDE=PATH", "TOP_HIGH, 3, 3, -1.", increments=12, period=12.0)
        text = stack(blocks, HARD, lines).replace("NSET=POINTS", "NSET=TOP_HIGH")
        found = solve(write_deck, tmp_path, text, f"deck{count}.inp")
        expected = loop(100.0, 2.0, 0.02, 3.0, NEAR[1:]) if count == 4 else loop(100.0, 2.0, 0.0, 0.0, NEAR[1:])
        for index in range(4):
            check([increment[index] for increment in found], expected)


def test_b18_a_point_that_closes_must_push_whatever_tension_is_allowed(write_deck, tmp_path):
    """Two points on drivers and a lever: both overlap by more than UERRMX when open; with both closed the second would carry a
    tension of 1, less than PERRMX. In the increment of the change that is not tolerated: the second opens again (rule R1)."""
    text, wanted = lever(uerrmx=0.02, perrmx=3.0)
    found = solve(write_deck, tmp_path, text)
    first, second = found[0]
    assert (first.status, second.status) == ("CL", "OP")
    assert first.pressure == pytest.approx(wanted["pressure"], rel=1e-11)
    assert second.overclosure == pytest.approx(wanted["overclosure"], rel=1e-11)
    assert second.pressure == 0.0 and second.overclosure < 0.0


def lever(uerrmx, perrmx):
    """Spring 100 at both points, 60 between them; pushed so that open both overlap by 0.025 and more, closed the second pulls.

    Closed pressures are the forces f; open overclosures are K^-1 f. With f = (F, -1): h2 = (60 F - 160) / (160^2 - 60^2).
    """
    own, between = 160.0, 60.0
    determinant = own**2 - between**2
    second = -1.0
    first = (0.025 * determinant - own * second) / between
    points = [Point(spring=100.0), Point(spring=100.0)]
    model = springs(300, "SPRING2", [node(0), node(1)], [3, 3], between)
    lines = step(modified(2, uerrmx, perrmx), "*CLOAD", f"{node(0)}, 3, {-first!r}", f"{node(1)}, 3, {-second!r}")
    # With the first closed alone: h2 = -1 / 160, p1 = F - 60 / 160.
    wanted = {"pressure": first + between * second / own, "overclosure": second / own}
    return deck(points, HARD, lines, model=model), wanted


def test_b18_later_increments_use_the_tolerance_again(write_deck, tmp_path):
    """Both points pushed closed; then the second is pulled by 1: tolerated, since its status did not change there."""
    between = 60.0
    model = springs(300, "SPRING2", [node(0), node(1)], [3, 3], between)
    points = [Point(spring=100.0), Point(spring=100.0)]
    card = modified(2, 0.02, 3.0)
    lines = step(card, "*CLOAD", f"{node(0)}, 3, -12.", f"{node(1)}, 3, -9.")
    lines += step("*CLOAD", f"{node(1)}, 3, 1.")
    lines += step("*CLOAD", f"{node(1)}, 3, 3.5")
    found = solve(write_deck, tmp_path, deck(points, HARD, lines, model=model))
    check([p[0] for p in found], [("CL", 12.0, 0.0), ("CL", 12.0, 0.0), ("CL", 12.0 - 60.0 * 3.5 / 160.0, 0.0)])
    check([p[1] for p in found], [("CL", 9.0, 0.0), ("CL", -1.0, 0.0), ("OP", 0.0, -3.5 / 160.0)])


def ceiling_deck(steps):
    """One point above a floor, one below a ceiling of the same surface, each on a spring of 100, coupled by one of 60.

    Overclosures are h1 = -u1 and h2 = +u2, so closing one drives the other one in: the compliance between them is negative.
    """
    lines = ["*HEADING", "floor and ceiling", "*NODE, NSET=NWALL"]
    ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    for first, shift, low in ((1, 0.0, -1.0), (21, 3.0, 0.0)):
        places = [(x + shift, y, z) for z in (low, low + 1.0) for x, y in ring]
        lines += [f"{first + i}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in enumerate(places)]
    lines += ["*NODE, NSET=POINTS", f"{node(0)}, 0., 0., 0.", f"{node(1)}, 3., 0., 0."]
    lines += ["*ELEMENT, TYPE=C3D8, ELSET=EWALL", "1, 1, 2, 3, 4, 5, 6, 7, 8", "2, 21, 22, 23, 24, 25, 26, 27, 28"]
    lines += springs(101, "SPRING1", [node(0)], [3], 100.0) + springs(102, "SPRING1", [node(1)], [3], 100.0)
    lines += springs(103, "SPRING2", [node(0), node(1)], [3, 3], 60.0)
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "1000., 0.3", "*SOLID SECTION, ELSET=EWALL, MATERIAL=STEEL"]
    lines += ["*SURFACE, NAME=WALL, TYPE=ELEMENT", "1, S2", "2, S1", "*SURFACE, NAME=POINTS, TYPE=NODE"]
    lines += [f"{node(0)},", f"{node(1)},", "*SURFACE INTERACTION, NAME=SI", "1.,", *HARD]
    lines += ["*CONTACT PAIR, INTERACTION=SI, TYPE=NODE TO SURFACE, SMALL SLIDING", "POINTS, WALL"]
    return "\n".join([*lines, "*BOUNDARY", "NWALL, 1, 3", "POINTS, 1, 2", *steps]) + "\n"


def test_b19_a_point_that_opens_must_be_apart_whatever_overclosure_is_allowed(write_deck, tmp_path):
    """Both points are closed; then both pull by more than PERRMX. With both open the second overlaps by less than UERRMX: in the
    increment of the change that is not tolerated, and it closes again (rule R2)."""
    own, between = 160.0, 60.0
    # h = (-u1, u2): forces towards the walls g give (with both closed) the pressures g. Open: K of h is [[160, 60], [60, 160]].
    loads = (-10.0, -3.2)
    determinant = own**2 - between**2
    open_second = (own * loads[1] - between * loads[0]) / determinant
    assert 0.0 < open_second < 0.02
    lines = step(modified(2, 0.02, 3.0), "*CLOAD", f"{node(0)}, 3, -5.", f"{node(1)}, 3, 5.")
    lines += step("*CLOAD", f"{node(0)}, 3, {-loads[0]!r}", f"{node(1)}, 3, {loads[1]!r}")
    found = solve(write_deck, tmp_path, ceiling_deck(lines))
    assert [(p.status, pytest.approx(p.pressure, abs=1e-12)) for p in found[0]] == [("CL", 5.0), ("CL", 5.0)]
    first, second = found[1]
    # The first alone is open: h1 = g1 / 160, and the second carries g2 - 60 h1.
    assert (first.status, second.status) == ("OP", "CL")
    assert first.overclosure == pytest.approx(loads[0] / own, rel=1e-12)
    assert second.pressure == pytest.approx(loads[1] - between * loads[0] / own, rel=1e-12)
    assert second.overclosure == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("tension", [3.0, 0.8])
@pytest.mark.parametrize("excess", [0.999, 1.001])
def test_b19_tension_is_carried_up_to_the_limit(write_deck, tmp_path, tension, excess):
    """Closed by 5, then pulled to just below or just above PERRMX on an area of 2."""
    stiffness, area = 100.0, 2.0
    pulled = -tension * excess * area / stiffness
    text = driven([0.1, pulled], stiffness, area, modified(1, 0.0, tension), False)
    found = [row for (row,) in solve(write_deck, tmp_path, text)]
    last = ("CL", -tension * excess, 0.0) if excess < 1.0 else ("OP", 0.0, pulled)
    check(found, [("CL", 5.0, 0.0), last])


VIOLATIONS = [0.005, 0.010, 0.015]


@pytest.mark.parametrize("stiffness", [100.0, 730.0])
@pytest.mark.parametrize(("allowed", "tolerated"), [(3, True), (4, True), (2, False), (1, False), (0, False)])
def test_b20_overclosures_are_tolerated_up_to_their_number(write_deck, tmp_path, allowed, tolerated, stiffness):
    points = [Point(driver=stiffness) for _ in VIOLATIONS]
    moves = [f"{driver(i)}, 3, 3, {-v!r}" for i, v in enumerate(VIOLATIONS)]
    text = deck(points, HARD, step(modified(allowed, 0.02, 0.0), "*BOUNDARY", *moves))
    (found,) = solve(write_deck, tmp_path, text)
    expected = [("OP", 0.0, v) if tolerated else ("CL", stiffness * v, 0.0) for v in VIOLATIONS]
    check(found, expected)


@pytest.mark.parametrize(("allowed", "tolerated"), [(3, True), (2, False), (0, False)])
def test_b20_tensions_are_tolerated_up_to_their_number(write_deck, tmp_path, allowed, tolerated):
    points = [Point(driver=100.0) for _ in VIOLATIONS]
    card = modified(allowed, 0.02, 3.0)
    first = [f"{driver(i)}, 3, 3, -0.1" for i in range(3)]
    second = [f"{driver(i)}, 3, 3, {v!r}" for i, v in enumerate(VIOLATIONS)]
    lines = step(card, "*BOUNDARY", *first) + step("*BOUNDARY", *second)
    found = solve(write_deck, tmp_path, deck(points, HARD, lines))
    check(found[0], [("CL", 10.0, 0.0)] * 3)
    check(found[1], [("CL", -100.0 * v, 0.0) if tolerated else ("OP", 0.0, -v) for v in VIOLATIONS])


def test_b20_overclosures_and_tensions_count_together(write_deck, tmp_path):
    """Two points pull, one overlaps: three violations."""
    points = [Point(driver=100.0) for _ in range(3)]
    for allowed in (3, 2):
        card = modified(allowed, 0.02, 3.0)
        lines = step(card, "*BOUNDARY", f"{driver(0)}, 3, 3, -0.1", f"{driver(1)}, 3, 3, -0.1")
        moves = [f"{driver(0)}, 3, 3, 0.01", f"{driver(1)}, 3, 3, 0.02", f"{driver(2)}, 3, 3, -0.015"]
        found = solve(write_deck, tmp_path, deck(points, HARD, lines + step("*BOUNDARY", *moves)), f"{allowed}.inp")
        if allowed == 3:
            check(found[1], [("CL", -1.0, 0.0), ("CL", -2.0, 0.0), ("OP", 0.0, 0.015)])
        else:
            check(found[1], [("OP", 0.0, -0.01), ("OP", 0.0, -0.02), ("CL", 1.5, 0.0)])


def two_pairs(cards):
    """Three points that overlap by less than UERRMX: two of one pair, one of another."""
    points = [Point(driver=100.0) for _ in VIOLATIONS]
    moves = [f"{driver(i)}, 3, 3, {-v!r}" for i, v in enumerate(VIOLATIONS)]
    model = ["*CONTACT PAIR, INTERACTION=SI, TYPE=NODE TO SURFACE, SMALL SLIDING", "OTHERS, WALL"]
    text = deck(points, HARD, step(*cards, "*BOUNDARY", *moves), model=model)
    both = f"*SURFACE, NAME=POINTS, TYPE=NODE\n{node(0)},\n{node(1)},\n"
    assert f"{both}{node(2)},\n" in text
    return text.replace(f"{both}{node(2)},\n", f"{both}*SURFACE, NAME=OTHERS, TYPE=NODE\n{node(2)},\n")


@pytest.mark.parametrize(
    ("cards", "tolerated"),
    [
        (["*CONTACT CONTROLS, MAXCHP=3, UERRMX=0.02"], (True, True)),
        (["*CONTACT CONTROLS, MAXCHP=2, UERRMX=0.02"], (False, False)),
        (["{POINTS}, MAXCHP=2, UERRMX=0.02", "{OTHERS}, MAXCHP=1, UERRMX=0.02"], (True, True)),
        (["{POINTS}, MAXCHP=1, UERRMX=0.02", "{OTHERS}, MAXCHP=2, UERRMX=0.02"], (False, True)),
        (["{POINTS}, MAXCHP=2, UERRMX=0.02"], (True, False)),
    ],
    ids=["all of the model", "too many in the model", "of each pair", "too many in one", "one pair alone"],
)
def test_b20_violations_count_over_the_pair_or_with_global_controls_over_the_model(
    write_deck, tmp_path, cards, tolerated
):
    names = {name: f"*CONTACT CONTROLS, MASTER=WALL, SLAVE={name}" for name in ("POINTS", "OTHERS")}
    (found,) = solve(write_deck, tmp_path, two_pairs([card.format(**names) for card in cards]))
    granted = [tolerated[0], tolerated[0], tolerated[1]]
    check(found, [("OP", 0.0, v) if g else ("CL", 100.0 * v, 0.0) for v, g in zip(VIOLATIONS, granted, strict=True)])


def test_controls_belong_to_the_step_and_are_reset(write_deck, tmp_path):
    """Tolerated in step 1, still in step 2 (controls stay), not after RESET."""
    lines = step(modified(1, 0.02, 3.0), "*BOUNDARY", f"{driver()}, 3, 3, -0.01")
    lines += step("*BOUNDARY", f"{driver()}, 3, 3, -0.015")
    lines += step("*CONTACT CONTROLS, RESET", "*BOUNDARY", f"{driver()}, 3, 3, -0.012")
    found = [row for (row,) in solve(write_deck, tmp_path, deck([Point(driver=100.0)], HARD, lines))]
    check(found, [("OP", 0.0, 0.01), ("OP", 0.0, 0.015), ("CL", 1.2, 0.0)])


def test_rows_read_a_point():
    """The reader of contact rows turns COPEN into an overclosure."""
    row = {"status": "CL", "CPRESS": "2.5", "COPEN": "-0.25"} | dict.fromkeys(
        ("CSHEAR1", "CSHEAR2", "CSLIP1", "CSLIP2"), ""
    )
    assert point(row).overclosure == 0.25 and point(row).pressure == 2.5 and point(row).shear == (0.0, 0.0)
