"""Rigid bodies on contact (B01 as its case has it): sunk evenly, and tilted by a load beside the middle."""

import numpy as np
import pytest

import support
from verification.catalogue import reference
from verification.columns import LAWS, Block, stack
from verification.points import rows

REFERENCE = 999
BLOCKS = {
    "TOP": Block((0.0, 0.0, 0.0), (1.0, 2.0, 1.0), (2, 2, 1), 700.0),
    "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 2.5, 0.0), (1, 1, 1), 1000.0),
}
MIDDLE = np.array([0.5, 1.0])


def deck(law, load):
    """The block as a rigid body whose reference node, above the middle, carries forces and moments; directions 1, 2, 6 are held."""
    lines = ["*NODE, NSET=REFERENCE", f"{REFERENCE}, 0.5, 1., 3.", f"*RIGID BODY, REF NODE={REFERENCE}, ELSET=ETOP"]
    lines += ["*BOUNDARY", "BOTTOM_ALL, 1, 3", f"{REFERENCE}, 1, 2", f"{REFERENCE}, 6, 6"]
    lines += ["*STEP", "*STATIC", "0.5, 1.", "*CLOAD", *(f"{REFERENCE}, {d}, {f!r}" for d, f in load.items())]
    lines += ["*NODE PRINT, NSET=REFERENCE", "U, RF", "*NODE PRINT, NSET=TOP_ALL", "U", "*CONTACT PRINT", "CSTR, CDIS"]
    return stack(BLOCKS, law, [*lines, "*END STEP"])


@pytest.mark.parametrize("law", LAWS)
def test_b01_a_rigid_block_sinks_to_the_overclosure_of_its_load(write_deck, tmp_path, law):
    case = reference("B01")
    expected = case["expected"]
    text = deck(LAWS[law], {3: -case["inputs"]["F"]})
    result = support.run(write_deck(text), tmp_path)
    assert result.summary()["audit"] == []
    points = rows(result)[-1]
    assert len(points) == 9
    for point in points:
        assert point.overclosure == pytest.approx(expected[f"h_{law}"], rel=1e-10, abs=1e-12)
        assert point.pressure == pytest.approx(expected["CPRESS"], rel=1e-10)
    for row in result.last("nodes"):
        assert float(row["U3"]) == pytest.approx(-expected[f"h_{law}"], rel=1e-10, abs=1e-12)


@pytest.mark.parametrize("moments", [(0.0, 2.0), (3.0, 0.0), (-2.5, 1.5)])
@pytest.mark.parametrize("stiffness", [250.0, 8.0e4])
def test_a_rigid_block_tilts_on_linear_contact(write_deck, tmp_path, stiffness, moments):
    """`h = h0 + t1 y - t2 x` about the middle: forces and moments of the tributary areas balance the load."""
    force = 30.0
    law = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", repr(stiffness)]
    text = deck(law, {3: -force, 4: moments[0], 5: moments[1]})
    result = support.run(write_deck(text), tmp_path)
    assert result.summary()["audit"] == []
    table = result.last("contact")
    places, areas = {}, {}
    for line in text.splitlines():
        words = line.split(",")
        if len(words) == 4 and words[0].isdigit():
            places[int(words[0])] = np.array([float(words[1]), float(words[2])]) - MIDDLE
    for row in table:
        areas[int(row["node"])] = float(row["area"])
    assert sum(areas.values()) == pytest.approx(2.0, rel=1e-12)
    # Rows: force along 3, moments about 1 and 2. A rotation (t1, t2) lifts a point at (x, y) by t1 y - t2 x.
    modes = np.array([[1.0, -places[n][1], places[n][0]] for n in areas])
    matrix = modes.T @ (stiffness * np.array(list(areas.values()))[:, None] * modes)
    sinking, first, second = np.linalg.solve(matrix, [force, moments[0], moments[1]])
    expected = modes @ [sinking, first, second]
    assert expected.min() > 0.0
    found = {int(row["node"]): -float(row["COPEN"]) for row in table}
    assert [found[n] for n in areas] == pytest.approx(list(expected), rel=1e-9)
    (reference_row,) = [row for row in result.last("nodes") if int(row["node"]) == REFERENCE]
    assert float(reference_row["U3"]) == pytest.approx(-sinking, rel=1e-9)
