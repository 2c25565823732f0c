"""Reads an ASCII results file by the rules of the manual; shares nothing with the program that wrote it.

A file is a stream of characters in lines of 80. A record begins with `*`; its first word says how many words it has, itself
included, the second is its key. A word is `I`, two columns with a number of digits, and the digits; `D` and 22 columns; or `A` and 8.
"""

from dataclasses import dataclass

WIDTH = 80
WORDS_MAX = 80


class FormError(ValueError):
    """The file breaks a rule of the format."""


@dataclass
class Record:
    """Key and attributes of a record: int, float or str of eight characters; how each real number was written."""

    key: int
    attributes: list
    written: list

    @property
    def reals(self):
        return [value for value in self.attributes if isinstance(value, float)]


def real(text):
    """A number in Fortran's form; exponents of three digits have no letter."""
    if "D" not in text:
        text = text[:-4] + "D" + text[-4:]
    mantissa, _, exponent = text.partition("D")
    if len(mantissa.strip().lstrip("-")) != 17 or mantissa.strip().lstrip("-")[1] != ".":
        raise FormError(f"{text!r} has not 16 digits")
    return float(f"{mantissa}e{exponent}")


class Stream:
    """The characters of the file, read word by word."""

    def __init__(self, text):
        lines = text.split("\n")
        if lines.pop() != "":
            raise FormError("the last line is not ended")
        for number, line in enumerate(lines, 1):
            if len(line) != WIDTH:
                raise FormError(f"line {number} has {len(line)} characters")
        self.text = "".join(lines)
        self.at = 0

    def take(self, count):
        piece = self.text[self.at : self.at + count]
        if len(piece) != count:
            raise FormError("the file ends within a word")
        self.at += count
        return piece

    def word(self):
        """Value and text of the next word."""
        kind = self.take(1)
        if kind == "I":
            digits = self.take(int(self.take(2)))
            if not digits.lstrip("-").isdigit():
                raise FormError(f"{digits!r} is no whole number")
            return int(digits), digits
        if kind == "D":
            text = self.take(22)
            return real(text), text
        if kind == "A":
            text = self.take(8)
            return text, text
        raise FormError(f"a word cannot begin with {kind!r} (character {self.at})")

    def record(self):
        if self.take(1) != "*":
            raise FormError(f"no record begins at character {self.at}")
        length, _ = self.word()
        if not 2 <= length <= WORDS_MAX:
            raise FormError(f"a record of {length} words")
        key, _ = self.word()
        words = [self.word() for _ in range(length - 2)]
        return Record(key, [value for value, _ in words], [text for _, text in words])

    def skip_blanks(self):
        """The rest of the line of record 2001, and a line of blanks."""
        rest = -self.at % WIDTH
        if self.take(rest).strip() or self.take(WIDTH).strip():
            raise FormError("record 2001 is not followed by blanks")


def read(path):
    """Records of the head, and lists of records, one per increment, without the records 2001 that end them."""
    stream = Stream(path.read_text(encoding="ascii"))
    blocks, block = [], []
    while stream.at < len(stream.text):
        record = stream.record()
        if record.key != 2001:
            block.append(record)
            continue
        stream.skip_blanks()
        blocks.append(block)
        block = []
    if block:
        raise FormError("the last increment is not ended")
    return blocks[0], blocks[1:]


def labels(head):
    """Names behind the numbers that stand for long ones."""
    return {record.attributes[0]: "".join(record.attributes[1:]).rstrip() for record in head if record.key == 1940}


def name(word, names):
    """The name that a word stands for."""
    return names[int(word)] if word.strip().isdigit() and int(word) in names else word.rstrip()


def sets(head, first, following):
    """Sets by name: records of a key, continued by those of another."""
    names, found, current = labels(head), {}, None
    for record in head:
        if record.key == first:
            current = found.setdefault(name(record.attributes[0], names), [])
            current.extend(record.attributes[1:])
        elif record.key == following:
            current.extend(record.attributes)
    return found


def contact(records, names):
    """Contact requests of an increment: surfaces, node set, values by node and key, totals by key."""
    requests = []
    for record in records:
        if record.key == 1503:
            secondary, primary, nodes = (name(word, names) for word in record.attributes[1:])
            requests.append({"pair": (secondary, primary), "set": nodes, "nodes": {}, "totals": {}})
            node = None
        elif record.key == 1504:
            node = record.attributes[0]
            requests[-1]["nodes"][node] = {}
        elif record.key in (1511, 1512, 1521):
            requests[-1]["nodes"][node][record.key] = record.written
        elif 1522 <= record.key <= 1578:
            requests[-1]["totals"][record.key] = record.written
    return requests
