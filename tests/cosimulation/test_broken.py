"""Deliberately broken FMUs: at least one checker must refuse each, or the checks above prove nothing."""

import shutil
import zipfile

import fmpy
import pytest
from fmpy.validation import validate_fmu

from cosimulation.test_archive import fmutool_complaints


def replaced(old, new):
    """A change of the description that must find its target."""

    def change(text):
        assert old in text, old
        return text.replace(old, new, 1)

    return change


DEFECTS = {
    "unknown unit": replaced('unit="Pa"', 'unit="furlong"'),
    "input without a start": replaced('<Real unit="m" start="0.0"/>', '<Real unit="m"/>'),
    "calculated output with a start": replaced(
        'initial="calculated">\n      <Real unit="Pa"/>', 'initial="calculated">\n      <Real unit="Pa" start="1.0"/>'
    ),
    "integer that claims to be continuous": replaced(
        'causality="output" variability="discrete"', 'causality="output" variability="continuous"'
    ),
    "output missing in the structure": replaced('<Unknown index="3" dependencies="1"/>', ""),
    "an input among the outputs": replaced(
        '<Unknown index="3" dependencies="1"/>', '<Unknown index="1" dependencies=""/>'
    ),
    "index beyond the variables": replaced(
        '<Unknown index="3" dependencies="1"/>', '<Unknown index="4711" dependencies="1"/>'
    ),
    "two variables of one name": replaced('name="closing_velocity"', 'name="overclosure"'),
    "parameter that changes continuously": replaced(
        'causality="parameter" variability="tunable"', 'causality="parameter" variability="continuous"'
    ),
    "elements in the wrong order": lambda text: text.replace("<LogCategories>", "<X>", 1).replace(
        "</LogCategories>", "</X>", 1
    ),
    "undeclared type": replaced('declaredType="LawKind"', 'declaredType="Nothing"'),
    "no closing tag": replaced("</fmiModelDescription>", ""),
    "name that structured naming does not allow": replaced('name="law.stiffness"', 'name="law stiffness"'),
}


def rewritten(source, target, change_description=None, drop=None):
    """A copy of an FMU with one thing changed."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for entry in old.infolist():
            data = old.read(entry)
            if entry.filename == "modelDescription.xml" and change_description:
                data = change_description(data.decode()).encode()
            if drop is None or not entry.filename.startswith(drop):
                new.writestr(entry, data)
    return target


@pytest.mark.parametrize("defect", DEFECTS)
def test_a_checker_refuses(law_file, tmp_path, defect):
    broken = rewritten(law_file, tmp_path / "broken.fmu", DEFECTS[defect])
    try:
        complaints = validate_fmu(str(broken))
    except Exception as error:  # a checker that gives up has refused
        complaints = [str(error)]
    assert complaints or fmutool_complaints(broken)


def test_an_unchanged_copy_is_accepted(law_file, tmp_path):
    copy = rewritten(law_file, tmp_path / "copy.fmu", lambda text: text)
    assert validate_fmu(str(copy)) == [] and fmutool_complaints(copy) == []


@pytest.mark.parametrize(
    ("what", "change", "drop"),
    [
        ("wrong GUID", replaced('guid="{', 'guid="{0'), None),
        ("library of another name", replaced('modelIdentifier="ContactLaw"', 'modelIdentifier="Other"'), None),
        ("no library", None, "binaries/"),
        ("no resources", None, "resources/"),
    ],
)
def test_an_importer_cannot_run_it(law_file, tmp_path, what, change, drop):
    broken = rewritten(law_file, tmp_path / "broken.fmu", change, drop)
    with pytest.raises(Exception):  # noqa: B017 — FMPy raises many kinds
        fmpy.simulate_fmu(str(broken))


def test_a_damaged_options_file_is_named(law_fmu, tmp_path):
    from cosimulation.raw import Instance

    moved = law_fmu.copied_to(tmp_path / "tree")
    for text in ("", "{", '{"format": 99, "guid": "x", "content": {"kind": "law"}}', '{"format": 1}'):
        (moved.folder / "resources" / "options.json").write_text(text)
        instance = Instance(moved)
        assert not instance.instantiate()
        assert "options.json" in instance.errors()[0]
    shutil.rmtree(moved.folder / "resources")
    instance = Instance(moved)
    assert not instance.instantiate()
    assert "options.json" in instance.errors()[0]
