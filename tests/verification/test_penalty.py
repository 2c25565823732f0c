"""Penalty enforcement (A13): the linear and the nonlinear curve, their defaults and their clearance."""

import pytest

import support
from verification.columns import Block, output_of, stack
from verification.points import Point, controls, deck, driver, node, rows, step

FACE = 2.0


def curve(h, initial, last, lower, upper, clearance):
    """Pressure of the nonlinear penalty."""
    x = h + clearance
    if x <= 0.0:
        return 0.0
    if x <= lower:
        return initial * x
    if x <= upper:
        return initial * x + (last - initial) * (x - lower) ** 2 / (2.0 * (upper - lower))
    return initial * x + (last - initial) * (0.5 * (upper - lower) + x - upper)


def nonlinear(last, clearance, scale, upper, ratio, lower):
    """Data line: final stiffness, clearance at zero pressure, scale factor, e / face, Ki / Kf, d / e."""
    return ["*SURFACE BEHAVIOR, PENALTY=NONLINEAR", ", ".join(map(repr, (last, clearance, scale, upper, ratio, lower)))]


PUBLISHED = ([-0.001, 0.005, 0.01, 0.02, 0.03, 0.05], [0.0, 0.5, 1.0, 26.75, 102.0, 302.0])
# Kf, c0, scale, e / face, Ki / Kf, d / e. The first is the published curve: Ki 100, Kf 10000, d 0.01, e 0.03.
CURVES = [
    (1.0e4, 0.0, 1.0, 0.015, 0.01, 1.0 / 3.0),
    (5.0e3, 0.004, 2.0, 0.02, 0.1, 0.5),
    (800.0, 0.0, 0.5, 0.03, 0.01, 1.0 / 3.0),
]


@pytest.mark.parametrize("data", CURVES)
def test_a13_the_nonlinear_curve_has_its_values(write_deck, tmp_path, data):
    """A prescribed node in front of a wall of the published face length: pressures at given overclosures."""
    last, clearance, scale, upper, ratio, lower = data
    e = upper * FACE
    if data == CURVES[0]:
        for h, pressure in zip(*PUBLISHED, strict=True):
            assert curve(h, 100.0, 1e4, 0.01, 0.03, 0.0) == pytest.approx(pressure, rel=1e-12)
    before, lines = 0.0, []
    overclosures = [-0.3 * e, 0.1 * e, lower * e, 0.6 * e, e, 1.7 * e, 0.4 * e]
    for h in overclosures:
        lines += step("*BOUNDARY", f"{node()}, 3, 3, {-h!r}")
        before = h
    assert before == overclosures[-1]
    found = rows(support.run(write_deck(deck([Point()], nonlinear(*data), lines, face=FACE)), tmp_path))
    for h, (point,) in zip(overclosures, found, strict=True):
        expected = curve(h, scale * ratio * last, scale * last, lower * e, e, clearance)
        assert point.pressure == pytest.approx(expected, rel=1e-11, abs=1e-13 * last * e), h
        assert point.overclosure == pytest.approx(h, rel=1e-13)
        assert point.status == ("CL" if expected > 0.0 else "OP")


@pytest.mark.parametrize("data", CURVES)
@pytest.mark.parametrize("push", [0.3, 1.0, 3.0])
def test_a13_a_spring_balances_the_nonlinear_penalty(write_deck, tmp_path, data, push):
    last, clearance, scale, upper, ratio, lower = data
    e, spring, area = upper * FACE, 0.4 * last, 1.7
    lines = step("*BOUNDARY", f"{driver()}, 3, 3, {-push * e!r}", increments=2)
    text = deck([Point(driver=spring)], nonlinear(*data), lines, face=FACE, area=area)
    result = support.run(write_deck(text), tmp_path)
    point = rows(result)[-1][0]
    low, high = -1.0, push * e
    while (middle := 0.5 * (low + high)) not in (low, high):
        pressure = curve(middle, scale * ratio * last, scale * last, lower * e, e, clearance)
        low, high = (middle, high) if spring * (push * e - middle) > area * pressure else (low, middle)
    assert point.overclosure == pytest.approx(low, rel=1e-11, abs=1e-14 * e)
    assert point.pressure == pytest.approx(spring * (push * e - low) / area, rel=1e-11)
    assert result.summary()["steps"][0]["augmentations"] == 0
    assert result.summary()["audit"] == []


@pytest.mark.parametrize("keyword", ["PENALTY", "PENALTY=LINEAR"])
@pytest.mark.parametrize(
    ("stiffness", "clearance", "scale", "by_step"), [(3000.0, 0.0, 1.0, 1.0), (500.0, 0.002, 4.0, 0.5)]
)
def test_a_linear_penalty_is_a_spring(write_deck, tmp_path, keyword, stiffness, clearance, scale, by_step):
    """`p = k (h + c0)` with the stiffness times both factors; no augmentation."""
    spring, force, area = 1000.0, 12.0, 1.5
    behavior = [f"*SURFACE BEHAVIOR, {keyword}", f"{stiffness!r}, {clearance!r}, {scale!r}"]
    lines = step(controls(f"STIFFNESS SCALE FACTOR={by_step!r}"), "*CLOAD", f"{node()}, 3, {-force!r}", increments=2)
    result = support.run(write_deck(deck([Point(spring=spring)], behavior, lines, area=area)), tmp_path)
    point = rows(result)[-1][0]
    own = area * stiffness * scale * by_step
    overclosure = (force - own * clearance) / (spring + own)
    assert point.overclosure == pytest.approx(overclosure, rel=1e-12)
    assert point.pressure == pytest.approx(own / area * (overclosure + clearance), rel=1e-12)
    assert result.summary()["steps"][0]["augmentations"] == 0


# Factor on the stiffness of the underlying elements; initial one of the nonlinear penalty is a hundredth of its last.
AUTOMATIC = {
    "AUGMENTED LAGRANGE": 1000.0,
    "PENALTY": 10.0,
    "PENALTY=LINEAR": 10.0,
    "PENALTY=NONLINEAR": 1.0,
}


@pytest.mark.parametrize("enforcement", AUTOMATIC)
@pytest.mark.parametrize(("layers", "poisson"), [((1, 1), (0.0, 0.0)), ((3, 2), (0.3, 0.1))])
def test_an_automatic_penalty_follows_the_elements_underneath(write_deck, tmp_path, enforcement, layers, poisson):
    """`k = factor / (L / M + L' / M')` with the depths and confined moduli of the elements on both sides, under a dead pressure."""
    moduli = (700.0, 1900.0)
    blocks = {
        "TOP": Block((0.0, 0.0, 0.0), (1.0, 2.0, 1.2), (2, 2, layers[0]), moduli[0]),
        "BOTTOM": Block((-0.5, -0.5, -0.8), (1.5, 2.5, 0.0), (1, 1, layers[1]), moduli[1]),
    }
    pressure, pair = 0.01, "*CONTACT CONTROLS, MASTER=BOTTOM_UP, SLAVE=TOP_DOWN"
    lines = ["*BOUNDARY", "BOTTOM_ALL, 1, 3", "TOP_ALL, 1, 2", "*STEP", "*STATIC, DIRECT", "1., 1."]
    lines += [
        f"{pair}, ABSOLUTE PENETRATION TOLERANCE=1., STIFFNESS SCALE FACTOR=0.5",
        "*DSLOAD",
        f"TOP_UP, P, {pressure!r}",
    ]
    text = stack(blocks, [f"*SURFACE BEHAVIOR, {enforcement}"], [*lines, *output_of("TOP_ALL")])
    for modulus, nu in zip(moduli, poisson, strict=True):
        assert text.count(f"{modulus!r}, 0.\n") == 1
        text = text.replace(f"{modulus!r}, 0.\n", f"{modulus!r}, {nu!r}\n")
    confined = [e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) for e, nu in zip(moduli, poisson, strict=True)]
    depths = [1.2 / layers[0], 0.8 / layers[1]]
    stiffness = 0.5 * AUTOMATIC[enforcement] / sum(d / m for d, m in zip(depths, confined, strict=True))
    result = support.run(write_deck(text), tmp_path)
    points = rows(result)[-1]
    assert len(points) == 9
    for point in points:
        assert point.pressure == pytest.approx(pressure, rel=1e-11)
        assert point.overclosure == pytest.approx(pressure / stiffness, rel=1e-10)
