"""Errors: one class for each exit code of the command."""

from __future__ import annotations

import json
from typing import TypedDict


class Fault(TypedDict):
    """One fault of a pipeline file."""

    file: str
    line: int
    column: int
    code: str
    message: str
    hint: str | None


class Error(Exception):
    """What went wrong, as the command tells it.

    An error that a stage in Python raises is told the same way as one of a built-in stage:
    ``raise toile.InvalidInputError("the photo shows no garment", help="use a plain ground")``.
    """

    #: The exit code of the command for this class.
    exit_code: int = 70
    #: The code of an error of this class that is raised without one.
    _usual_code: str = "internal"

    #: One sentence in lower case, without a full stop.
    message: str
    #: A stable word that programs can match: ``unknown_stage``, ``stitching_error``, ...
    code: str
    #: What the user may do about it.
    help: str | None
    #: Where it is: ``vest.ron:12:5``, or the setting at fault.
    place: str | None
    #: The id of the stage that failed; empty where none did.
    stage: str
    #: The panel or photo at work; empty where the stage works on none alone.
    panel: str
    #: What lies behind it: forces, counts, a traceback.
    detail: str | None
    #: All faults of the pipeline file, the first of which the error itself tells.
    faults: list[Fault]

    def __init__(
        self,
        message: str,
        *,
        help: str | None = None,
        code: str | None = None,
        place: str | None = None,
        stage: str = "",
        panel: str = "",
        detail: str | None = None,
        faults: list[Fault] | None = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.code = self._usual_code if code is None else code
        self.help = help
        self.place = place
        self.stage = stage
        self.panel = panel
        self.detail = detail
        self.faults = [] if faults is None else faults

    def __str__(self) -> str:
        place = "" if self.place is None else f"{self.place}: "
        text = f"{place}{self.message}"
        if self.help is not None:
            text += f"\n  help: {self.help}"
        more = len(self.faults) - 1
        if more > 0:
            faults = "fault" if more == 1 else "faults"
            text += f"\n  and {more} more {faults}: see `faults`"
        return text


class UsageError(Error, ValueError):
    """A function is called with arguments that cannot be (exit code 2)."""

    exit_code = 2
    _usual_code = "usage"


class InvalidInputError(Error):
    """The pipeline, a file that it names or what is given is at fault (exit code 3)."""

    exit_code = 3
    _usual_code = "invalid_input"


class QualityError(Error):
    """No result keeps the quality limits: a seam stays open, the cloth does not rest (exit code 4)."""

    exit_code = 4
    _usual_code = "static_equilibrium"


class StoppedError(Error):
    """Out of time, or stopped (exit code 5)."""

    exit_code = 5
    _usual_code = "cancelled"


class InternalError(Error):
    """A bug of the program, of a plugin or of a stage in Python (exit code 70)."""

    exit_code = 70
    _usual_code = "internal"


_CLASSES: dict[int, type[Error]] = {
    kind.exit_code: kind
    for kind in (UsageError, InvalidInputError, QualityError, StoppedError, InternalError)
}


def of_exit_code(exit_code: int) -> type[Error]:
    """The class of an exit code."""
    return _CLASSES.get(exit_code, InternalError)


def raised(
    *,
    code: str,
    exit_code: int,
    message: str,
    help: str | None,
    place: str | None,
    stage: str,
    panel: str,
    detail: str | None,
    faults: str,
) -> Error:
    """An error as the compiled half of the package tells it; ``faults`` is JSON."""
    return of_exit_code(exit_code)(
        message,
        help=help,
        code=code,
        place=place,
        stage=stage,
        panel=panel,
        detail=detail,
        faults=json.loads(faults),
    )
