"""Photos and bodies of Python in the place of a pipeline's files."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

import toile
from conftest import PATTERN, PHOTO, QUICK, ROOT

Pixels = npt.NDArray[np.uint8]


def test_a_photo_of_an_array_gives_what_its_file_gives(photo: Pixels) -> None:
    of_file = toile.run(PHOTO, until="Canny").artifacts["Canny"]
    of_array = toile.run(PHOTO, photos={"front": photo}, until="Canny").artifacts["Canny"]
    assert sorted(of_array) == ["back", "front"]
    for side in of_file:
        assert np.array_equal(of_array[side].outer, of_file[side].outer)


def test_widths_are_the_pipelines(photo: Pixels) -> None:
    def width(**settings: str) -> float:
        run = toile.run(PHOTO, photos={"front": photo}, set=settings, until="Canny")
        return float(np.ptp(run.artifacts["Canny"]["front"].outer[:, 0]))

    assert width(**{"photos.front.width": "38 cm"}) == pytest.approx(width() / 2, rel=1e-6)


def test_what_is_transparent_is_ground(photo: Pixels) -> None:
    mask = toile.run(PHOTO, until="Auto").artifacts["Auto"]["front"].pixels
    cut = np.dstack([photo, mask])
    again = toile.run(PHOTO, photos={"front": cut}, until="Auto").artifacts["Auto"]["front"].pixels
    assert ((again > 0) != (mask > 0)).mean() < 0.01


def test_results_of_other_photos_are_not_taken_from_the_cache(photo: Pixels) -> None:
    def mask(pixels: Pixels) -> Pixels:
        run = toile.run(PHOTO, photos={"front": pixels}, set={"stages.Auto": "Otsu()"}, until="Otsu")
        front = run.artifacts["Otsu"]["front"]
        assert isinstance(front, toile.Mask)
        return front.pixels

    first = mask(photo)
    turned = mask(photo[:, ::-1])
    assert np.array_equal(turned, first[:, ::-1])
    assert np.array_equal(mask(photo), first)


def test_a_body_of_arrays_wears_the_garment(shirt: toile.Run) -> None:
    body = shirt_body()
    run = toile.run(PATTERN, set=QUICK, body=(body.positions, body.triangles))
    assert run.shortfalls == []
    taller = toile.run(PATTERN, set=QUICK, body=(body.positions * 1.03, body.triangles))
    assert taller.garment.positions[:, 1].max() > run.garment.positions[:, 1].max()


def test_a_body_that_stages_made_keeps_its_landmarks() -> None:
    body = shirt_body()
    assert body.measurements["height"] == pytest.approx(1.72, abs=0.02)
    run = toile.run(PATTERN, body=body, until="Arrange")
    own = toile.run(PATTERN, until="Arrange")
    assert run.artifacts["Arrange"].digest == own.artifacts["Arrange"].digest


def shirt_body() -> toile.Body:
    """The mannequin of the sample."""
    made = toile.run(PATTERN, until="Mannequin").artifacts["Mannequin"]
    assert isinstance(made, toile.Body)
    return made
