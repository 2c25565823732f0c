"""Patch tests on matching meshes (B05): every law and every enforcement transmits a uniform pressure uniformly."""

import pytest

import support
from verification.columns import LAWS, Block, output_of, stack
from verification.points import rows

ENFORCEMENTS = {
    **LAWS,
    "augmented": ["*SURFACE BEHAVIOR, AUGMENTED LAGRANGE"],
    "augmented-given": ["*SURFACE BEHAVIOR, AUGMENTED LAGRANGE", "900., 0.001"],
    "penalty": ["*SURFACE BEHAVIOR, PENALTY"],
    "penalty-given": ["*SURFACE BEHAVIOR, PENALTY=LINEAR", "700., 0.002, 1.5"],
    "nonlinear": ["*SURFACE BEHAVIOR, PENALTY=NONLINEAR"],
    "nonlinear-given": ["*SURFACE BEHAVIOR, PENALTY=NONLINEAR", "4000., 0., 1., 0.05, 0.02, 0.25"],
    "no-separation": ["*SURFACE BEHAVIOR, NO SEPARATION"],
    "rough": ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD", "*FRICTION, ROUGH"],
    "bonded": ["*SURFACE BEHAVIOR, NO SEPARATION", "*FRICTION, ROUGH"],
    "damped": [*LAWS["hard"], "*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", "0.5, 0.1, 0.3"],
    "damped-linear": [*LAWS["linear"], "*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", "0.5, 0.1, 0.3"],
    "rough-linear": [*LAWS["linear"], "*FRICTION, ROUGH"],
    "rough-augmented": ["*SURFACE BEHAVIOR, AUGMENTED LAGRANGE", "900.,", "*FRICTION, ROUGH"],
}
PRESSURE = 1.5
# Compressed blocks of two materials; without lateral strain sides stay free.
BLOCKS = {
    "TOP": Block((0.0, 0.0, 2.0), (2.0, 1.0, 3.5), (3, 2, 2), 200.0),
    "BOTTOM": Block((0.0, 0.0, 0.0), (2.0, 1.0, 2.0), (3, 2, 1), 50.0),
}
SUPPORTS = ["*BOUNDARY", "BOTTOM_LOW, 3, 3", *(f"{n}_{s}, {d}, {d}" for n in BLOCKS for s, d in (("X", 1), ("Y", 2)))]


def steps(loads, card=()):
    """A step in four increments per load."""
    lines = []
    for load in loads:
        lines += ["*STEP", "*STATIC, DIRECT", "0.25, 1.", *card, *load, *output_of("TOP_HIGH", "BOTTOM_LOW")]
    return lines


@pytest.mark.parametrize("name", ENFORCEMENTS)
@pytest.mark.parametrize("driven", [False, True], ids=["dead pressure", "displacement"])
def test_b05_matching_meshes_transmit_a_uniform_pressure(write_deck, tmp_path, name, driven):
    """Uniform CPRESS and COPEN to 1e-9; under a dead pressure also the pressure itself."""
    load = ["*BOUNDARY", "TOP_HIGH, 3, 3, -0.08"] if driven else ["*DSLOAD", f"TOP_UP, P, {PRESSURE!r}"]
    result = support.run(write_deck(stack(BLOCKS, ENFORCEMENTS[name], [*SUPPORTS, *steps([load])])), tmp_path)
    assert result.summary()["audit"] == []
    increments, history = rows(result), result.table("history")
    assert len(increments) == len(history) == 4
    for number, (points, row) in enumerate(zip(increments, history, strict=True), 1):
        force = float(row["RF3[BOTTOM_LOW]"])
        # The viscous part of a damped law is in the force, not in the pressure of a closed point.
        expected = force / 2.0 if "damped" not in name else points[0].pressure
        if not driven:
            assert force == pytest.approx(2.0 * PRESSURE * number / 4, rel=1e-10)
        assert len(points) == 12 and points[0].pressure > 0.0
        for point in points:
            assert point.pressure == pytest.approx(expected, rel=1e-9)
            assert point.overclosure == pytest.approx(points[0].overclosure, abs=1e-9 * 0.08)
            assert point.shear == pytest.approx((0.0, 0.0), abs=1e-9 * PRESSURE)
            assert point.status == ("ST" if "rough" in name or name == "bonded" else "CL")


@pytest.mark.parametrize("name", ["no-separation", "bonded"])
def test_b05_a_latched_interface_transmits_a_uniform_tension(write_deck, tmp_path, name):
    loads = [["*DSLOAD", f"TOP_UP, P, {p!r}"] for p in (PRESSURE, -2.0 * PRESSURE)]
    result = support.run(write_deck(stack(BLOCKS, ENFORCEMENTS[name], [*SUPPORTS, *steps(loads)])), tmp_path)
    assert result.summary()["audit"] == []
    for point in rows(result)[-1]:
        assert point.pressure == pytest.approx(-2.0 * PRESSURE, rel=1e-9)
        assert point.overclosure == pytest.approx(0.0, abs=1e-11)


@pytest.mark.parametrize("shear", [0.7, -2.0])
def test_b05_a_rough_interface_transmits_a_uniform_shear(write_deck, tmp_path, shear):
    """Simple shear: motion along 3 is prescribed everywhere, the upper block overlaps the lower one by 0.01 and its top slides by
    `tau (l / G + L / G')`; the sides carry what they must as reactions."""
    slide = shear * sum(2.0 * (b.high[2] - b.low[2]) / b.young for b in BLOCKS.values())
    lines = ["*BOUNDARY", "BOTTOM_ALL, 2, 3", "BOTTOM_LOW, 1, 1", "TOP_ALL, 2, 2"]
    lines += ["*STEP", "*STATIC", "1., 1.", "*BOUNDARY", "TOP_ALL, 3, 3, -0.01", "TOP_HIGH, 1, 1, 0."]
    lines += output_of("TOP_HIGH", "BOTTOM_LOW")
    lines += [
        "*STEP",
        "*STATIC",
        "1., 1.",
        "*BOUNDARY",
        f"TOP_HIGH, 1, 1, {slide!r}",
        *output_of("TOP_HIGH", "BOTTOM_LOW"),
    ]
    result = support.run(write_deck(stack(BLOCKS, ENFORCEMENTS["rough-linear"], lines)), tmp_path)
    assert result.summary()["audit"] == []
    closed, sheared = rows(result)[0], rows(result)[-1]
    for before, point in zip(closed, sheared, strict=True):
        assert before.shear == pytest.approx((0.0, 0.0), abs=1e-12)
        assert point.pressure == pytest.approx(250.0 * 0.01, rel=1e-9)
        assert point.shear == pytest.approx((shear, 0.0), abs=1e-9 * abs(shear))
        assert point.slip == pytest.approx((0.0, 0.0), abs=1e-12)
        assert (before.status, point.status) == ("ST", "ST")
    assert float(result.last("history")[0]["RF1[TOP_HIGH]"]) == pytest.approx(2.0 * shear, rel=1e-9)
