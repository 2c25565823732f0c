"""One table read as pressure, force and force per length by the kind of secondary surface (B08)."""

import pytest

import support
from verification.columns import Block, output_of, stack
from verification.points import Point, deck, node, rows, step

TABLE = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR", "0., 0.", "2., 0.01", "10., 0.02", "40., 0.03"]
VALUES = [(0.015, 6.0), (0.005, 1.0), (0.025, 25.0), (0.05, 100.0)]


@pytest.mark.parametrize(("overclosure", "value"), VALUES)
@pytest.mark.parametrize("area", [1.0, 0.25, 3.0])
def test_b08_a_node_based_surface_has_the_area_of_its_interaction(write_deck, tmp_path, overclosure, value, area):
    """The area of *SURFACE INTERACTION; with the default of one the law is a force."""
    lines = step("*BOUNDARY", f"{node()}, 3, 3, {-overclosure!r}")
    text = deck([Point()], TABLE, lines, area=area)
    if area == 1.0:
        text = text.replace("NAME=SI\n1.0,\n", "NAME=SI\n")
    result = support.run(write_deck(text), tmp_path)
    [[point]] = rows(result)
    assert point.pressure == pytest.approx(value, rel=1e-12)
    assert float(result.last("nodes")[0]["RF3"]) == pytest.approx(-area * value, rel=1e-12)


@pytest.mark.parametrize(("overclosure", "value"), VALUES)
def test_b08_an_element_based_surface_has_tributary_areas(write_deck, tmp_path, overclosure, value):
    """One face of area one: 0.25 at each node; all of the block is pushed into the wall."""
    blocks = {
        "TOP": Block((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (1, 1, 1), 500.0),
        "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 1.5, 0.0), (1, 1, 1), 1000.0),
    }
    lines = ["*BOUNDARY", "BOTTOM_ALL, 1, 3", "TOP_ALL, 1, 2", "*STEP", "*STATIC", "1., 1.", "*BOUNDARY"]
    lines += [f"TOP_ALL, 3, 3, {-overclosure!r}", *output_of("TOP_LOW")]
    result = support.run(write_deck(stack(blocks, TABLE, lines)), tmp_path)
    for row in result.last("contact"):
        assert float(row["area"]) == pytest.approx(0.25, rel=1e-12)
        assert float(row["CPRESS"]) == pytest.approx(value, rel=1e-12)
    for row in result.last("nodes"):
        assert float(row["RF3"]) == pytest.approx(-0.25 * value, rel=1e-12)


def truss_deck(overclosure, length):
    """A row of two trusses of a length each above the wall, all nodes prescribed."""
    lines = step("*BOUNDARY", f"POINTS, 3, 3, {-overclosure!r}")
    text = deck([Point(), Point(), Point()], TABLE, lines, face=8.0 * length)
    places = [f"{node(i)}, {length * (i - 1)!r}, 0., 0." for i in range(3)]
    start = text.index("*NODE, NSET=POINTS\n") + len("*NODE, NSET=POINTS\n")
    end = text.index("*", start)
    text = text[:start] + "\n".join(places) + "\n" + text[end:]
    trusses = ["*ELEMENT, TYPE=T3D2, ELSET=ROW", f"301, {node(0)}, {node(1)}", f"302, {node(1)}, {node(2)}"]
    trusses += ["*SOLID SECTION, ELSET=ROW, MATERIAL=STEEL", "0.1,"]
    surface = text.index("*SURFACE, NAME=POINTS, TYPE=NODE")
    behind = text.index("*SURFACE INTERACTION")
    text = text[:surface] + "\n".join([*trusses, "*SURFACE, NAME=POINTS, TYPE=ELEMENT", "ROW,", ""]) + text[behind:]
    return text.replace("NAME=SI\n1.0,\n", "NAME=SI\n")


@pytest.mark.parametrize(("overclosure", "value"), VALUES)
@pytest.mark.parametrize("length", [0.4, 1.5])
def test_b08_a_truss_carries_force_per_length(write_deck, tmp_path, overclosure, value, length):
    """Tributary lengths are half of a truss at the ends of the row, a whole one between."""
    result = support.run(write_deck(truss_deck(overclosure, length)), tmp_path)
    [points] = rows(result)
    assert [p.pressure for p in points] == pytest.approx([value] * 3, rel=1e-12)
    forces = [float(row["RF3"]) for row in sorted(result.last("nodes"), key=lambda r: int(r["node"]))]
    assert forces == pytest.approx([-value * length * part for part in (0.5, 1.0, 0.5)], rel=1e-12)
