"""The pages of docs/laws: their figures show what the code computes, their commands run, their keywords are read."""

import csv
import importlib.util
import io
import re
import shlex

import pytest

import support

FOLDER = support.ROOT / "docs" / "laws"
PAGES = ["hard", "modified-hard", "linear", "tabular", "exponential", "no-separation", "damping"]
SECTIONS = ["Formula", "Parameters", "Keywords", "When to use it", "Availability", "Source"]
WORDS = ["documented", "restored from the text", "from memory of the manual", "from third-party notes", "our rule"]


def load():
    """docs/laws/plot.py as a module."""
    spec = importlib.util.spec_from_file_location("laws_plot", FOLDER / "plot.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


plot = load()


def page(name):
    """Text of a page."""
    return (FOLDER / f"{name}.md").read_text(encoding="utf-8")


def blocks(text, language):
    """Code blocks of a page in a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def numbers(text):
    """A figure's data: header, names, values."""
    header, *rows = csv.reader(io.StringIO(text))
    return header, [row[0] for row in rows], [(float(row[1]), float(row[2])) for row in rows]


@pytest.mark.parametrize("name", plot.FIGURES)
def test_the_data_of_a_figure_are_those_of_the_code(name):
    figure = plot.FIGURES[name]
    written = numbers((FOLDER / f"{name}.csv").read_text(encoding="utf-8"))
    computed = numbers(plot.data(figure, support.binary()))
    assert written[:2] == computed[:2]
    for column in (0, 1):
        largest = max(abs(values[column]) for values in computed[2])
        for old, new in zip(written[2], computed[2], strict=True):
            assert old[column] == pytest.approx(new[column], rel=1e-12, abs=1e-12 * largest), (name, old, new)


@pytest.mark.parametrize("name", plot.FIGURES)
def test_a_picture_is_drawn_from_the_data_beside_it(name):
    picture = (FOLDER / f"{name}.svg").read_text(encoding="utf-8")
    data = (FOLDER / f"{name}.csv").read_text(encoding="utf-8")
    assert f"data {plot.digest(data)}" in picture, "run docs/laws/plot.py"
    assert all(curve.name in picture for curve in plot.FIGURES[name].curves)


def test_every_figure_is_on_a_page_and_every_page_has_one():
    shown = {name: re.findall(r"!\[[^\]]+\]\(([\w-]+)\.svg\)", page(name)) for name in PAGES}
    assert all(shown.values())
    assert sorted(figure for figures in shown.values() for figure in figures) == sorted(plot.FIGURES)
    assert (
        {path.stem for path in FOLDER.glob("*.svg")}
        == {path.stem for path in FOLDER.glob("*.csv")}
        == set(plot.FIGURES)
    )


def test_every_page_is_listed_and_has_its_sections():
    listed = re.findall(r"^\| \[[^\]]+\]\(([\w-]+)\.md\)", page("README"), re.MULTILINE)
    assert listed == PAGES
    assert {path.stem for path in FOLDER.glob("*.md")} == {*PAGES, "README"}
    for name in PAGES:
        assert re.findall(r"^## (.*)$", page(name), re.MULTILINE) == SECTIONS, name
        assert any(word in page(name).split("## Source")[1].lower() for word in WORDS), name
        assert "../availability.md" in page(name), name
    assert all(f"| {word}" in page("README") for word in WORDS)


def commands():
    """Every `overclosure` command of the pages."""
    texts = [page(name) for name in [*PAGES, "README"]]
    return [line for text in texts for block in blocks(text, "sh") for line in block.splitlines() if line.strip()]


@pytest.mark.parametrize("command", commands())
def test_a_command_of_the_pages_runs(command):
    program, *arguments = shlex.split(command)
    assert program == "overclosure"
    done = support.call(*arguments)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) >= 3


def fragments():
    """Keywords of the pages: page, level, text."""
    found = []
    for name in PAGES:
        for level in ("inp", "inp step", "inp explicit"):
            found += [(name, level, text) for text in blocks(page(name), level)]
    return found


@pytest.mark.parametrize(("name", "level", "fragment"), fragments())
def test_keywords_of_the_pages_are_read(name, level, fragment, tmp_path):
    """In the place of those of examples/two_blocks.inp; what only Explicit has is refused with a reason."""
    deck = (support.ROOT / "examples" / "two_blocks.inp").read_text(encoding="utf-8")
    interaction = deck[deck.index("*SURFACE INTERACTION") : deck.index("*CONTACT PAIR")]
    if level == "inp step":
        hard = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n"
        if "PENETRATION TOLERANCE" in fragment:
            hard = "*SURFACE BEHAVIOR, AUGMENTED LAGRANGE\n"
        deck = deck.replace(interaction, "*SURFACE INTERACTION, NAME=SOFT\n" + hard)
        deck = deck.replace("*STATIC\n0.25, 1.\n", "*STATIC\n0.25, 1.\n" + fragment)
    else:
        deck = deck.replace(interaction, fragment)
    assert fragment in deck
    path = tmp_path / f"{name}.inp"
    path.write_text(deck, encoding="utf-8")
    done = support.call("check", path)
    if level == "inp explicit":
        assert done.returncode == 2 and "NO SEPARATION" in done.stderr
    else:
        assert done.returncode == 0, done.stderr


def test_the_decks_of_the_figures_are_the_ones_that_are_there():
    walks = {curve.deck for figure in plot.FIGURES.values() for curve in figure.curves if isinstance(curve, plot.Walk)}
    assert walks == {path.stem for path in (FOLDER / "decks").glob("*.inp")}


def test_the_numbers_in_the_text_are_right():
    """2.58197671 p0/c0 at touch, and what the modified hard point of the figure does."""
    done = support.call("law", "exponential", "--param", "c0=1", "--param", "p0=1", "--at=0")
    assert f"{float(done.stdout.splitlines()[1].split(',')[2]):.8f}" in page("exponential")
    _, _, path = numbers((FOLDER / "modified-hard.csv").read_text(encoding="utf-8"))
    open_overlap = [h for h, p in path if p == 0 and h > 0]
    tension = [p for _, p in path if p < 0]
    assert 0.0 < max(open_overlap) <= 0.02 and -3.0 <= min(tension) < 0.0
    assert all(abs(h) < 1e-15 for h, p in path if p != 0)
