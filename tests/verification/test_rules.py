"""What the manual forbids (V01 to V20): each combination is refused with its line and keyword, or warned of."""

import re
from dataclasses import dataclass

import pytest

import support
from verification.columns import Block, stack
from verification.points import Point, deck, node, step

PRESS = ["*CLOAD", f"{node()}, 3, -1."]
EXPLICIT = ["*STEP", "*DYNAMIC, EXPLICIT", ", 0.01", *PRESS, "*END STEP"]
LINEAR = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "100."]
TABLE = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR", "0., 0.", "2., 0.01"]
AUGMENTED = ["*SURFACE BEHAVIOR, AUGMENTED LAGRANGE"]
NO_SEPARATION = "*SURFACE BEHAVIOR, NO SEPARATION, PRESSURE-OVERCLOSURE={}"
CONTROLS = "*CONTACT CONTROLS, MASTER=WALL, SLAVE=POINTS, "


@dataclass(frozen=True)
class Rule:
    """Lines of the interaction and of the step; a finding must name the keyword and hold the words."""

    behavior: tuple
    steps: tuple
    keyword: str
    words: tuple
    line: str | None = None
    model: tuple = ()


def rule(behavior, keyword, *words, steps=None, line=None, model=()):
    """A rule whose step is a plain one unless given; `line` is the line of the deck that a finding stands at."""
    return Rule(tuple(behavior), tuple(steps or step(*PRESS)), keyword, words, line, tuple(model))


def standard(*cards):
    """A static step with cards."""
    return step(*cards, *PRESS)


V01 = [NO_SEPARATION.format("EXPONENTIAL"), "0.01, 5."]
V02 = {
    "EXPONENTIAL": [NO_SEPARATION.format("EXPONENTIAL"), "0.01, 5."],
    "LINEAR": [NO_SEPARATION.format("LINEAR"), "100."],
    "TABULAR": [NO_SEPARATION.format("TABULAR"), "0., 0.", "2., 0.01"],
}
GENERAL = ["*CONTACT", "*CONTACT INCLUSIONS, ALL EXTERIOR", "*CONTACT PROPERTY ASSIGNMENT", ", , SI"]

ERRORS = {
    "V01": rule(V01, "*SURFACE BEHAVIOR", "NO SEPARATION", "EXPONENTIAL", steps=EXPLICIT, line=V01[0]),
    **{
        f"V02 {law}": rule(lines, "*SURFACE BEHAVIOR", "NO SEPARATION", law, line=lines[0])
        for law, lines in V02.items()
    },
    "V03": rule(
        ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL", "0.01, 5."],
        "*CONTACT",
        "general contact",
        steps=EXPLICIT,
        model=GENERAL,
    ),
    "V04": rule(
        ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR", "0., 0.001", "2., 0.01"],
        "*CONTACT",
        "general contact",
        steps=EXPLICIT,
        model=GENERAL,
    ),
    "V05 general": rule(
        ["*SURFACE BEHAVIOR, NO SEPARATION"], "*CONTACT", "general contact", steps=EXPLICIT, model=GENERAL
    ),
    "V05 adaptive mesh": rule(
        ["*SURFACE BEHAVIOR, NO SEPARATION"], "*ADAPTIVE MESH", steps=standard("*ADAPTIVE MESH, ELSET=EWALL")
    ),
    "V06": rule(TABLE[:2], "*SURFACE BEHAVIOR", "two", line=TABLE[1]),
    "V07 pressure": rule([*TABLE, "1.5, 0.02"], "*SURFACE BEHAVIOR", "increas"),
    "V07 overclosure": rule([*TABLE, "3., 0.005"], "*SURFACE BEHAVIOR", "increas"),
    "V07 equal": rule([*TABLE, "3., 0.01"], "*SURFACE BEHAVIOR", "increas"),
    "V07 first pressure": rule([TABLE[0], "1., 0.", "2., 0.01"], "*SURFACE BEHAVIOR", "pressure"),
    "V08 zero": rule([LINEAR[0], "0."], "*SURFACE BEHAVIOR", "positive"),
    "V08 negative": rule([LINEAR[0], "-3."], "*SURFACE BEHAVIOR", "positive"),
    **{
        f"V09 {data}": rule(
            ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL", data], "*SURFACE BEHAVIOR", "positive"
        )
        for data in ("0., 5.", "-0.01, 5.", "0.01, 0.", "0.01, -5.")
    },
    **{
        f"V10 {law}": rule(
            [f"{lines[0].replace('NO SEPARATION', 'AUGMENTED LAGRANGE')}", *lines[1:]],
            "*SURFACE BEHAVIOR",
            "AUGMENTED LAGRANGE",
            law,
        )
        for law, lines in V02.items()
    },
    "V11": rule(
        AUGMENTED,
        "*CONTACT CONTROLS",
        "ABSOLUTE",
        "RELATIVE",
        steps=standard(CONTROLS + "ABSOLUTE PENETRATION TOLERANCE=0.001, RELATIVE PENETRATION TOLERANCE=0.01"),
    ),
    **{
        f"V12 {word}": rule(
            ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"],
            "*CONTACT CONTROLS",
            "AUTOMATIC TOLERANCES",
            word.partition("=")[0],
            steps=standard(CONTROLS + f"AUTOMATIC TOLERANCES, {word}"),
        )
        for word in ("MAXCHP=1", "MAXCHP=1, PERRMX=0.5", "MAXCHP=2, UERRMX=0.01")
    },
    **{
        f"V13 {word}": rule(
            ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"],
            "*CONTACT CONTROLS",
            "MAXCHP",
            steps=standard(CONTROLS + word),
        )
        for word in ("PERRMX=0.5", "UERRMX=0.01", "UERRMX=0.01, PERRMX=2.")
    },
    "V14": rule(
        [*LINEAR, "*CONTACT DAMPING, DEFINITION=CRITICAL DAMPING FRACTION", "0.03,"],
        "*CONTACT DAMPING",
        "CRITICAL DAMPING FRACTION",
    ),
    "V16": rule(
        AUGMENTED,
        "*DEBOND",
        "AUGMENTED LAGRANGE",
        steps=standard("*DEBOND, MASTER=WALL, SLAVE=POINTS", "0., 1., 1., 0."),
    ),
    "V17": rule(
        ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR, NO SEPARATION", "1., 0.", "2., 0.01"],
        "*SURFACE BEHAVIOR",
        steps=EXPLICIT,
    ),
    "V18": rule(
        ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"],
        "*CONTACT CONTROLS",
        "MAXCHP",
        steps=[*EXPLICIT[:3], CONTROLS + "MAXCHP=1, UERRMX=0.01", *EXPLICIT[3:]],
    ),
    "V20": rule(
        ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"],
        "*CONTACT INTERFERENCE",
        "SHRINK",
        "first step",
        steps=[*step(*PRESS), *standard("*CONTACT INTERFERENCE, SHRINK", "POINTS, WALL")],
        line="*CONTACT INTERFERENCE, SHRINK",
    ),
}


def check(write_deck, rule):
    """`overclosure check`: exit code, text, the deck's lines, and line numbers that the findings of the keyword stand at."""
    text = deck([Point(spring=100.0)], rule.behavior, rule.steps, model=rule.model)
    path = write_deck(text)
    done = support.call("check", path)
    assert "panicked" not in done.stderr
    return done, text.splitlines()


@pytest.mark.parametrize("name", ERRORS)
def test_the_manuals_rules_are_kept(write_deck, name):
    """Exit code 2; a finding at a line names the keyword and says what is wrong with it."""
    rule = ERRORS[name]
    done, lines = check(write_deck, rule)
    told = done.stdout + done.stderr
    assert done.returncode == 2, told
    findings = [part for part in told.splitlines() if rule.keyword in part.upper()]
    assert findings, told
    for word in rule.words:
        assert word.upper() in told.upper(), (word, told)
    numbers = [
        int(number)
        for finding in findings
        for number in re.findall(r":(\d+)|line (\d+)", finding)
        for number in number
        if number
    ]
    assert numbers, told
    if rule.line:
        assert lines.index(rule.line) + 1 in numbers, told


def test_run_refuses_what_check_refuses(write_deck, tmp_path):
    rule = ERRORS["V02 LINEAR"]
    path = write_deck(deck([Point(spring=100.0)], rule.behavior, rule.steps))
    done = support.call("run", path, "--out", tmp_path / "out", "--quiet")
    assert done.returncode == 2 and "NO SEPARATION" in done.stderr
    assert not (tmp_path / "out").exists() or not any((tmp_path / "out").iterdir())


def test_v02_hard_beside_no_separation_is_accepted(write_deck):
    rule_ = rule([NO_SEPARATION.format("HARD")], "")
    done, _ = check(write_deck, rule_)
    assert done.returncode == 0, done.stdout + done.stderr


def test_v12_automatic_tolerances_alone_are_accepted_with_a_word(write_deck):
    rule_ = rule(
        ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"], "", steps=standard(CONTROLS + "AUTOMATIC TOLERANCES")
    )
    done, _ = check(write_deck, rule_)
    assert done.returncode in (0, 2)
    assert "AUTOMATIC TOLERANCES" in (done.stdout + done.stderr).upper()


def test_v15_damping_on_hard_kinematic_contact_is_a_warning(write_deck):
    """The procedure is refused, the damping is only warned of: its finding is no error."""
    behavior = [
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD",
        "*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT",
        "8.,",
    ]
    done, _ = check(write_deck, rule(behavior, "", steps=EXPLICIT))
    told = [line for line in (done.stdout + done.stderr).splitlines() if "*CONTACT DAMPING" in line.upper()]
    assert any("warning" in line.lower() for line in told), done.stdout + done.stderr


def explicit_blocks(behavior, *model):
    """Two deformable blocks in a pair of Abaqus/Explicit."""
    blocks = {
        "TOP": Block((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (1, 1, 1), 500.0),
        "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 1.5, 0.0), (1, 1, 1), 1000.0),
    }
    lines = [*model, "*BOUNDARY", "BOTTOM_ALL, 1, 3", "*STEP", "*DYNAMIC, EXPLICIT", ", 0.01", "*END STEP"]
    return stack(blocks, behavior, lines)


def findings(write_deck, text):
    """What `check` tells, line by line."""
    done = support.call("check", write_deck(text))
    assert done.returncode == 2 and "panicked" not in done.stderr
    return (done.stdout + done.stderr).splitlines()


def test_v05_no_separation_needs_pure_weighting(write_deck):
    """Two deformable surfaces are balanced unless WEIGHT says otherwise."""
    text = explicit_blocks(["*SURFACE BEHAVIOR, NO SEPARATION"])
    assert any("balanced" in line and "NO SEPARATION" in line for line in findings(write_deck, text))


@pytest.mark.parametrize("constraint", ["KINEMATIC", "PENALTY"])
def test_v19_a_rigid_surface_is_no_secondary_of_kinematic_contact(write_deck, constraint):
    rigid = ["*NODE, NSET=REFERENCE", "999, 0.5, 0.5, 0.5", "*RIGID BODY, REF NODE=999, ELSET=ETOP"]
    text = explicit_blocks(["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"], *rigid)
    pair = "*CONTACT PAIR, INTERACTION=SI, TYPE=NODE TO SURFACE"
    assert pair in text
    text = text.replace(pair, f"*CONTACT PAIR, INTERACTION=SI, MECHANICAL CONSTRAINT={constraint}")
    told = [line for line in findings(write_deck, text) if "rigid surface cannot be the secondary" in line]
    assert bool(told) == (constraint == "KINEMATIC")


def test_every_finding_comes_at_once(write_deck):
    behavior = [*V02["LINEAR"], "*CONTACT DAMPING, DEFINITION=CRITICAL DAMPING FRACTION", "0.03,"]
    steps = standard(CONTROLS + "PERRMX=0.5", CONTROLS + "AUTOMATIC TOLERANCES, MAXCHP=1")
    done, _ = check(write_deck, rule(behavior, "", steps=steps))
    told = (done.stdout + done.stderr).upper()
    assert done.returncode == 2
    for word in ("NO SEPARATION", "CRITICAL DAMPING FRACTION", "MAXCHP", "AUTOMATIC TOLERANCES"):
        assert word in told
