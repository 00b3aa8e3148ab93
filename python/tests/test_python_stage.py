"""Functions as stages: a segmentation of one's own in the pipeline of photos."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import toile
from conftest import PATTERN, PHOTO, QUICK

Pixels = npt.NDArray[np.uint8]


@toile.stage(role="Binariser", contracts=["deterministic", "refuses_empty"])
def my_segmentation(photo: Pixels, *, distance: float = 60.0) -> npt.NDArray[np.bool_]:
    """Takes what differs from the colour of the corners for garment."""
    corners = photo[[0, 0, -1, -1], [0, -1, 0, -1]].astype(float)
    far: npt.NDArray[np.bool_] = np.linalg.norm(photo - np.median(corners, axis=0), axis=2) > distance
    if not far.any():
        raise toile.InvalidInputError("the photo shows no garment", help="use a plain ground")
    return far


def test_it_stands_in_the_pipeline_by_its_name(photo: Pixels) -> None:
    run = toile.run(PHOTO, set={"stages.Auto": "MySegmentation(distance: 40)"}, until="MySegmentation")
    mask = run.artifacts["MySegmentation"]["front"].pixels
    of_ours = toile.run(PHOTO, until="Auto").artifacts["Auto"]["front"].pixels
    both = ((mask > 0) & (of_ours > 0)).sum() / ((mask > 0) | (of_ours > 0)).sum()
    assert both > 0.9


def test_it_stays_a_function_and_is_a_stage_alone(photo: Pixels) -> None:
    mask = toile.stage("MySegmentation", distance=40)(photo)
    assert np.array_equal(mask.pixels > 0, my_segmentation(photo, distance=40.0))


def test_its_signature_is_its_card() -> None:
    stage = toile.stage("MySegmentation")
    assert stage.ports == [("photo", "photo")]
    assert stage.parameters == "(distance: 60.0)"
    assert "MySegmentation" in toile.stage_names()
    with pytest.raises(toile.UsageError, match="unknown parameter `distanse`") as error:
        toile.stage("MySegmentation", distanse=3)
    assert error.value.help == "did you mean `distance`?"
    with pytest.raises(toile.InvalidInputError) as fault:
        toile.run(PHOTO, set={"stages.Auto": 'MySegmentation(distance: "far")'})
    assert fault.value.message == '`distance` must be a number, found `"far"`'


def test_its_errors_are_those_of_a_stage() -> None:
    plain = np.full((40, 40, 3), 200, np.uint8)
    with pytest.raises(toile.InvalidInputError) as error:
        toile.run(PHOTO, photos={"front": plain}, set={"stages.Auto": "MySegmentation()"})
    assert error.value.message == "MySegmentation (front): the photo shows no garment"
    assert error.value.help == "use a plain ground"
    assert error.value.stage == "MySegmentation"


def test_another_exception_is_a_bug_of_the_stage_with_its_traceback(photo: Pixels) -> None:
    @toile.stage(role="Binariser")
    def broken(photo: Pixels) -> Pixels:
        raise KeyError("weights")

    with pytest.raises(toile.InternalError) as error:
        toile.stage("Broken")(photo)
    assert error.value.message == "it raised KeyError: 'weights'"
    assert error.value.detail is not None and "in broken" in error.value.detail

    @toile.stage(role="Binariser")
    def too_small(photo: Pixels) -> Pixels:
        return photo[::2, ::2, 0]

    with pytest.raises(toile.InternalError, match="the mask that it returned is .* px, the photo .*"):
        toile.stage("TooSmall")(photo)


def test_results_are_kept_until_the_source_changes(photo: Pixels, tmp_path: Path) -> None:
    def runs(source: str) -> int:
        file = tmp_path / "stages.py"
        file.write_text(source)
        calls: list[int] = []
        exec(compile(source, str(file), "exec"), {"calls": calls, "__name__": "stages"})
        toile.run(PHOTO, set={"stages.Auto": "Counted()"}, until="Counted")
        return len(calls)

    source = (
        "import toile, linecache\n"
        "linecache.checkcache()\n"
        "@toile.stage(role='Binariser', version='{version}')\n"
        "def counted(photo):\n"
        "    calls.append(1)\n"
        "    return photo[:, :, 0] > {level}\n"
    )
    first = runs(source.format(version=1, level=100))
    assert first == 2, "the front and its mirror image"
    assert runs(source.format(version=1, level=100)) == 0, "it comes from the cache"
    assert runs(source.format(version=1, level=101)) == first, "its source is another"
    assert runs(source.format(version=2, level=101)) == first, "its version is another"


def test_the_kit_tests_its_contracts(tmp_path: Path) -> None:
    file = tmp_path / "stages.py"
    file.write_text(
        "import numpy as np\n"
        "import toile\n"
        "@toile.stage(role='Denoiser', contracts=['deterministic', 'idempotent'])\n"
        "def quiet(photo, *, levels: int = 8):\n"
        "    '''Rounds the levels.'''\n"
        "    return (photo // levels * levels).astype('uint8')\n"
        "@toile.stage(role='Denoiser', contracts=['deterministic'])\n"
        "def loud(photo):\n"
        "    '''Adds noise, though it promises not to.'''\n"
        "    return np.random.randint(0, 255, photo.shape, 'uint8')\n"
    )
    kept = toile.doctor("Quiet", contracts=True, plugins=[file])
    [quiet] = kept["stages"]
    assert quiet["health"] == "works"
    assert {c["name"]: c["found"] for c in quiet["contracts"]} == {"Deterministic": "kept", "Idempotent": "kept"}
    broken = toile.doctor("Loud", contracts=True, plugins=[file])
    [loud] = broken["stages"]
    assert [c["found"] for c in loud["contracts"]] == ["broken"]


def test_a_smoother_a_draper_a_body_and_a_writer(shirt: toile.Run, tmp_path: Path) -> None:
    @toile.stage(role="Draper")
    def lifted(garment: toile.Garment, *, by: float = 0.1) -> Any:
        return garment.positions + [0.0, by, 0.0]

    moved = toile.stage("Lifted", by=0.25)(shirt.garment)
    assert np.allclose(moved.positions - shirt.garment.positions, [0.0, 0.25, 0.0])

    @toile.stage(role="Writer")
    def npy(garment: toile.Garment) -> dict[str, bytes]:
        return {"positions.npy": np.asarray(garment.positions).tobytes()}

    files = toile.stage("Npy")(shirt.garment)
    assert files["positions.npy"] == shirt.garment.positions.tobytes()
    run = toile.run(PATTERN, set={**QUICK, "stages.Preview": "Npy()"})
    assert run.files["positions.npy"] == shirt.garment.positions.tobytes()

    @toile.stage(role="Smoother")
    def same(panel: toile.Panel) -> Any:
        return panel.positions

    panels = toile.run(PATTERN, set={"stages.PlaneSmoother": "Same()"}, until="Same").artifacts["Same"]
    assert all(panel.kind == "panel" for panel in panels.values())


def test_what_a_function_cannot_be() -> None:
    with pytest.raises(toile.UsageError) as error:
        toile.stage(role="Solver", name="Mine")(lambda photo: photo)
    assert error.value.message == "a function cannot be a stage of the role `Solver`"
    assert error.value.help == "a function may be a denoiser, binariser, smoother, body, draper, writer"
    with pytest.raises(toile.UsageError) as error:

        @toile.stage(role="Binariser")
        def otsu(photo: Pixels) -> Pixels:
            return photo

    assert error.value.message == "the stage name `Otsu` is taken by a stage of this program"
    with pytest.raises(toile.UsageError) as error:

        @toile.stage(role="Binariser")
        def of_image(image: Pixels) -> Pixels:
            return image

    assert error.value.message == "a stage takes no `image`"
    with pytest.raises(toile.UsageError, match="is annotated `list`"):

        @toile.stage(role="Binariser")
        def listed(photo: Pixels, *, levels: list = [1]) -> Pixels:  # type: ignore[type-arg]
            return photo
