"""One stage alone."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

import toile
from conftest import PHOTO

Pixels = npt.NDArray[np.uint8]


def square(level: int = 220) -> Pixels:
    """A light square on dark ground."""
    pixels = np.full((60, 80, 3), 30, np.uint8)
    pixels[10:50, 20:60] = level
    return pixels


def test_a_stage_takes_an_array_and_gives_an_artifact() -> None:
    mask = toile.stage("Otsu")(square())
    assert mask.kind == "mask"
    assert mask.pixels.shape == (60, 80) and mask.pixels.dtype == np.uint8
    assert set(np.unique(mask.pixels)) == {0, 255}
    assert (np.asarray(mask)[10:50, 20:60] == 255).all()


def test_parameters_are_those_of_the_pipeline_file() -> None:
    assert toile.stage("Otsu", bias=3).parameters == toile.stage("Otsu", bias=np.float64(3)).parameters
    mesher = toile.stage("GridMesher", edge="6 mm")
    assert 'edge: "6 mm"' in mesher.parameters
    assert toile.stage("NeighbourhoodMean", mask="Eight", radius=1).ports == [("photo", "photo")]


def test_stages_follow_each_other(photo: Pixels) -> None:
    smooth = toile.stage("NeighbourhoodMean")(photo)
    mask = toile.stage("Otsu")(smooth)
    run = toile.run(PHOTO, set={"stages.Auto": "Otsu()"}, until="Otsu")
    assert np.array_equal(mask.pixels, run.artifacts["Otsu"]["front"].pixels)


def test_inputs_go_by_name_too() -> None:
    photo = toile.Photo(square(), width=0.5)
    mask = toile.stage("Otsu")(photo=photo)
    ports = [name for name, _ in toile.stage("Canny").ports]
    assert "photo" in ports and "mask" in ports
    outline = toile.stage("Canny")(photo=photo, mask=mask)
    width = np.ptp(outline.outer[:, 0])
    assert width == pytest.approx(0.5, rel=0.05)


def test_a_dictionary_runs_it_for_each() -> None:
    masks = toile.stage("Otsu")({"front": square(), "back": square(120)})
    assert sorted(masks) == ["back", "front"]
    assert np.array_equal(masks["front"].pixels, masks["back"].pixels)


def test_a_garment_is_laid_flat_and_written(shirt: toile.Run) -> None:
    files = toile.stage("GarmentObj", name="shirt")(shirt.garment)
    [(path, text)] = [(path, data) for path, data in files.items() if path.endswith(".obj")]
    assert path == "shirt.obj"
    assert text.count(b"\nv ") >= len(shirt.garment.positions) - 1


def test_errors_say_what_is_there() -> None:
    with pytest.raises(toile.UsageError, match="there is no stage `Ostu`") as error:
        toile.stage("Ostu")
    assert error.value.help == "did you mean `Otsu`?"
    with pytest.raises(toile.UsageError, match="unknown parameter `bais`") as error:
        toile.stage("Otsu", bais=3)
    assert error.value.help == "did you mean `bias`? `Otsu` has `bias`, `garment`, `holes`, `touch`, `open`, `close`"
    with pytest.raises(toile.UsageError, match="`bias`"):
        toile.stage("Otsu", bias=1000)
    with pytest.raises(toile.UsageError, match="`Otsu` needs a photo: `photo`"):
        toile.stage("Otsu")()
    with pytest.raises(toile.UsageError, match="`photo` takes a photo, found a mask"):
        toile.stage("Otsu")(toile.Mask(np.ones((3, 3), bool)))
    with pytest.raises(toile.UsageError, match="`Otsu` takes 1 inputs, found 2"):
        toile.stage("Otsu")(square(), square())
    with pytest.raises(toile.InvalidInputError):
        toile.stage("Otsu")(np.full((50, 50, 3), 128, np.uint8))
    with pytest.raises(toile.UsageError, match="a stage is named, or made of a function by its role"):
        toile.stage()  # type: ignore[call-overload]
