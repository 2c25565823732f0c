"""Deck text as cards: a keyword line and its data lines."""

from dataclasses import dataclass, field


@dataclass
class Card:
    """`*KEYWORD, NAME=VALUE, ...` with its data lines, each a list of words. Names are in upper case."""

    keyword: str
    parameters: dict[str, str] = field(default_factory=dict)
    data: list[list[str]] = field(default_factory=list)

    def lines(self):
        """Text of the card."""
        words = [self.keyword, *(f"{name}={value}" if value else name for name, value in self.parameters.items())]
        return [", ".join(words), *(", ".join(line) for line in self.data)]


def parse(text):
    """Cards of a deck without comments. Keyword lines on one line; data lines that end with a comma stay as they are."""
    cards = []
    for line in text.splitlines():
        if line.startswith("**") or not (line.strip() or cards):
            continue
        words = [word.strip() for word in line.split(",")]
        if line.startswith("*"):
            pairs = (word.partition("=") for word in words[1:])
            cards.append(Card(words[0].upper(), {name.strip().upper(): value.strip() for name, _, value in pairs}))
        else:
            cards[-1].data.append(words)
    return cards


def text(cards):
    """Deck text of cards."""
    return "\n".join(line for card in cards for line in card.lines()) + "\n"


class Sets:
    """Node labels, coordinates, node sets and types of element sets of a deck."""

    def __init__(self, cards):
        self.coordinates, self.nodes, self.types = {}, {}, {}
        for card in cards:
            if card.keyword == "*NODE":
                labels = [int(line[0]) for line in card.data]
                for label, line in zip(labels, card.data, strict=True):
                    self.coordinates[label] = [float(x) for x in line[1:4]]
                if "NSET" in card.parameters:
                    self.nodes.setdefault(card.parameters["NSET"].upper(), []).extend(labels)
            elif card.keyword == "*NSET":
                found = self.members(card)
                self.nodes.setdefault(card.parameters["NSET"].upper(), []).extend(found)
            elif card.keyword == "*ELEMENT" and "ELSET" in card.parameters:
                self.types[card.parameters["ELSET"].upper()] = card.parameters["TYPE"].upper()

    def members(self, card):
        """Node labels of an `*NSET` card."""
        if "GENERATE" in card.parameters:
            ranges = [[int(word) for word in line if word] for line in card.data]
            return [n for line in ranges for n in range(line[0], line[1] + 1, line[2] if len(line) > 2 else 1)]
        words = [word for line in card.data for word in line if word]
        return [n for word in words for n in self.of(word)]

    def of(self, region):
        """Node labels of a region: a number or the name of a set."""
        return [int(region)] if region.isdigit() else self.nodes[region.upper()]
