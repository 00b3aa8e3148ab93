"""Garments as meshes of trimesh."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from toile._toile import Garment


def of(garment: Garment) -> Any:
    """A ``trimesh.Trimesh`` with the garment's vertices, in metres, and its places in the flat
    pattern as texture coordinates.

    Raises ``ImportError`` where trimesh is not installed.
    """
    try:
        trimesh: Any = import_module("trimesh")
    except ImportError:
        raise ImportError("to_trimesh needs trimesh: pip install toile[trimesh]") from None
    visual = trimesh.visual.TextureVisuals(uv=garment.uv)
    return trimesh.Trimesh(garment.positions, garment.triangles, visual=visual, process=False)
