"""What can go wrong with a call."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._messages import FaultMessage, Finding


class OverclosureError(Exception):
    """Base of everything that this package raises on its own account."""


class Unavailable(OverclosureError):
    """Nobody answers: the daemon is not running, has another id, or is being reconnected to."""


class Timeout(OverclosureError):
    """The daemon did not answer in time. It may still be working; repeating the call is safe."""


class TransportError(OverclosureError):
    """The connection failed, or bytes came that are no reply of ours."""


class IncludeError(OverclosureError):
    """A file that a deck includes cannot be put in its place."""


class Fault(OverclosureError):
    """The daemon refused.

    Attributes:
        code: what went wrong, for programs: ``unknown_session``, ``deck_refused``, ``not_finite``, ...
        message: the same for people.
        retryable: whether the same request may succeed later unchanged.
        findings: every diagnostic of a refused deck.
        sequence_expected: the sequence number that the session expects, when that was the trouble.
        limit: the limit that was reached, when that was the trouble.

    """

    def __init__(self, fault: FaultMessage) -> None:
        """Take over a fault message."""
        self.code: str = fault.code
        self.message: str = fault.message
        self.retryable: bool = fault.retryable
        self.findings: list[Finding] = fault.details.findings
        self.sequence_expected: int | None = fault.details.sequence_expected
        self.limit: int | None = fault.details.limit
        super().__init__(str(self))

    def __str__(self) -> str:
        """Code, message and all findings, one line each."""
        return "\n".join([f"{self.code}: {self.message}", *(str(f) for f in self.findings)])
