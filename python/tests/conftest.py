"""What the tests share: the sample pipelines, a cache of their own, one run of a shirt."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import toile

ROOT = Path(__file__).parents[2]
PATTERN = ROOT / "pipelines/pattern.ron"
PHOTO = ROOT / "pipelines/photo.ron"

#: Settings with which the shirt of the pattern is sewn and draped in some seconds.
QUICK = {"stages.GridMesher.edge": "30 mm"}


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The cache of this session, also for commands."""
    folder = tmp_path_factory.mktemp("cache")
    os.environ["TOILE_CACHE"] = str(folder)
    yield folder


@pytest.fixture(scope="session")
def shirt(cache: Path) -> toile.Run:
    """The shirt of the sample pattern, draped on the mannequin."""
    return toile.run(PATTERN, set=QUICK)


@pytest.fixture(scope="session")
def photo(cache: Path) -> npt.NDArray[np.uint8]:
    """The pixels of the sample's photo of a T-shirt."""
    front = toile.run(PHOTO, until="Photos").artifacts["Photos"]["front"]
    assert isinstance(front, toile.Photo)
    return front.pixels
