"""Nonsense in a deck is refused: exit code, line, keyword, what is wrong. The deck is examples/two_blocks.inp with one change."""

import re
from dataclasses import dataclass

import pytest

import support

GOOD = (support.ROOT / "examples" / "two_blocks.inp").read_text(encoding="utf-8")


@dataclass(frozen=True)
class Refusal:
    """A change to the good deck, the keyword it must be blamed on, and words that the message must contain."""

    name: str
    old: str
    new: str
    keyword: str
    words: tuple[str, ...]


REFUSALS = [
    Refusal("unknown node set", "NTOP, 3, 3, -0.02", "NTIP, 3, 3, -0.02", "*BOUNDARY", ("NTIP",)),
    Refusal(
        "unknown element set", "*SOLID SECTION, ELSET=UPPER", "*SOLID SECTION, ELSET=UPER", "*SOLID SECTION", ("UPER",)
    ),
    Refusal("unknown surface", "SSL, SMA", "SSL, SMB", "*CONTACT PAIR", ("SMB",)),
    Refusal(
        "unknown interaction",
        "*CONTACT PAIR, INTERACTION=SOFT",
        "*CONTACT PAIR, INTERACTION=HARD",
        "*CONTACT PAIR",
        ("HARD",),
    ),
    Refusal(
        "unknown material", "ELSET=UPPER, MATERIAL=RUBBER", "ELSET=UPPER, MATERIAL=STEEL", "*SOLID SECTION", ("STEEL",)
    ),
    Refusal("missing section", "*SOLID SECTION, ELSET=UPPER, MATERIAL=RUBBER\n", "", "", ("2", "section")),
    Refusal("material without stiffness", "*ELASTIC\n1000., 0.3\n", "", "*MATERIAL", ("RUBBER", "*ELASTIC")),
    Refusal("inverted element", "2, 11, 12, 13, 14, 15", "2, 11, 14, 13, 12, 15", "*ELEMENT", ("2",)),
    Refusal("element without volume", "14, 15, 16, 17, 18\n*NSET", "14, 11, 12, 13, 14\n*NSET", "*ELEMENT", ("2",)),
    Refusal("node twice, elsewhere", "18, 0.1, 1.1, 2.0", "18, 0.1, 1.1, 2.0\n18, 0.1, 1.2, 2.0", "*NODE", ("18",)),
    Refusal(
        "unknown node in an element",
        "15, 16, 17, 18\n*NSET, NSET=NBOT",
        "15, 16, 17, 19\n*NSET, NSET=NBOT",
        "*ELEMENT",
        ("19",),
    ),
    Refusal("text where a number belongs", "1000., 0.3", "soft, 0.3", "*ELASTIC", ("soft",)),
    Refusal("incompressible material", "1000., 0.3", "1000., 0.5", "*ELASTIC", ("0.5",)),
    Refusal("exponential law without clearance", "0.005, 1.", "0., 1.", "*SURFACE BEHAVIOR", ("c0",)),
    Refusal("exponential law without pressure", "0.005, 1.", "0.005, -1.", "*SURFACE BEHAVIOR", ("p0",)),
    Refusal("linear law without slope", "EXPONENTIAL\n", "LINEAR\n0.\n", "*SURFACE BEHAVIOR", ("slope",)),
    Refusal("table of one line", "EXPONENTIAL\n", "TABULAR\n", "*SURFACE BEHAVIOR", ("two",)),
    Refusal(
        "no separation with a softened law",
        "=EXPONENTIAL",
        "=EXPONENTIAL, NO SEPARATION",
        "*SURFACE BEHAVIOR",
        ("SEPARATION",),
    ),
    Refusal("friction", "*CONTACT PAIR, INT", "*FRICTION\n0.2\n*CONTACT PAIR, INT", "*FRICTION", ("without friction",)),
    Refusal(
        "keyword that changes the answer",
        "*STEP\n",
        "*TIE, NAME=T\nSSL, SMA\n*STEP\n",
        "*TIE",
        ("would change the answer", "*EQUATION"),
    ),
    Refusal(
        "equation over a held direction",
        "*STEP\n",
        "*EQUATION\n2\n1, 1, 1., 2, 1, -1.\n*STEP\n",
        "*EQUATION",
        ("node 1", "*BOUNDARY"),
    ),
    Refusal(
        "equations in a circle",
        "*STEP\n",
        "*EQUATION\n2\n5, 1, 1., 6, 1, -1.\n2\n6, 1, 1., 5, 1, 1.\n*STEP\n",
        "*EQUATION",
        ("circle", "node 5", "node 6"),
    ),
    Refusal(
        "spring without stiffness",
        "*STEP\n",
        "*ELEMENT, TYPE=SPRING1, ELSET=GROUND\n7, 6\n*SPRING, ELSET=GROUND\n1\n*STEP\n",
        "*SPRING",
        ("data", "missing"),
    ),
    Refusal(
        "spring that is not linear",
        "*STEP\n",
        "*ELEMENT, TYPE=SPRING1, ELSET=G\n7, 6\n*SPRING, ELSET=G, NONLINEAR\n1\n0., 0.\n1., 1.\n*STEP\n",
        "*SPRING",
        ("NONLINEAR",),
    ),
    Refusal(
        "bar without a section",
        "*STEP\n",
        "*ELEMENT, TYPE=T3D2, ELSET=BAR\n7, 5, 15\n*STEP\n",
        "*ELEMENT",
        ("section", "7"),
    ),
    Refusal("restart in the deck", "*STEP\n", "*RESTART, READ, STEP=1\n*STEP\n", "*RESTART", ("--restart",)),
    Refusal(
        "element that cannot be solved", "TYPE=C3D8, ELSET=UPPER", "TYPE=C3D27, ELSET=UPPER", "*ELEMENT", ("C3D27",)
    ),
    Refusal("no step", "*STEP\n", "** \n", "", ("*STEP",)),
]


# What supports leave free, and what becomes of it: no load along it, or a load that neither supports nor contact balance.
UNLOADED = [
    Refusal(
        "body on another", "NTOP, 1, 2\nNTOP, 3, 3, -0.02\n", "NBOT, 3, 3, -0.02\n", "", ("UPPER", "rotation about 3")
    ),
    Refusal("body held by one node", "NTOP, 1, 2\nNTOP, 3, 3, -0.02\n", "15, 3, 3, -0.02\n", "", ("UPPER", "along 1")),
    # It swings out of the way until contact carries nothing.
    Refusal("pivoted body", "NBOT, 1, 3\n", "1, 1, 3\n", "", ("LOWER", "rotation")),
]
LOADED = [
    Refusal(
        "lifted body",
        "NTOP, 1, 2\nNTOP, 3, 3, -0.02\n",
        "NTOP, 1, 2\n*CLOAD\nNTOP, 3, 5.\n",
        "",
        ("UPPER", "neither supports nor contact"),
    ),
]


PUSHED = Refusal(
    "body pushed sideways",
    "NTOP, 1, 2\n",
    "*CLOAD\n15, 1, 1.\n*BOUNDARY\n",
    "*BOUNDARY",
    ("UPPER", "neither supports nor contact", "translation along 1"),
)


def changed(refusal):
    """The good deck with the change applied."""
    assert GOOD.count(refusal.old) >= 1, f"the good deck no longer contains {refusal.old!r}"
    return GOOD.replace(refusal.old, refusal.new, 1)


def read(done):
    """Diagnostics of a refused call; asserts the exit code and that nothing panicked."""
    assert done.returncode == 2, (done.returncode, done.stdout, done.stderr)
    assert "panicked" not in done.stderr
    return done.stderr


@pytest.mark.parametrize("refusal", REFUSALS, ids=lambda r: r.name.replace(" ", "_"))
@pytest.mark.parametrize("verb", ["run", "check"])
def test_refused_with_exit_code_2_and_a_clear_message(write_deck, tmp_path, refusal, verb):
    deck = write_deck(changed(refusal))
    arguments = ["--out", tmp_path / "out", "--quiet"] if verb == "run" else []
    message = read(support.call(verb, deck, *arguments))
    for word in refusal.words:
        assert word.lower() in message.lower(), message
    assert "error" in message
    if refusal.keyword:
        pattern = rf"deck\.inp:\d+: error: {re.escape(refusal.keyword)}"
        assert re.search(pattern, message), message
    assert not list(tmp_path.glob("out/*.csv")), "a refused deck leaves no results"


@pytest.mark.parametrize("change", UNLOADED, ids=lambda r: r.name.replace(" ", "_"))
def test_a_free_body_that_no_load_moves_stays_and_is_named(write_deck, tmp_path, change):
    done = support.call("run", write_deck(changed(change)), "--out", tmp_path / "out", "--quiet")
    assert done.returncode == 0, done.stderr
    for word in (*change.words, "stays where it is"):
        assert word in done.stderr, done.stderr


@pytest.mark.parametrize("change", LOADED, ids=lambda r: r.name.replace(" ", "_"))
def test_a_load_that_nothing_balances_stops_the_run_with_exit_code_3(write_deck, tmp_path, change):
    done = support.call("run", write_deck(changed(change)), "--out", tmp_path / "out", "--quiet")
    assert done.returncode == 3, (done.returncode, done.stderr)
    stopped = next(line for line in done.stderr.splitlines() if line.startswith("stopped"))
    for word in change.words:
        assert word in stopped, stopped


@pytest.mark.parametrize("verb", ["run", "check"])
def test_a_load_that_no_contact_can_balance_is_refused_before_anything_is_solved(write_deck, tmp_path, verb):
    arguments = ["--out", tmp_path / "out", "--quiet"] if verb == "run" else []
    message = read(support.call(verb, write_deck(changed(PUSHED)), *arguments))
    for word in (PUSHED.keyword, *PUSHED.words):
        assert word in message, message
    assert not list(tmp_path.glob("out/*.csv"))


def test_the_unchanged_deck_is_accepted(write_deck, tmp_path):
    deck = write_deck(GOOD)
    assert support.call("check", deck).returncode == 0
    assert support.run(deck, tmp_path).summary()["outcome"] == "completed"


def test_the_line_of_the_fault_is_named(write_deck):
    text = GOOD.replace("NTOP, 3, 3, -0.02", "NTIP, 3, 3, -0.02")
    line = text.splitlines().index("NTIP, 3, 3, -0.02") + 1
    assert f"deck.inp:{line}: error: *BOUNDARY" in read(support.call("check", write_deck(text)))


def test_every_fault_is_reported_at_once(write_deck):
    text = (
        GOOD.replace("NTOP, 3, 3, -0.02", "NTIP, 3, 3, -0.02")
        .replace("1000., 0.3", "1000., 0.6")
        .replace("SSL, SMA", "SSL, SMB")
    )
    message = read(support.call("check", write_deck(text)))
    for word in ("NTIP", "0.6", "SMB"):
        assert word in message
    assert message.count("error:") >= 3


def test_an_empty_deck_is_refused(write_deck):
    for text in ("", "\n\n", "** nothing but a comment\n"):
        assert "empty" in read(support.call("check", write_deck(text))).lower()


def test_a_binary_file_is_refused(tmp_path):
    deck = tmp_path / "deck.inp"
    deck.write_bytes(bytes(range(256)) * 64)
    message = read(support.call("check", deck))
    assert len(message.splitlines()) < 60, "a binary file must not give an endless list"
    deck.write_bytes(support.binary().read_bytes()[:200_000])
    assert len(read(support.call("check", deck)).splitlines()) < 60


@pytest.mark.parametrize("part", [0.03, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.97])
def test_a_deck_cut_in_the_middle_is_refused(write_deck, part):
    cut = GOOD[: int(len(GOOD) * part)]
    assert "error" in read(support.call("check", write_deck(cut)))


def test_a_missing_file_is_refused_by_name(tmp_path):
    assert "nowhere.inp" in read(support.call("run", tmp_path / "nowhere.inp"))


def test_a_missing_include_is_refused_by_name(write_deck):
    text = GOOD.replace("*MATERIAL", "*INCLUDE, INPUT=materials.inc\n*MATERIAL", 1)
    message = read(support.call("check", write_deck(text)))
    assert "materials.inc" in message and "*INCLUDE" in message


def test_an_unsupported_keyword_that_changes_nothing_is_a_warning(write_deck, tmp_path):
    deck = write_deck(GOOD.replace("*STEP\n", "*PREPRINT, ECHO=NO\n*STEP\n", 1))
    done = support.call("check", deck)
    assert done.returncode == 0
    assert "warning" in done.stderr + done.stdout and "*PREPRINT" in done.stderr + done.stdout
    support.run(deck, tmp_path)


def test_large_displacements_are_solved_small_with_a_warning(write_deck):
    deck = write_deck(GOOD.replace("*STEP\n", "*STEP, NLGEOM\n", 1))
    done = support.call("check", deck)
    assert done.returncode == 0
    assert "NLGEOM" in done.stderr + done.stdout


def test_sliding_beyond_half_a_face_stops_the_run(write_deck, tmp_path):
    text = GOOD.replace("NTOP, 1, 2\n", "NTOP, 2, 2\nNTOP, 1, 1, 0.8\n")
    deck = write_deck(text.replace("0.25, 1.", "0.05, 1., , 0.05"))
    done = support.call("run", deck, "--out", tmp_path, "--quiet")
    assert done.returncode == 3, (done.returncode, done.stderr)
    assert "half" in done.stderr
    result = support.Result(tmp_path, "deck")
    assert result.summary()["outcome"] == "stopped"
    assert 0.0 < float(result.table("history")[-1]["time"]) < 1.0, "results up to the last good time are kept"
