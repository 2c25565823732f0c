"""Laws through `overclosure law`: the inverse (A07), penalties that stand in for hard contact (A13), contact damping (A14)."""

import csv
import io
from decimal import Decimal, getcontext
from fractions import Fraction

import pytest

import support


def rows(kind, parameters, option, values):
    """Rows of `overclosure law` as numbers."""
    words = [word for name, value in parameters.items() for word in ("--param", f"{name}={value!r}")]
    done = support.call("law", kind, *words, f"--{option}=" + ",".join(repr(float(v)) for v in values))
    assert done.returncode == 0, done.stderr
    return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(io.StringIO(done.stdout))]


def exact_overclosure(pressure, clearance, pressure_at_touch, straight_from=Decimal(7)):
    """Overclosure of the exponential law at a pressure to 40 digits: bisection on u (e^u - 1), and its tangent beyond."""
    getcontext().prec = 50
    c, p = Decimal(clearance), Decimal(pressure)
    scale = Decimal(pressure_at_touch) / (Decimal(1).exp() - 1)
    top = straight_from.exp()
    if p > scale * straight_from * (top - 1):
        slope = scale / c * ((straight_from + 1) * top - 1)
        return c * (straight_from - 1) + (p - scale * straight_from * (top - 1)) / slope
    low, high = Decimal(0), straight_from
    for _ in range(170):
        middle = (low + high) / 2
        low, high = (middle, high) if scale * middle * (middle.exp() - 1) < p else (low, middle)
    return c * low - c


@pytest.mark.parametrize(("clearance", "at_touch"), [(0.01, 5.0), (1.0, 1.0), (1e-4, 1e6), (37.5, 0.02)])
def test_a07_the_inverse_of_the_exponential_law(clearance, at_touch):
    """Overclosure at a pressure, from a millionth of p0 to beyond the straight continuation."""
    parts = [1e-6, 1e-3, 0.1, 0.5, 0.999, 1.0, 1.7182818, 1.7182819, 3.0, 50.0, 4000.0, 4463.0, 4464.0, 1e6]
    pressures = [part * at_touch for part in parts]
    found = rows("exponential", {"c0": clearance, "p0": at_touch}, "at-pressure", pressures)
    for pressure, row in zip(pressures, found, strict=True):
        expected = float(exact_overclosure(pressure, clearance, at_touch))
        # Near the onset h = c0 (u - 1) loses digits of u, so the clearance is the scale.
        assert row["overclosure"] == pytest.approx(expected, rel=1e-12, abs=1e-14 * clearance), pressure
        assert row["pressure"] == pytest.approx(pressure, rel=1e-9 if pressure < 1e-2 * at_touch else 1e-12)


def test_a07_the_inverse_of_every_law_gives_the_pressure_back():
    laws = {
        "linear": {"stiffness": 250.0},
        "exponential": {"c0": 0.01, "p0": 5.0, "kmax": 500.0},
        "penalty": {"stiffness": 250.0, "c0": 0.003},
        "nonlinear-penalty": {"ki": 100.0, "kf": 1e4, "d": 0.01, "e": 0.03},
        "augmented-lagrange": {"stiffness": 250.0, "multiplier": 3.0},
    }
    pressures = [0.01, 0.7, 1.0, 4.0, 26.75, 102.0, 500.0]
    for kind, parameters in laws.items():
        for pressure, row in zip(pressures, rows(kind, parameters, "at-pressure", pressures), strict=True):
            assert row["pressure"] == pytest.approx(pressure, rel=1e-12), (kind, row)


def test_a07_a_law_without_pressure_is_at_its_onset():
    (row,) = rows("exponential", {"c0": 0.01, "p0": 5.0}, "at-pressure", [0.0])
    assert row == {"overclosure": -0.01, "pressure": 0.0, "stiffness": 0.0, "energy": 0.0}


def nonlinear(x, initial, final, lower, upper):
    """Pressure, slope and energy of the nonlinear penalty by exact fractions."""
    x, initial, final, lower, upper = map(Fraction, (x, initial, final, lower, upper))
    if x <= 0:
        return 0, 0, 0
    first = min(x, lower)
    energy = initial * first**2 / 2
    if x <= lower:
        return float(initial * x), float(initial), float(energy)
    curved = min(x, upper) - lower
    rate = (final - initial) / (upper - lower)
    pressure = initial * (lower + curved) + rate * curved**2 / 2
    energy = initial * (lower + curved) ** 2 / 2 + rate * curved**3 / 6
    slope = initial + rate * curved
    if x > upper:
        beyond = x - upper
        energy += pressure * beyond + final * beyond**2 / 2
        pressure += final * beyond
        slope = final
    return float(pressure), float(slope), float(energy)


def test_a13_the_nonlinear_penalty_has_its_values():
    parameters = {"ki": 100.0, "kf": 10000.0, "d": 0.01, "e": 0.03, "c0": 0.0}
    expected = {
        -0.001: (0.0, 0.0),
        0.005: (0.5, 100.0),
        0.01: (1.0, 100.0),
        0.02: (26.75, 5050.0),
        0.03: (102.0, 10000.0),
        0.05: (302.0, 10000.0),
    }
    for row in rows("nonlinear-penalty", parameters, "at", expected):
        found = (row["pressure"], row["stiffness"])
        assert found == pytest.approx(expected[row["overclosure"]], rel=1e-12)


@pytest.mark.parametrize(
    ("initial", "final", "lower", "upper", "clearance"),
    [
        (100.0, 1e4, 0.01, 0.03, 0.0),
        (3.0, 7.0, 0.0, 2.0, 0.25),
        (2e6, 2e8, 1e-5, 3e-5, 1e-6),
        (5.0, 5.0, 0.1, 0.2, 0.0),
    ],
)
def test_a13_the_nonlinear_penalty_elsewhere(initial, final, lower, upper, clearance):
    overclosures = [part * upper - clearance for part in (-0.5, 0.0, 0.05, 0.3, 0.34, 0.6, 0.99, 1.01, 3.0)]
    parameters = {"ki": initial, "kf": final, "d": lower, "e": upper, "c0": clearance}
    for h, row in zip(overclosures, rows("nonlinear-penalty", parameters, "at", overclosures), strict=True):
        expected = nonlinear(Fraction(h) + Fraction(clearance), initial, final, lower, upper)
        found = (row["pressure"], row["stiffness"], row["energy"])
        assert found == pytest.approx(expected, rel=1e-11, abs=1e-12 * initial * upper * min(1.0, upper)), h


def test_the_straight_penalty_and_its_multiplier():
    overclosures = [-0.01, -0.004, -0.002, 0.0, 0.03]
    for row in rows("penalty", {"stiffness": 3000.0, "clearance": 0.002}, "at", overclosures):
        assert row["pressure"] == pytest.approx(max(0.0, 3000 * (row["overclosure"] + 0.002)), rel=1e-12, abs=1e-12)
    for row in rows("augmented-lagrange", {"k": 3000.0, "lambda": 9.0, "c0": 0.001}, "at", overclosures):
        expected = max(0.0, 9 + 3000 * (row["overclosure"] + 0.001))
        assert row["pressure"] == pytest.approx(expected, rel=1e-12, abs=1e-11)
        assert row["energy"] == pytest.approx(expected**2 / 6000, rel=1e-11, abs=1e-14)


def test_a14_the_damping_coefficient_over_the_clearance():
    expected = {
        -0.01: 8.0,
        0.0: 8.0,
        0.02: 8.0,
        0.04: 8.0,
        0.06: 16 / 3,
        0.08: 8 / 3,
        0.1: 0.0,
        0.2: 0.0,
    }
    parameters = {"coefficient": 8.0, "clearance": 0.1, "fraction": 0.4}
    found = rows("damping", parameters, "at", [-c for c in expected])
    assert set(found[0]) == {"overclosure", "coefficient", "slope"}
    for row, coefficient in zip(found, expected.values(), strict=True):
        assert row["coefficient"] == pytest.approx(coefficient, rel=1e-13, abs=8e-13)


@pytest.mark.parametrize(("mu0", "c0", "eta"), [(8.0, 0.1, 0.4), (1.5, 2.0, 0.0), (300.0, 1e-3, 0.9)])
def test_a14_the_slope_is_that_of_the_ramp(mu0, c0, eta):
    parts = [-1.0, 0.0, 0.5 * eta, eta + 0.25 * (1 - eta), eta + 0.75 * (1 - eta), 1.01, 5.0]
    found = rows("damping", {"mu0": mu0, "c0": c0, "eta": eta}, "at", [-part * c0 for part in parts])
    for part, row in zip(parts, found, strict=True):
        on_ramp = eta < part < 1
        ratio = Fraction(part) if on_ramp else None
        expected = mu0 * float((1 - ratio) / (1 - Fraction(eta))) if on_ramp else (mu0 if part <= eta else 0.0)
        assert row["coefficient"] == pytest.approx(expected, rel=1e-12)
        assert row["slope"] == pytest.approx(mu0 / (c0 * (1 - eta)) if on_ramp else 0.0, rel=1e-12)


@pytest.mark.parametrize(
    ("kind", "parameters", "words"),
    [
        ("hard", [], ["constraint", "penalty"]),
        ("modified-hard", [], ["status before", "UERRMX"]),
        ("no-separation", [], ["separation=prevented"]),
        ("penalty", ["stiffness=0", "c0=-1"], ["stiffness", "clearance_at_zero_pressure"]),
        ("nonlinear-penalty", ["ki=2", "kf=1", "d=3", "e=2"], ["stiffness_final", "upper"]),
        ("augmented-lagrange", ["k=1", "lambda=-1"], ["multiplier", "separation=prevented"]),
        ("augmented-lagrange", ["k=1", "lambda=1", "procedure=explicit"], ["Abaqus/Standard"]),
        ("damping", ["mu0=-1", "c0=0", "eta=1"], ["coefficient", "clearance", "fraction"]),
        ("damping", ["mu0=1"], ["clearance"]),
        ("damping", ["mu0=1", "c0=1", "separation=prevented"], ["no parameter"]),
    ],
)
def test_what_makes_no_law_is_refused_in_full(kind, parameters, words):
    arguments = [word for parameter in parameters for word in ("--param", parameter)]
    done = support.call("law", kind, *arguments, "--at=0,0.1")
    assert done.returncode == 2 and not done.stdout
    assert all(word in done.stderr for word in words), done.stderr


def test_damping_has_no_inverse_and_at_is_given_once():
    damping = ["--param", "mu0=1", "--param", "c0=1"]
    done = support.call("law", "damping", *damping, "--at-pressure=1")
    assert done.returncode == 2 and "no pressure of its own" in done.stderr
    assert support.call("law", "linear", "--param", "k=1", "--at=0", "--at-pressure=1").returncode == 2
    assert support.call("law", "linear", "--param", "k=1").returncode == 2
