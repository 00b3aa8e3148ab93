"""Values of settings and parameters, as the compiled half of the package takes them."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import SupportsFloat, Union

from toile._errors import UsageError

#: What a setting may be: a number, a truth value, a text as ``--set`` takes it (``"6 mm"``,
#: ``"Otsu(bias: 3)"``), a path, or a list of texts or numbers.
Setting = Union[
    bool, int, float, str, "os.PathLike[str]", SupportsFloat, Sequence[Union[str, int, float]]
]


def _plain(value: object) -> object:
    """A value that JSON has no form for: a path, or a number of numpy."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    item = getattr(value, "item", None)
    if callable(item):
        return item()
    raise TypeError


def as_json(settings: Mapping[str, Setting]) -> list[tuple[str, str]]:
    """Paths with their values as JSON."""
    pairs = []
    for path, value in settings.items():
        try:
            pairs.append((str(path), json.dumps(value, default=_plain, allow_nan=False)))
        except (TypeError, ValueError, RecursionError):
            kind = type(value).__name__
            raise UsageError(
                f'the value of "{path}" is of type {kind}, which no setting has',
                help="give a number, true or false, a text as --set takes it, or a list of them",
            ) from None
    return pairs
