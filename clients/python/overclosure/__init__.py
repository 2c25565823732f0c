"""Client of the overclosure contact mechanics daemon."""

from ._client import Client, connect
from ._errors import Fault, IncludeError, OverclosureError, Timeout, TransportError, Unavailable
from ._messages import Counts, Finding, Health, Info, Limits, Load, Port, Report, SessionSummary, StepSummary
from ._postcard import DecodeError
from ._session import Field, Frame, Frames, Session, Step
from ._values import LawCurve

__all__ = [
    "Client",
    "Counts",
    "DecodeError",
    "Fault",
    "Field",
    "Finding",
    "Frame",
    "Frames",
    "Health",
    "IncludeError",
    "Info",
    "LawCurve",
    "Limits",
    "Load",
    "OverclosureError",
    "Port",
    "Report",
    "Session",
    "SessionSummary",
    "Step",
    "StepSummary",
    "Timeout",
    "TransportError",
    "Unavailable",
    "connect",
]
__version__ = "0.1.0"
