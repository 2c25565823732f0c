"""Shrink fits (B12): pressure `delta / (C_rings + 1/k)`, with Lame's rings and with columns."""

import pytest

import support
from verification import rings
from verification.columns import Block, output_of, stack
from verification.points import rows

FITS = [
    rings.Rings(10.0, 20.0, 40.0, 0.002, (1000.0, 0.3), (1000.0, 0.3)),
    rings.Rings(5.0, 15.0, 21.0, 0.001, (2.1e5, 0.28), (7.0e4, 0.33)),
]


def linear(stiffness):
    """Lines of the interaction."""
    return ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", repr(stiffness)]


HARD = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]


def fit(write_deck, tmp_path, number, ring, behavior, divisions):
    """Pressure of the fit, the same at its four points to rounding."""
    result = support.run(write_deck(rings.deck(ring, behavior, divisions), f"{number}.inp"), tmp_path / str(number))
    assert result.summary()["audit"] == []
    [*_, points] = rows(result)
    pressures = [p.pressure for p in points]
    assert len(pressures) == 4 and max(pressures) - min(pressures) <= 1e-9 * max(pressures)
    return pressures[0]


@pytest.mark.parametrize("ring", FITS)
def test_b12_lames_rings_with_a_compliant_interface(write_deck, tmp_path, ring):
    """Errors fall with the square of the element size, to 2e-4 at 48 elements through each ring."""
    compliance = ring.compliance()
    for index, ratio in enumerate((0.2, 1.0, 5.0)):
        stiffness = 1.0 / (ratio * compliance)
        expected = ring.overlap / (compliance + 1.0 / stiffness)
        errors = []
        for divisions in (12, 48):
            found = fit(write_deck, tmp_path, f"{index}_{divisions}", ring, linear(stiffness), divisions)
            errors.append(abs(found / expected - 1.0))
        assert errors[1] < 2e-4
        assert errors[1] < max(0.15 * errors[0], 1e-4)


@pytest.mark.parametrize("ring", FITS)
def test_b12_the_interface_adds_its_compliance_to_that_of_the_rings(write_deck, tmp_path, ring):
    """On one mesh `delta / p - delta / p_hard = 1 / k` holds to rounding, whatever the mesh."""
    hard = fit(write_deck, tmp_path, "hard", ring, HARD, 12)
    assert ring.overlap / hard == pytest.approx(ring.compliance(), rel=2e-3)
    for number, stiffness in enumerate((0.3 / ring.compliance(), 4.0 / ring.compliance())):
        soft = fit(write_deck, tmp_path, number, ring, linear(stiffness), 12)
        overlap = ring.overlap_along_the_facet()
        assert overlap / soft - overlap / hard == pytest.approx(1.0 / stiffness, rel=1e-9)


COLUMNS = [(0.02, 300.0, 80.0, 500.0), (0.003, 2000.0, 9000.0, 1.0e5)]


@pytest.mark.parametrize(("overlap", "above", "below", "stiffness"), COLUMNS)
def test_b12_columns_that_overlap_between_their_supports(write_deck, tmp_path, overlap, above, below, stiffness):
    """The same in one dimension, exactly: compliances 1/E of columns of length one (lengths enter with the overlap)."""
    blocks = {
        "TOP": Block((0.0, 0.0, -overlap), (1.0, 1.0, 1.0), (2, 2, 2), above),
        "BOTTOM": Block((0.0, 0.0, -1.0), (1.0, 1.0, 0.0), (2, 2, 2), below),
    }
    lines = ["*BOUNDARY", "BOTTOM_LOW, 1, 3", "TOP_HIGH, 1, 3", "*STEP", "*STATIC", "1., 1.", *output_of("TOP_ALL")]
    for number, (behavior, own) in enumerate(((linear(stiffness), 1.0 / stiffness), (HARD, 0.0))):
        result = support.run(write_deck(stack(blocks, behavior, lines), f"{number}.inp"), tmp_path / str(number))
        expected = overlap / ((1.0 + overlap) / above + 1.0 / below + own)
        for point in rows(result)[-1]:
            assert point.pressure == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("ring", FITS[:1])
def test_b12_shrink_brings_the_rings_together_over_the_step(write_deck, tmp_path, ring):
    """`*CONTACT INTERFERENCE, SHRINK` in five increments: a fifth of the pressure more in each."""
    stiffness = 2.0 / ring.compliance()
    at_once = fit(write_deck, tmp_path, "once", ring, linear(stiffness), 12)
    step = ("*STATIC, DIRECT", "0.2, 1.", "*CONTACT INTERFERENCE, SHRINK", "SHAFT, HUB")
    result = support.run(write_deck(rings.deck(ring, linear(stiffness), 12, step=step)), tmp_path)
    found = [points[0].pressure for points in rows(result)]
    assert found == pytest.approx([at_once * i / 5 for i in range(1, 6)], rel=1e-9)
