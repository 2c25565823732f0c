"""Reading a deck from files.

Over the wire a deck has no folder: the files it includes are put in their places, and the port declarations beside it
are sent along.
"""

from __future__ import annotations

import logging
from pathlib import Path

from ._errors import IncludeError

_LOG = logging.getLogger("overclosure")
# The limits of the daemon's own reader.
_DEPTH_MAX = 16
_INCLUDES_MAX = 10_000


def read_deck(path: Path) -> str:
    """Read a deck and everything that it includes.

    Names in ``*INCLUDE, INPUT=name`` are relative to the folder of the including file. Bytes that are not UTF-8 (old
    comments) become replacement characters. A deck that includes nothing keeps its text as it is.

    Raises:
        OSError: the deck cannot be read.
        IncludeError: an included file cannot be read, is missing its name, or includes itself.

    """
    return _Reader().read(path, path.read_bytes())


def read_ports(deck: Path) -> str | None:
    """Read the port declarations that apply to a deck unless others are given.

    As for the command line: ``DECKNAME.ports.toml``, else ``ports.toml``, both beside the deck; none where neither is
    there.

    Raises:
        OSError: the file is there and cannot be read.

    """
    for path in (deck.with_suffix(".ports.toml"), deck.with_name("ports.toml")):
        if path.is_file():
            _LOG.info("ports: names and units from %s", path)
            return path.read_text(encoding="utf-8")
    return None


class _Reader:
    def __init__(self) -> None:
        self.open: list[Path] = []
        self.files = 0

    def read(self, path: Path, data: bytes) -> str:
        self.open.append(path.resolve())
        text = data.decode("utf-8", "replace").removeprefix("\ufeff")
        # Not splitlines, which also splits where the daemon does not.
        lines = text.split("\n")
        out = []
        at = 0
        while at < len(lines):
            card, number = lines[at], at + 1
            at += 1
            if not _is_include(card):
                out.append(card)
                continue
            while card.rstrip().endswith(",") and at < len(lines):
                card += lines[at]
                at += 1
            out.append(self.include(path, number, _input_of(card)))
        self.open.pop()
        return "\n".join(out)

    def include(self, path: Path, number: int, name: str) -> str:
        place = f"{path}, line {number}"
        if not name:
            raise IncludeError(f"{place}: *INCLUDE names no file; write *INCLUDE, INPUT=file")
        target = path.parent / name
        self.files += 1
        if target.resolve() in self.open:
            raise IncludeError(f"{place}: {target} is being included already")
        if len(self.open) > _DEPTH_MAX:
            raise IncludeError(f"{place}: *INCLUDE is nested more than {_DEPTH_MAX} deep")
        if self.files > _INCLUDES_MAX:
            raise IncludeError(f"{place}: more than {_INCLUDES_MAX} files are included")
        try:
            data = target.read_bytes()
        except OSError as error:
            raise IncludeError(f"{place}: cannot read {target}: {error.strerror or error}") from error
        return self.read(target, data).removesuffix("\n")


def _is_include(line: str) -> bool:
    keyword = line.lstrip().split(",", 1)[0]
    return keyword.startswith("*") and keyword[1:].strip().upper() == "INCLUDE"


def _input_of(card: str) -> str:
    for parameter in card.split(",")[1:]:
        name, _, value = parameter.partition("=")
        if name.strip().upper() == "INPUT":
            return value.strip().strip('"').strip()
    return ""
