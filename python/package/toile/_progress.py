"""How a run goes on, in terminals and notebooks."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from importlib import import_module
from typing import Any, Protocol, Union

#: Called with the stage, the panel or photo at work (empty where there is none), the share of the
#: stage that is done, from 0 to 1, and what it is doing.
ProgressCallback = Callable[[str, str, float, str], object]

#: ``True`` shows a bar, ``False`` none; ``None`` shows one in terminals and notebooks.
Progress = Union[bool, ProgressCallback, None]


class _Bar(Protocol):
    def __call__(self, stage: str, panel: str, share: float, text: str) -> object: ...

    def close(self) -> None: ...


class _TqdmBar:
    """A bar of tqdm for the stage at work."""

    def __init__(self, tqdm: Any) -> None:
        self._bar = tqdm(
            total=1.0,
            leave=False,
            bar_format="{elapsed} {desc} |{bar}| {postfix}",
        )

    def __call__(self, stage: str, panel: str, share: float, text: str) -> None:
        self._bar.set_description_str(f"{stage} ({panel})" if panel else stage, refresh=False)
        self._bar.set_postfix_str(text, refresh=False)
        self._bar.n = share
        self._bar.refresh()

    def close(self) -> None:
        self._bar.close()


class _Line:
    """A line on standard error that is written over."""

    _WIDTH = 78

    def __init__(self) -> None:
        self._start = time.monotonic()

    def __call__(self, stage: str, panel: str, share: float, text: str) -> None:
        who = f"{stage} ({panel})" if panel else stage
        done = "=" * round(20 * share)
        line = f"{time.monotonic() - self._start:4.0f} s [{done:<20}] {who}: {text}"
        sys.stderr.write("\r" + line[: self._WIDTH].ljust(self._WIDTH))
        sys.stderr.flush()

    def close(self) -> None:
        sys.stderr.write("\r" + " " * self._WIDTH + "\r")
        sys.stderr.flush()


def _in_notebook() -> bool:
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return type(shell).__name__ == "ZMQInteractiveShell"


def _is_seen() -> bool:
    return sys.stderr is not None and (sys.stderr.isatty() or _in_notebook())


class shown:
    """The callback of a run, and the bar behind it, which is gone at the end."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._bar: _Bar | None = None

    def __enter__(self) -> ProgressCallback | None:
        if callable(self._progress):
            return self._progress
        if self._progress is False or (self._progress is None and not _is_seen()):
            return None
        try:
            self._bar = _TqdmBar(import_module("tqdm.auto").tqdm)
        except ImportError:
            self._bar = _Line()
        return self._bar

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
