"""More of the laws through `overclosure law`: their beginning (A03), a ceiling while apart (A06), tables that pull (A11)."""

import csv
import io
from decimal import Decimal, getcontext
from fractions import Fraction

import pytest

import support


def evaluate(kind, overclosures, *parameters):
    """Rows (pressure, stiffness, energy) of `overclosure law`."""
    words = [word for parameter in parameters for word in ("--param", parameter)]
    done = support.call("law", kind, *words, "--at=" + ",".join(repr(h) for h in overclosures))
    assert done.returncode == 0, done.stderr
    rows = csv.DictReader(io.StringIO(done.stdout))
    return [tuple(float(row[name]) for name in ("pressure", "stiffness", "energy")) for row in rows]


def exact(h, clearance, pressure):
    """Pressure, slope and energy of the exponential law at exactly these doubles, to 60 digits."""
    getcontext().prec = 60
    ratio = 1 + Fraction(h) / Fraction(clearance)
    u = Decimal(ratio.numerator) / Decimal(ratio.denominator)
    c, p = Decimal(clearance), Decimal(pressure)
    scale = p / (Decimal(1).exp() - 1)
    curve = scale * u * (u.exp() - 1)
    slope = scale / c * ((u + 1) * u.exp() - 1)
    energy = scale * c * sum(u ** (k + 2) / (factorial(k) * (k + 2)) for k in range(1, 80))
    return float(curve), float(slope), float(energy)


def factorial(n):
    """n! as a decimal."""
    return Decimal(1) if n < 2 else n * factorial(n - 1)


@pytest.mark.parametrize(("clearance", "pressure"), [(1.0, 1.0), (0.01, 5.0), (2.0**-7, 300.0), (37.5, 0.02)])
def test_a03_the_beginning_of_the_exponential_law_does_not_cancel(clearance, pressure):
    """Pressure, slope and energy from u = 1e-9 to 2, relative to themselves."""
    parts = [1e-9, 1e-7, 1e-5, 1e-3, 0.03, 0.2, 0.49, 0.4999999, 0.5, 0.51, 0.9, 1.0, 2.0]
    overclosures = [-clearance + part * clearance for part in parts]
    found = evaluate("exponential", overclosures, f"c0={clearance!r}", f"p0={pressure!r}")
    for h, row in zip(overclosures, found, strict=True):
        assert row == pytest.approx(exact(h, clearance, pressure), rel=1e-12), h


def ceiling(stiffness, clearance, pressure):
    """`u*` with `(u + 1) e^u = 1 + kappa` by bisection, as h*, p*, U*."""
    getcontext().prec = 40
    c, p = Decimal(clearance), Decimal(pressure)
    scale = p / (Decimal(1).exp() - 1)
    target = 1 + Decimal(stiffness) * c / scale
    low, high = Decimal(0), Decimal(60)
    for _ in range(140):
        middle = (low + high) / 2
        low, high = (middle, high) if (middle + 1) * middle.exp() < target else (low, middle)
    energy = scale * c * ((low - 1) * low.exp() + 1 - low * low / 2)
    return c * (low - 1), scale * low * (low.exp() - 1), energy


@pytest.mark.parametrize("stiffness", [10.0, 300.0, 1200.0, 1290.9, 1291.1, 5.0e4])
def test_a06_a_ceiling_may_be_reached_while_surfaces_are_apart(stiffness):
    """Below p'(0) = 1290.988 the curve bends before touch: then p(0) < p0, and all beyond is straight."""
    clearance, pressure = 0.01, 5.0
    start, at_start, stored = ceiling(stiffness, clearance, pressure)
    assert (start < 0) == (stiffness < 1290.9883534346632)
    overclosures = [float(start) + 1e-4, -1e-5, 0.0, 0.003, 0.04, 2.0]
    found = evaluate(
        "exponential",
        overclosures,
        f"c0={clearance!r}",
        f"p0={pressure!r}",
        f"kmax={stiffness!r}",
        "procedure=explicit",
    )
    for h, row in zip(overclosures, found, strict=True):
        beyond = Decimal(h) - start
        if beyond <= 0:
            assert row == pytest.approx(exact(h, clearance, pressure), rel=1e-11)
            continue
        k = Decimal(stiffness)
        expected = (at_start + k * beyond, k, stored + at_start * beyond + k * beyond * beyond / 2)
        assert row == pytest.approx(tuple(map(float, expected)), rel=1e-11)
    touch = found[2][0]
    assert (touch < pressure) == (start < 0)


TABLES = [[(0.0, 0.0), (2.0, 0.01), (10.0, 0.02)], [(0.0, -0.02), (3.0, 0.0), (12.0, 0.03)], [(0.0, 0.005), (1.0, 0.5)]]


@pytest.mark.parametrize("table", TABLES)
def test_a11_a_table_goes_on_into_tension_with_its_first_slope(table):
    (_, onset), (second, at) = table[:2]
    slope = second / (at - onset)
    overclosures = [onset - 0.4, onset - 1e-3, onset - 1e-9, onset + 0.5 * (at - onset)]
    words = ["table=" + ",".join(f"{p!r}:{h!r}" for p, h in table), "separation=prevented", "procedure=explicit"]
    found = evaluate("tabular", overclosures, *words)
    for h, (pressure, stiffness, energy) in zip(overclosures, found, strict=True):
        assert pressure == pytest.approx(slope * (h - onset), rel=1e-9 if h > onset - 1e-6 and h < onset else 1e-12)
        assert stiffness == pytest.approx(slope, rel=1e-12)
        assert energy == pytest.approx(0.5 * slope * (h - onset) ** 2, rel=1e-7 if h > onset - 1e-6 else 1e-12)
    free = evaluate("tabular", overclosures[:3], words[0], "procedure=explicit")
    assert all(row == (0.0, 0.0, 0.0) for row in free)


@pytest.mark.parametrize(
    ("kind", "parameters", "word"),
    [
        ("exponential", ["c0=0.01", "p0=5", "separation=prevented", "procedure=explicit"], "separation"),
        ("linear", ["stiffness=5", "separation=prevented", "procedure=standard"], "separation"),
        ("tabular", ["table=1:0,2:0.1", "separation=prevented", "procedure=explicit"], "pressure"),
    ],
)
def test_laws_that_may_not_pull_are_refused(kind, parameters, word):
    words = [w for parameter in parameters for w in ("--param", parameter)]
    done = support.call("law", kind, *words, "--at=0")
    assert done.returncode == 2 and word in done.stderr
