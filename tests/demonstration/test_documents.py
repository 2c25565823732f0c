"""What the documents say works: snippets of the README run, examples run, links lead somewhere, tables match the code."""

import re
import subprocess
import sys

import pytest

import demo
import generate_deck
import support

README = (support.ROOT / "README.md").read_text(encoding="utf-8")
DOCUMENTS = [
    *support.ROOT.glob("*.md"),
    *support.ROOT.glob("docs/*.md"),
    *support.ROOT.glob("*/README.md"),
    *support.ROOT.glob("clients/*/README.md"),
]


def blocks(language):
    """Code blocks of the README in a language."""
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


def python(*arguments, **options):
    """Runs this interpreter in the checkout; output as text."""
    command = [sys.executable, *map(str, arguments)]
    return subprocess.run(
        command, capture_output=True, text=True, timeout=120, cwd=support.ROOT, check=False, **options
    )


@pytest.fixture(scope="module")
def endpoint(tmp_path_factory):
    """A daemon of our own."""
    with demo.running_daemon(tmp_path_factory.mktemp("daemon")) as found:
        yield found


def test_the_python_snippet_of_the_readme_runs(endpoint):
    (snippet,) = blocks("python")
    assert "tcp/127.0.0.1:7447" in snippet
    done = python("-c", snippet.replace("tcp/127.0.0.1:7447", endpoint))
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert [float(line.split()[0]) for line in lines[:4]] == [0.25, 0.5, 0.75, 1.0]
    forces = [float(line.split()[1]) for line in lines[:4]]
    assert forces == sorted(forces) and forces[0] > 0.0


def test_the_session_example_runs(endpoint):
    done = python("examples/session.py", "--endpoint", endpoint)
    assert done.returncode == 0, done.stderr
    assert "back at time 0.0" in done.stdout
    assert done.stdout.count("CPRESS") == 4


def test_the_deck_commands_of_the_readme_run(tmp_path):
    commands = re.findall(r"python3 (examples/generate_deck\.py .*)", README)
    assert len(commands) == 2
    for command in commands:
        script, kind, size, deck, *options = command.split()
        done = python(script, kind, size, tmp_path / deck, *options)
        assert done.returncode == 0, done.stderr
        assert support.call("check", tmp_path / deck).returncode == 0


def test_every_verb_of_the_readme_exists():
    verbs = set(re.findall(r"^overclosure (\w+)", "\n".join(blocks("text") + blocks("sh")), re.MULTILINE))
    assert {"run", "check", "law", "pack", "serve", "sessions"} <= verbs
    for verb in verbs:
        assert support.call("help", verb).returncode == 0, verb


def test_the_fmu_commands_of_the_readme_run(tmp_path):
    (command,) = re.findall(r"^overclosure pack (examples/\S+) -o (\S+)$", README, re.MULTILINE)
    fmu = tmp_path / command[1]
    done = support.call("pack", support.ROOT / command[0], "-o", fmu)
    assert done.returncode == 0, done.stderr
    assert f"-m fmpy simulate {command[1]} --show-plot" in README
    done = python("-m", "fmpy", "simulate", fmu, "--output-file", tmp_path / "result.csv")
    assert done.returncode == 0, done.stderr
    header = (tmp_path / "result.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "contact.SSL_SMA.CFN3" in header


def test_the_law_command_of_the_readme_runs():
    (command,) = re.findall(r"^overclosure (law exp.*)$", README, re.MULTILINE)
    done = support.call(*command.split())
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == 10


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda p: str(p.relative_to(support.ROOT)))
def test_links_between_documents_lead_somewhere(document):
    for target in re.findall(r"\]\(([^)#\s]+)\)", document.read_text(encoding="utf-8")):
        if "://" not in target:
            assert (document.parent / target).exists(), f"{document}: {target}"


def test_generated_decks_of_every_law_and_shape_are_accepted(tmp_path):
    shapes = {
        "punch": ["--width", 2, "--height", 1, "--foundation-width", 5, "--foundation-height", 2, "--young", 1e3, 2e3],
        "hertz": ["--radius", 4, "--thickness", 1, "--block-width", 5, "--block-height", 3, "--poisson", 0.2],
    }
    for kind, shape in shapes.items():
        for law in generate_deck.LAWS:
            deck = tmp_path / f"{kind}-{law}.inp"
            generate_deck.generate([kind, 4, deck, "--law", law, "--small-sliding", *shape])
            assert support.run(deck, tmp_path).summary()["outcome"] == "completed"


def test_dimensions_of_the_other_deck_are_refused(tmp_path, capsys):
    with pytest.raises(SystemExit):
        generate_deck.generate(["punch", 4, tmp_path / "x.inp", "--radius", 3])
    assert "punch deck has no" in capsys.readouterr().err
