"""Combinations that the manual forbids (V01 to V20): one deck each, with outcome, line, keyword, reason and remedy.

The deck is examples/two_blocks.inp with changes, for what the manual forbids in explicit analyses as one with `*DYNAMIC, EXPLICIT`. The
tables behind it are in docs/availability.md.
"""

from dataclasses import dataclass

import pytest

import support

GOOD = (support.ROOT / "examples" / "two_blocks.inp").read_text(encoding="utf-8")
LAW = "PRESSURE-OVERCLOSURE=EXPONENTIAL\n** c0, p0: clearance at zero pressure, pressure at zero clearance\n0.005, 1.\n"
PAIR = "*CONTACT PAIR, INTERACTION=SOFT, TYPE=NODE TO SURFACE, SMALL SLIDING\nSSL, SMA\n"
BEHAVIOR = "*SURFACE BEHAVIOR"
DAMPING = "*CONTACT DAMPING"
CONTROLS = "*CONTACT CONTROLS"


@dataclass(frozen=True)
class Case:
    """A deck, the line that is blamed (the first that begins so), its keyword, and words of message and remedy."""

    name: str
    law: str
    keyword: str
    line: str
    reason: str
    remedy: str
    explicit: bool = False
    implicit: bool = False
    step: str = ""
    later: str = ""
    pair: str = PAIR
    model: str = ""
    outcome: str = "error"

    def deck(self):
        """Text of the deck."""
        text = GOOD.replace(LAW, self.law + "\n", 1).replace(PAIR, self.pair, 1)
        if self.explicit or self.implicit:
            procedure = "*DYNAMIC, EXPLICIT\n, 1e-6\n" if self.explicit else "*DYNAMIC\n0.25, 1.\n"
            text = text.replace("*STATIC\n0.25, 1.\n", procedure, 1)
            text = text.replace("1000., 0.3\n", "1000., 0.3\n*DENSITY\n1e-9\n", 1)
            text = text.replace("*BOUNDARY\nNTOP, 3", "*BOUNDARY, TYPE=VELOCITY\nNTOP, 3", 1)
        text = text.replace("*STEP\n", self.model + "*STEP\n", 1).replace("*END STEP\n", self.step + "*END STEP\n", 1)
        return text + (f"*STEP\n*STATIC\n1., 1.\n{self.later}*END STEP\n" if self.later else "")


GENERAL = {"explicit": True, "pair": "", "step": "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n"}
WEIGHTED = PAIR.replace("SMALL SLIDING", "SMALL SLIDING, WEIGHT=1.")
EXPONENTIAL = "PRESSURE-OVERCLOSURE=EXPONENTIAL"
TABULAR = "PRESSURE-OVERCLOSURE=TABULAR"

CASES = [
    Case(
        "V01 exponential, no separation",
        f"{EXPONENTIAL}, NO SEPARATION\n0.005, 1.",
        BEHAVIOR,
        BEHAVIOR,
        "the exponential law cannot be combined with NO SEPARATION in any analysis",
        "leave NO SEPARATION out",
        explicit=True,
    ),
    *(
        Case(
            f"V02 {law.lower()}, no separation in Standard",
            f"PRESSURE-OVERCLOSURE={law}, NO SEPARATION\n{data}",
            BEHAVIOR,
            BEHAVIOR,
            f"the {law.lower()} law cannot be combined with NO SEPARATION: in implicit and static analyses",
            "choose PRESSURE-OVERCLOSURE=HARD",
        )
        for law, data in [("LINEAR", "5."), ("TABULAR", "0., 0.\n1., 0.1"), ("EXPONENTIAL", "0.005, 1.")]
    ),
    Case(
        "V03 exponential, general contact",
        f"{EXPONENTIAL}\n0.005, 1.",
        BEHAVIOR,
        BEHAVIOR,
        "the exponential law is not available for general contact",
        "choose LINEAR or TABULAR",
        **GENERAL,
    ),
    Case(
        "V04 table that begins elsewhere, general contact",
        f"{TABULAR}\n0., -0.01\n1., 0.1",
        BEHAVIOR,
        BEHAVIOR,
        "the table does not begin at zero overclosure",
        "begin the table with 0, 0",
        **GENERAL,
    ),
    Case(
        "V05 no separation, balanced weighting",
        "NO SEPARATION",
        BEHAVIOR,
        BEHAVIOR,
        "NO SEPARATION cannot be combined with balanced weighting",
        "WEIGHT=0 or WEIGHT=1",
        explicit=True,
    ),
    Case(
        "V05 no separation, adaptive mesh",
        "NO SEPARATION",
        BEHAVIOR,
        BEHAVIOR,
        "NO SEPARATION cannot be combined with *ADAPTIVE MESH",
        "remove *ADAPTIVE MESH",
        explicit=True,
        pair=WEIGHTED,
        step="*ADAPTIVE MESH, ELSET=UPPER\n",
    ),
    Case(
        "V05 no separation, general contact",
        "NO SEPARATION",
        BEHAVIOR,
        BEHAVIOR,
        "NO SEPARATION is not available for general contact",
        "describe the contact by *CONTACT PAIR",
        **GENERAL,
    ),
    Case(
        "V06 table of one line",
        f"{TABULAR}\n0., 0.",
        BEHAVIOR,
        "0., 0.",
        "at least two points",
        "correct the data line",
    ),
    Case(
        "V07 table that does not rise",
        f"{TABULAR}\n0., 0.\n2., 0.1\n1., 0.2",
        BEHAVIOR,
        "0., 0.",
        "does not exceed",
        "correct the data line",
    ),
    Case(
        "V07 table with pressure at its first point",
        f"{TABULAR}\n1., 0.\n2., 0.1",
        BEHAVIOR,
        "1., 0.\n",
        "first pressure of a table must be zero",
        "correct the data line",
    ),
    *(
        Case(
            f"V08 slope {slope}",
            f"PRESSURE-OVERCLOSURE=LINEAR\n{slope}",
            BEHAVIOR,
            f"{slope}\n",
            "must be a positive finite number",
            "correct the data line",
        )
        for slope in ["0.", "-5."]
    ),
    *(
        Case(
            f"V09 exponential {data}",
            f"{EXPONENTIAL}\n{data}",
            BEHAVIOR,
            f"{data}\n",
            "must be a positive finite number",
            "correct the data line",
        )
        for data in ["0., 1.", "-0.005, 1.", "0.005, 0.", "0.005, -1."]
    ),
    *(
        Case(
            f"V10 {law.lower()}, augmented Lagrange",
            f"PRESSURE-OVERCLOSURE={law}, AUGMENTED LAGRANGE\n{data}",
            BEHAVIOR,
            BEHAVIOR,
            f"the {law.lower()} law cannot be combined with AUGMENTED LAGRANGE",
            "leave AUGMENTED LAGRANGE or PRESSURE-OVERCLOSURE out",
        )
        for law, data in [("LINEAR", "5."), ("TABULAR", "0., 0.\n1., 0.1"), ("EXPONENTIAL", "0.005, 1.")]
    ),
    Case(
        "V11 two tolerances",
        "AUGMENTED LAGRANGE",
        CONTROLS,
        CONTROLS,
        "ABSOLUTE and RELATIVE PENETRATION TOLERANCE exclude each other",
        "keep one of them",
        step=f"{CONTROLS}, ABSOLUTE PENETRATION TOLERANCE=1e-4, RELATIVE PENETRATION TOLERANCE=0.01\n",
    ),
    Case(
        "V12 automatic tolerances",
        "",
        CONTROLS,
        CONTROLS,
        "AUTOMATIC TOLERANCES cannot be combined with MAXCHP, PERRMX and UERRMX",
        "keep one of them",
        step=f"{CONTROLS}, AUTOMATIC TOLERANCES, MAXCHP=2, UERRMX=0.01\n",
    ),
    *(
        Case(
            f"V13 {parameter} without MAXCHP",
            "",
            CONTROLS,
            CONTROLS,
            "UERRMX and PERRMX need MAXCHP",
            "give MAXCHP",
            step=f"{CONTROLS}, {parameter}=0.01\n",
        )
        for parameter in ["UERRMX", "PERRMX"]
    ),
    Case(
        "V14 critical damping fraction in Standard",
        f"\n{DAMPING}, DEFINITION=CRITICAL DAMPING FRACTION\n0.1",
        DAMPING,
        DAMPING,
        "the critical damping fraction is not available for contact pairs of implicit and static analyses",
        "DEFINITION=DAMPING COEFFICIENT",
    ),
    Case(
        "V15 damping of hard kinematic contact",
        f"\n{DAMPING}\n8., 0.1",
        DAMPING,
        DAMPING,
        "*CONTACT DAMPING is ignored for hard kinematic contact",
        "MECHANICAL CONSTRAINT=PENALTY",
        explicit=True,
        outcome="warning",
    ),
    Case(
        "V16 augmented Lagrange on debonding surfaces",
        "AUGMENTED LAGRANGE",
        BEHAVIOR,
        BEHAVIOR,
        "AUGMENTED LAGRANGE cannot be combined with *DEBOND",
        "leave AUGMENTED LAGRANGE out",
        step="*DEBOND, SLAVE=SSL, MASTER=SMA\n0., 1.\n",
    ),
    Case(
        "V17 no separation of a table without zero pressure",
        f"{TABULAR}, NO SEPARATION\n1., 0.\n2., 0.1",
        BEHAVIOR,
        BEHAVIOR,
        "NO SEPARATION cannot be combined with a table without a point of zero pressure",
        "begin the table with a point of zero pressure",
        explicit=True,
        pair=WEIGHTED,
    ),
    Case(
        "V18 modified hard contact in Explicit",
        "",
        CONTROLS,
        CONTROLS,
        "modified hard contact is not available for contact pairs of explicit analyses",
        "solve a static step",
        explicit=True,
        step=f"{CONTROLS}, MAXCHP=2, UERRMX=0.01\n",
    ),
    Case(
        "V19 rigid secondary surface, kinematic",
        "",
        "*CONTACT PAIR",
        "*CONTACT PAIR",
        "a rigid surface cannot be the secondary one of kinematic contact",
        "exchange the surfaces",
        explicit=True,
        model="*RIGID BODY, ELSET=UPPER, REF NODE=15\n",
    ),
    Case(
        "softened contact in an implicit dynamic step",
        "PRESSURE-OVERCLOSURE=LINEAR\n5.",
        BEHAVIOR,
        BEHAVIOR,
        "the linear law makes impacts elastic in an implicit dynamic step",
        "choose PRESSURE-OVERCLOSURE=HARD",
        implicit=True,
        outcome="warning",
    ),
    Case(
        "TAUMAX of zero in Explicit",
        "\n*FRICTION, ROUGH, TAUMAX=0.",
        "*FRICTION",
        "*FRICTION",
        "TAUMAX=0 is not allowed",
        "leave TAUMAX out",
        explicit=True,
    ),
    Case(
        "V20 shrink behind the first step",
        "",
        "*CONTACT INTERFERENCE",
        "*CONTACT INTERFERENCE",
        "SHRINK stands outside the first step",
        "move it into the first step",
        later="*CONTACT INTERFERENCE, SHRINK\nSSL, SMA\n",
    ),
]


def found(case, deck):
    """Lines of the findings of a deck, which a warning alone does not refuse."""
    done = support.call("check", deck)
    assert done.returncode == (2 if case.outcome == "error" else 0), (done.returncode, done.stdout, done.stderr)
    assert "panicked" not in done.stderr
    return done.stderr.splitlines()


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name.replace(" ", "_"))
def test_the_combination_is_reported_with_line_keyword_reason_and_remedy(write_deck, case):
    text = case.deck()
    before = text[: text.index(f"\n{case.line}") + 1]
    place = f"deck.inp:{before.count(chr(10)) + 1}: {case.outcome}: {case.keyword}: "
    findings = found(case, write_deck(text))
    matching = [line for line in findings if place in line and case.reason in line]
    assert matching, (place, case.reason, findings)
    assert case.remedy in matching[0].split("; ", 1)[1], matching[0]


@pytest.mark.parametrize(
    ("law", "step"),
    [
        ("PRESSURE-OVERCLOSURE=HARD, NO SEPARATION", ""),
        ("AUGMENTED LAGRANGE", f"{CONTROLS}, ABSOLUTE PENETRATION TOLERANCE=1e-4\n"),
        ("PRESSURE-OVERCLOSURE=HARD", f"{CONTROLS}, MAXCHP=2, UERRMX=0.001, PERRMX=0.1\n"),
        (f"\n{DAMPING}, DEFINITION=DAMPING COEFFICIENT\n0.001, 0.01", ""),
        (f"{TABULAR}\n0., -0.01\n1., 0.1", ""),
        ("", "*CONTACT INTERFERENCE, SHRINK\nSSL, SMA\n"),
    ],
)
def test_what_the_rules_leave_is_solved(write_deck, tmp_path, law, step):
    text = Case("", law, "", "", "", "", step=step).deck()
    assert support.run(write_deck(text), tmp_path / "out").summary()["outcome"] == "completed"


@pytest.mark.parametrize(
    ("law", "pair", "step"),
    [
        ("PRESSURE-OVERCLOSURE=LINEAR, NO SEPARATION\n5.", WEIGHTED, ""),
        (f"{TABULAR}, NO SEPARATION\n0., 0.\n2., 0.1", WEIGHTED, ""),
        (f"{EXPONENTIAL}\n0.005, 1., 1e4", PAIR, ""),
        (
            f"\n{DAMPING}, DEFINITION=CRITICAL DAMPING FRACTION\n0.1",
            PAIR.replace("SMALL", "MECHANICAL CONSTRAINT=PENALTY, SMALL"),
            "",
        ),
        ("PRESSURE-OVERCLOSURE=LINEAR\n5.", "", GENERAL["step"]),
    ],
)
def test_what_the_rules_leave_to_explicit_analyses_is_accepted(write_deck, law, pair, step):
    text = Case("", law, "", "", "", "", explicit=True, pair=pair, step=step).deck()
    done = support.call("check", write_deck(text))
    assert done.returncode == 0, done.stderr


def test_both_reasons_are_given_where_both_apply(write_deck):
    case = CASES[3]
    assert case.name.startswith("V02 exponential")
    findings = [line for line in found(case, write_deck(case.deck())) if BEHAVIOR in line]
    assert len(findings) == 2, findings
    assert sum("in any analysis" in line for line in findings) == 1
