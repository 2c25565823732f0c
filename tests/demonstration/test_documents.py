"""What the documents say works: snippets of the README run, examples run, links lead somewhere, tables match the code."""

import os
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
    *support.ROOT.glob("docs/laws/*.md"),
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


@pytest.fixture
def checkout(tmp_path):
    """A folder that looks like the checkout to the commands of the README, so that what they write goes elsewhere."""
    library = support.binary().with_name("liboverclosure_fmu.so")
    (tmp_path / "examples").symlink_to(support.ROOT / "examples")
    (tmp_path / "target" / "release").mkdir(parents=True)
    for file in (support.binary(), library):
        (tmp_path / "target" / "release" / file.name).symlink_to(file)
    interpreter = tmp_path / ".venv" / "bin" / "python"
    interpreter.parent.mkdir(parents=True)
    interpreter.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n', encoding="utf-8")
    interpreter.chmod(0o755)
    return tmp_path


def shell(command, folder):
    """Runs a line of the README as it stands; `overclosure` is found as the README says. Returns standard output."""
    path = f"{folder / 'target' / 'release'}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        command,
        shell=True,
        capture_output=True,
        text=True,
        timeout=120,
        cwd=folder,
        check=False,
        env={**os.environ, "PATH": path, "HOME": str(folder / "home")},
    )
    assert done.returncode == 0, f"{command}\n{done.stderr}"
    return done.stdout


def lines(*beginnings):
    """Lines of the README's shell blocks that begin so."""
    return [line for block in blocks("sh") for line in block.splitlines() if line.startswith(beginnings)]


def test_the_deck_commands_of_the_readme_run(checkout):
    solve, show = lines("target/", "cat ")
    shell(solve, checkout)
    assert "CPRESS" in shell(show, checkout)
    generate = lines("python3 examples/generate_deck.py")
    assert len(generate) == 2
    for command in generate:
        shell(command, checkout)
    decks = sorted((checkout / "out").glob("*.inp"))
    assert len(decks) == 2
    for deck in decks:
        assert "warning" not in support.call("check", deck).stderr.replace("0 warnings", "")
    left = {path.name for path in checkout.iterdir()}
    assert left == {"examples", "target", ".venv", "out"}, (
        "what a newcomer tries is written into out/, which is ignored"
    )


def test_every_verb_of_the_readme_exists():
    verbs = set(re.findall(r"^overclosure (\w+)", "\n".join(blocks("text") + blocks("sh")), re.MULTILINE))
    assert {"run", "check", "law", "pack", "serve", "sessions"} <= verbs
    for verb in verbs:
        assert support.call("help", verb).returncode == 0, verb


def test_the_fmu_commands_of_the_readme_run(checkout):
    (checkout / "out").mkdir()
    pack, simulate = lines("overclosure pack", ".venv/bin/python -m fmpy")
    shell(pack, checkout)
    shell(simulate, checkout)
    (table,) = (checkout / "out").glob("*.csv")
    assert "contact.SSL_SMA.CFN3" in table.read_text(encoding="utf-8").splitlines()[0]


def test_the_install_commands_of_the_readme_install_a_packer(checkout):
    commands = lines("install -D")
    assert len(commands) == 2
    for command in commands:
        shell(command, checkout)
    for file in (checkout / "target" / "release").iterdir():
        file.unlink()
    (checkout / "out").mkdir()
    (pack,) = lines("overclosure pack")
    shell(f"home/.local/bin/{pack}", checkout)


def test_the_fmpy_snippet_shows_that_an_array_acts_one_step_late(checkout):
    (checkout / "out").mkdir()
    (pack,) = lines("overclosure pack")
    shell(pack, checkout)
    (snippet,) = re.findall(r"```python\n(.*?)```", (support.ROOT / "docs" / "fmu.md").read_text(), re.DOTALL)
    (checkout / "snippet.py").write_text(snippet, encoding="utf-8")
    rows = [line.split() for line in shell(".venv/bin/python snippet.py", checkout).splitlines()]
    assert [float(row[0]) for row in rows] == [0.0, 0.25, 0.5, 0.75, 1.0]
    for _, mine, masters in rows:
        assert float(masters) == pytest.approx(float(mine), rel=1e-9, abs=1e-12)
    assert float(rows[-1][1]) > 1.0


def test_the_law_command_of_the_readme_runs(checkout):
    (command,) = lines("overclosure law")
    assert len(shell(command, checkout).splitlines()) == 10


def test_port_declarations_are_taken_alike_and_told(tmp_path):
    """The example of docs/ports.md, beside a deck; the file of the deck goes before that of the folder."""
    (example,) = re.findall(r"```toml\n(.*?)```", (support.ROOT / "docs" / "ports.md").read_text(), re.DOTALL)
    deck = tmp_path / "blocks.inp"
    deck.write_text((support.ROOT / "examples" / "two_blocks.inp").read_text())
    (tmp_path / "ports.toml").write_text('[[port]]\nport = "boundary.OTHER.3"\n')
    verbs = (["check", deck], ["run", deck, "--out", tmp_path], ["pack", deck, "-o", tmp_path / "x.fmu"])
    for verb in verbs:
        done = support.call(*verb)
        assert done.returncode == 2 and "boundary.OTHER.3" in done.stderr, verb
        assert str(tmp_path / "ports.toml") in done.stderr
    (tmp_path / "blocks.ports.toml").write_text(example)
    for verb in verbs:
        done = support.call(*verb)
        assert done.returncode == 0 and str(tmp_path / "blocks.ports.toml") in done.stderr, verb
        if verb[0] == "check":
            assert "punch_depth" in done.stdout and "contact_force" in done.stdout
            assert "CAREA" not in done.stdout
    header = (tmp_path / "blocks_ports.csv").read_text().splitlines()[0]
    assert header == "step,increment,time,contact_force"


@pytest.mark.parametrize("declared", [False, True])
def test_check_lists_the_ports_of_a_run_and_prepares_nothing(tmp_path, declared):
    deck = tmp_path / "blocks.inp"
    deck.write_text((support.ROOT / "examples" / "two_blocks.inp").read_text())
    if declared:
        (tmp_path / "ports.toml").write_text('[[port]]\nport = "contact.SSL_SMA.CFN3"\nname = "force"\nunit = "N"\n')
    environment = {**os.environ, "OVERCLOSURE_LOG": "overclosure=debug"}
    checked = support.call("check", deck, env=environment)
    ran = support.call("run", deck, "--out", tmp_path, env=environment)
    assert (checked.returncode, ran.returncode) == (0, 0), (checked.stderr, ran.stderr)
    assert "factor" in ran.stderr and "factor" not in checked.stderr
    listed = re.findall(r"^(input|output) +(\S+): ", checked.stdout, re.MULTILINE)
    header = (tmp_path / "blocks_ports.csv").read_text().splitlines()[0].split(",")
    assert [name for kind, name in listed if kind == "output"] == header[3:]
    assert [name for kind, name in listed if kind == "input"] == ["boundary.NTOP.3"]
    assert ("force" in header) == declared


def test_a_session_takes_the_declarations_beside_the_deck(tmp_path, endpoint):
    deck = tmp_path / "blocks.inp"
    deck.write_text((support.ROOT / "examples" / "two_blocks.inp").read_text())
    (tmp_path / "ports.toml").write_text('[[port]]\nport = "boundary.NTOP.3"\nname = "punch_depth"\n')
    opened = support.call("sessions", "--connect", endpoint, "--open", deck)
    assert opened.returncode == 0 and "ports.toml" in opened.stderr, opened.stderr
    session = opened.stdout.strip()
    assert "punch_depth" in support.call("get", "--connect", endpoint, session).stdout
    assert support.call("sessions", "--connect", endpoint, "--close", session).returncode == 0


def test_a_deck_without_inputs_is_told_what_becomes_one(tmp_path):
    deck = tmp_path / "still.inp"
    text = (support.ROOT / "examples" / "two_blocks.inp").read_text()
    deck.write_text(text.replace("NTOP, 3, 3, -0.02", "NTOP, 3, 3"))
    assert "not zero" in support.call("check", deck).stdout
    assert "not zero" in support.call("pack", deck, "-o", tmp_path / "x.fmu").stderr


def test_an_fmu_that_cannot_be_written_is_named_once(tmp_path):
    target = tmp_path / "nowhere" / "x.fmu"
    done = support.call("pack", support.ROOT / "examples" / "two_blocks.inp", "-o", target)
    assert done.returncode == 1 and done.stderr.count("nowhere") == 1 and ".packing" not in done.stderr, done.stderr


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
            generate_deck.generate([kind, 4, deck, "--law", law, *shape])
            assert support.run(deck, tmp_path).summary()["outcome"] == "completed"


def test_dimensions_of_the_other_deck_are_refused(tmp_path, capsys):
    with pytest.raises(SystemExit):
        generate_deck.generate(["punch", 4, tmp_path / "x.inp", "--radius", 3])
    assert "punch deck has no" in capsys.readouterr().err


@pytest.mark.parametrize("table", ["1,2", "1:2:3", "a:b", ""])
def test_a_table_without_pairs_is_refused(tmp_path, capsys, table):
    with pytest.raises(SystemExit):
        generate_deck.generate(["punch", 4, tmp_path / "x.inp", "--law", "tabular", "--table", table])
    assert "p1:h1" in capsys.readouterr().err


def test_a_deck_that_cannot_be_written_is_refused(tmp_path, capsys):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(SystemExit):
        generate_deck.generate(["punch", 4, tmp_path / "file" / "x.inp"])
    assert "cannot write" in capsys.readouterr().err
