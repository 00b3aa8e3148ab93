"""The compiled half of the package."""

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, final

import numpy as np
import numpy.typing as npt

_Path = str | os.PathLike[str]

class Artifact:
    """A value that one stage makes and others read. It does not change."""

    @property
    def kind(self) -> str:
        """Its kind: ``garment``, ``photo``, ``mask``, ..."""
    @property
    def digest(self) -> str:
        """The BLAKE3 digest of its content, in hexadecimal: equal for equal bits."""
    @property
    def measures(self) -> dict[str, tuple[float, str]]:
        """Its figures by name, each a number with its unit."""

@final
class Garment(Artifact):
    """Panels in space with their seams. Each panel has vertices of its own."""

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """Places of the vertices, metres: (n, 3), y up, a read-only view."""
    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """Triangles, counter-clockwise from outside: (m, 3), a read-only view."""
    @property
    def uv(self) -> npt.NDArray[np.float64]:
        """Places in the flat pattern, metres: (n, 2), warp along the second axis, a read-only view.

        All zero where the pattern is not known.
        """
    @property
    def weld(self) -> npt.NDArray[np.uint32]:
        """For each vertex the first vertex that it is joined to, or itself: (n,), a read-only view."""
    @property
    def panels(self) -> list[GarmentPanel]:
        """Its panels, in the order of their vertices."""
    @property
    def seams(self) -> list[tuple[str, npt.NDArray[np.uint32]]]:
        """Names of seams with the pairs of vertices that are sewn together, (k, 2)."""
    @property
    def seam_gap_max(self) -> float:
        """The greatest distance between two vertices that are sewn together, metres."""
    def with_positions(self, positions: npt.ArrayLike) -> Garment:
        """The garment with its vertices at other places, (n, 3), metres."""
    def to_trimesh(self) -> Any:
        """The garment as a ``trimesh.Trimesh``, in metres."""

@final
class GarmentPanel:
    """A panel's share of a garment."""

    @property
    def name(self) -> str:
        """The panel's name."""
    @property
    def vertices(self) -> slice:
        """Its vertices, as a slice of the garment's."""
    @property
    def triangles(self) -> slice:
        """Its triangles, as a slice of the garment's."""
    @property
    def boundary(self) -> npt.NDArray[np.uint32]:
        """Its boundary, counter-clockwise in the pattern, as vertices of the garment: (k,)."""
    @property
    def layer(self) -> int:
        """Panels of a higher layer are worn outside those of a lower one."""

@final
class Photo(Artifact):
    """An upright sRGB photo with its scale."""

    def __new__(
        cls,
        pixels: npt.ArrayLike,
        *,
        width: float | None = None,
        px_per_metre: float | None = None,
    ) -> Photo:
        """A photo of (h, w, 3) uint8, or grey of (h, w); a fourth channel is its opacity.

        ``width`` is the real width of the garment, metres.
        """
    @property
    def pixels(self) -> npt.NDArray[np.uint8]:
        """Its pixels: (h, w, 3), a read-only view."""
    @property
    def px_per_metre(self) -> float | None:
        """Its scale; ``None`` until it is known."""
    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[Any]: ...

@final
class Mask(Artifact):
    """Which pixels of a photo belong to the garment."""

    def __new__(cls, pixels: npt.ArrayLike) -> Mask:
        """A mask of (h, w) bool or uint8: what is not 0 is garment."""
    @property
    def pixels(self) -> npt.NDArray[np.uint8]:
        """Its pixels: (h, w), 255 on the garment and 0 off it, a read-only view."""
    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[Any]: ...

@final
class Body(Artifact):
    """A closed mesh that wears the garment: metres, y up, feet at 0, facing +z."""

    def __new__(cls, positions: npt.ArrayLike, triangles: npt.ArrayLike) -> Body:
        """Vertices (n, 3), metres, and triangles (m, 3), counter-clockwise from outside."""
    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """Vertices, metres: (n, 3), a read-only view."""
    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """Triangles: (m, 3), a read-only view."""
    @property
    def measurements(self) -> dict[str, float]:
        """Named lengths, metres: ``height``, ``bust``, ``waist``, ``hip``, ..."""
    @property
    def landmarks(self) -> dict[str, list[float]]:
        """Named points, metres: ``neck_left``, ``armpit_right``, ..."""

@final
class Outline(Artifact):
    """The closed curves that bound a piece of cloth: metres, y up."""

    @property
    def outer(self) -> npt.NDArray[np.float64]:
        """The outer curve, counter-clockwise, metres: (n, 2), a read-only view."""
    @property
    def holes(self) -> list[npt.NDArray[np.float64]]:
        """Holes, clockwise, metres: an (n, 2) array each."""
    @property
    def edges(self) -> list[tuple[str, int, int]]:
        """Named edges, each with its first and last point of the outer curve."""

@final
class Panel(Artifact):
    """A flat triangle mesh: metres, warp along y."""

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """Vertices, metres: (n, 2), a read-only view."""
    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """Triangles, counter-clockwise: (m, 3), a read-only view."""
    @property
    def boundary(self) -> npt.NDArray[np.uint32]:
        """The outer boundary, counter-clockwise: (k,), a read-only view."""

@final
class StageAlone:
    """A stage with its parameters, to be called with what its ports take."""

    def __new__(cls, name: str, parameters: Sequence[tuple[str, str]]) -> StageAlone: ...
    @property
    def parameters(self) -> str:
        """Its parameters, as a pipeline file writes them."""
    @property
    def ports(self) -> list[tuple[str, str]]:
        """The names of its ports with their kinds, in the order in which they are called with."""
    def __call__(self, *inputs: Any, **named: Any) -> Any:
        """What the stage gives: an artifact, for dictionaries a dictionary, of several ports a
        tuple."""

@final
class RunParts:
    """What a run gives, as ``toile.Run`` shows it."""

    @property
    def metrics(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def files(self) -> dict[str, bytes]: ...
    @property
    def artifacts(self) -> dict[str, Any]: ...
    @property
    def garment(self) -> Garment | None: ...
    @property
    def model(self) -> Artifact | None: ...

def run(
    pipeline: _Path,
    *,
    quality: str | None,
    set: Sequence[tuple[str, str]],
    until: str | None,
    also: Sequence[str],
    keep: bool,
    threads: int | None,
    cache: bool,
    cache_dir: _Path | None,
    out: _Path | None,
    plugins: Sequence[_Path],
    photos: Mapping[str, Any] | None,
    body: Any,
    progress: Callable[[str, str, float, str], object] | None,
) -> RunParts: ...
def write(folder: _Path, files: Sequence[tuple[str, bytes]]) -> list[_Path]: ...
def define(spec: Mapping[str, Any], function: Callable[..., Any]) -> None: ...
def setting_words(set: Sequence[tuple[str, str]]) -> list[str]:
    """Settings as ``--set`` takes them, of paths and values as JSON."""

def stage_names() -> list[str]:
    """The names of all stages."""

def command(arguments: Sequence[str], start: Sequence[str]) -> int: ...
def version() -> str: ...
