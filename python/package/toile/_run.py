"""A pipeline, run."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from toile import _toile
from toile._progress import Progress, shown
from toile._toile import Artifact, Body, Garment, Photo
from toile._values import Setting, as_json

if TYPE_CHECKING:
    import numpy.typing as npt

_Path = Union[str, "os.PathLike[str]"]

#: How the turntable of a run that writes none is made, for ``_repr_html_``.
_TURNTABLE = {"views": 16, "tiers": 1, "size": 480, "page": 600}


class Run:
    """What a run gave."""

    def __init__(self, parts: _toile.RunParts) -> None:
        self._parts = parts

    @cached_property
    def garment(self) -> Garment:
        """The last garment that the run made.

        Raises ``AttributeError`` for a run that makes none, as one that stops before.
        """
        garment = self._parts.garment
        if garment is None:
            raise AttributeError("the run made no garment")
        return garment

    @cached_property
    def model(self) -> Artifact | None:
        """The last textured model; ``None`` for a run that makes none."""
        return self._parts.model

    @cached_property
    def artifacts(self) -> dict[str, Any]:
        """What the stages made, by their ids: an artifact, of a named set a dictionary, of several
        outputs a tuple.

        A stage of which a part is in the cache only is left out; ``cache=False`` and ``until``
        bring it.
        """
        return self._parts.artifacts

    @cached_property
    def files(self) -> dict[str, bytes]:
        """The files of the writers, as ``garment.glb``, with ``metrics.json``."""
        return {**self._parts.files, "metrics.json": self._parts.metrics.encode()}

    @cached_property
    def metrics(self) -> dict[str, Any]:
        """The figures of the run, in SI units, as ``metrics.json`` has them."""
        metrics: dict[str, Any] = json.loads(self._parts.metrics)
        return metrics

    @property
    def shortfalls(self) -> list[tuple[str, str]]:
        """The limits of quality that the garment misses: codes and sentences. Empty where it is
        good."""
        return [(code, message) for code, message in self.metrics["shortfalls"]]

    @property
    def warnings(self) -> list[str]:
        """What to look at: warnings about the pipeline, then those of the stages."""
        return self._parts.warnings + self._remarks("warnings")

    @property
    def notes(self) -> list[str]:
        """What the stages decided, each with the fact behind it."""
        return self._remarks("notes")

    def _remarks(self, level: str) -> list[str]:
        stages = self.metrics["stages"]
        return [f"{stage['id']}: {text}" for stage in stages for text in stage.get(level, [])]

    def save(self, folder: _Path) -> list[Path]:
        """Writes the files below a folder, all or none; gives their paths."""
        return [Path(path) for path in _toile.write(folder, list(self.files.items()))]

    def to_trimesh(self) -> Any:
        """The garment as a ``trimesh.Trimesh``, in metres."""
        return self.garment.to_trimesh()

    @cached_property
    def _turntable(self) -> str | None:
        """A page that shows the garment from all sides."""
        pages = [data for path, data in self.files.items() if path.endswith("turntable.html")]
        if not pages and self.model is not None:
            made = _toile.StageAlone("Turntable", as_json(_TURNTABLE))(self.model)
            pages = list(made.values())
        return pages[0].decode() if pages else None

    def _repr_html_(self) -> str:
        page = self._turntable
        if page is None:
            return f"<pre>{html.escape(repr(self))}</pre>"
        style = "width:100%;max-width:560px;height:640px;border:0"
        return f'<iframe srcdoc="{html.escape(page)}" style="{style}"></iframe>'

    def __repr__(self) -> str:
        figures = self.metrics["garment"]
        name = self.metrics["pipeline"]
        if figures is None:
            return f"<toile run of {name}: no garment, {len(self.files)} files>"
        gap = 1e3 * figures["seam_gap_max_m"]
        return f"<toile run of {name}: {figures['triangles']} triangles, seam gap {gap:.2f} mm>"


def run(
    pipeline: _Path,
    *,
    set: Mapping[str, Setting] | None = None,
    quality: str | None = None,
    photos: Mapping[str, Union[Photo, "npt.ArrayLike"]] | None = None,
    body: Union[Body, tuple["npt.ArrayLike", "npt.ArrayLike"]] | None = None,
    until: str | None = None,
    also: Iterable[str] = (),
    keep: bool = False,
    threads: int | None = None,
    cache: Union[bool, _Path] = True,
    out: _Path | None = None,
    plugins: Iterable[_Path] = (),
    progress: Progress = None,
) -> Run:
    """Runs a pipeline, as ``toile run`` does.

    - ``set``: paths and values, as ``--set``: ``{"pattern.file": "shirt.json",
      "stages.GridMesher.edge": "6 mm"}``. Files are found from the current folder, else from that
      of the pipeline.
    - ``quality``: a named quality of the pipeline, whose settings come before those of ``set``.
    - ``photos``: pixels in the place of the photos' files, by side: (h, w, 3) uint8, sRGB; a
      fourth channel is opacity. Widths and scales are the pipeline's.
    - ``body``: who wears it, in the place of the pipeline's: vertices (n, 3), metres, y up, facing
      +z, and triangles (m, 3), closed, counter-clockwise from outside.
    - ``until``: the stage after which the run stops; ``also``: stages that are run in any case;
      ``keep``: every stage's artifacts are files as well.
    - ``threads``: one for each core where none are given. The result is the same for any number.
    - ``cache``: ``False`` runs every stage; a path is another folder of the cache.
    - ``out``: a folder for the files; without one nothing is written.
    - ``plugins``: libraries whose stages are added.
    - ``progress``: see ``toile._progress``.

    Python's other threads run meanwhile. Ctrl-C stops the run with ``KeyboardInterrupt``.

    Raises ``toile.Error``: ``InvalidInputError`` for what is wrong before anything is solved,
    ``QualityError`` where solving fails, ``UsageError`` for arguments that cannot be. A garment
    that misses limits of quality is a result; ``Run.shortfalls`` says which.
    """
    folder = None if isinstance(cache, bool) else os.fspath(cache)
    with shown(progress) as callback:
        parts = _toile.run(
            os.fspath(pipeline),
            quality=quality,
            set=as_json(set or {}),
            until=until,
            also=list(also),
            keep=keep,
            threads=threads,
            cache=cache is not False,
            cache_dir=folder,
            out=None if out is None else os.fspath(out),
            plugins=[os.fspath(plugin) for plugin in plugins],
            photos=None if photos is None else dict(photos),
            body=body,
            progress=callback,
        )
    return Run(parts)
