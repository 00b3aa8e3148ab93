"""Errors tell what the command tells: the sentence, the place and what to do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import toile
from conftest import PATTERN, PHOTO


def told(error: pytest.ExceptionInfo[toile.Error]) -> tuple[str, str | None]:
    return error.value.message, error.value.help


def test_a_fault_of_the_file_has_its_place(tmp_path: Path) -> None:
    file = tmp_path / "wrong.ron"
    photo = PHOTO.parent / "samples/tshirt/front.jpg"
    file.write_text(f'(\n    photos: {{"front": (file: "{photo}", width: "52 cm")}},\n    stages: [Otsuu(), Kanny()],\n)\n')
    with pytest.raises(toile.InvalidInputError) as error:
        toile.run(file)
    assert error.value.code == "unknown_stage"
    assert error.value.exit_code == 3
    assert error.value.message == "unknown stage `Otsuu`"
    assert error.value.help is not None and error.value.help.startswith("did you mean `Otsu`?")
    assert error.value.place == f"{file}:3:14"
    assert [fault["message"] for fault in error.value.faults][:2] == ["unknown stage `Otsuu`", "unknown stage `Kanny`"]
    assert str(error.value).startswith(f"{file}:3:14: unknown stage `Otsuu`\n  help: did you mean `Otsu`?")


def test_a_fault_of_a_setting_is_shown_there() -> None:
    with pytest.raises(toile.InvalidInputError) as error:
        toile.run(PATTERN, set={"stages.GridMesher.edge": "6 mmm"})
    assert error.value.code == "bad_value"
    assert error.value.place == '--set stages.GridMesher.edge="6 mmm"'


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(toile.InvalidInputError) as error:
        toile.run(PATTERN, set={"pattern.file": "no_such.json"})
    assert error.value.message == 'GarmentCode: cannot read "no_such.json": no such file'
    assert error.value.help == "paths are relative to the pipeline file"
    with pytest.raises(toile.InvalidInputError) as error:
        toile.run(tmp_path / "none.ron")
    assert error.value.code == "pattern_loading"


def test_a_stage_that_fails_is_named() -> None:
    with pytest.raises(toile.InvalidInputError) as error:
        toile.run(PHOTO, photos={"front": np.full((300, 200, 3), 128, np.uint8)})
    assert error.value.stage == "Auto"
    assert error.value.panel == "front"
    assert error.value.place is not None and error.value.place.startswith(f"{PHOTO}:")


def test_a_stage_that_there_is_not() -> None:
    with pytest.raises(toile.InvalidInputError) as error:
        toile.run(PATTERN, until="GridMeshr")
    assert error.value.message == "there is no stage `GridMeshr` in this pipeline"
    assert error.value.help is not None and error.value.help.startswith("did you mean `GridMesher`?")


def test_arguments_that_cannot_be() -> None:
    with pytest.raises(toile.UsageError) as error:
        toile.run(PATTERN, set={"body.height": None})  # type: ignore[dict-item]
    assert error.value.message.startswith('the value of "body.height" is no text, number, true, false')
    with pytest.raises(toile.UsageError) as error:
        toile.run(PATTERN, set={"body.height": object()})  # type: ignore[dict-item]
    assert told(error) == (
        'the value of "body.height" is of type object, which no setting has',
        "give a number, true or false, a text as --set takes it, or a list of them",
    )
    with pytest.raises(toile.UsageError, match="`threads` must be at least 1"):
        toile.run(PATTERN, threads=0)
    assert issubclass(toile.UsageError, ValueError)


def test_arrays_that_cannot_be() -> None:
    with pytest.raises(toile.UsageError) as error:
        toile.run(PHOTO, photos={"front": np.zeros((4, 4, 3))})
    assert told(error) == (
        '`photos["front"]` must be uint8, found float64',
        'scale the values to 0 to 255 and convert them: array.astype("uint8")',
    )
    with pytest.raises(toile.UsageError) as error:
        toile.run(PHOTO, photos={"front": np.zeros((4, 4, 2), np.uint8)})
    assert error.value.message == '`photos["front"]` must have the shape (h, w, 3), (h, w, 4) or (h, w), found (4, 4, 2)'
    with pytest.raises(toile.UsageError) as error:
        toile.Body([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, np.nan, 0.0]], [[0, 1, 2]])
    assert error.value.message == "`positions` has a number in row 2 that is not finite"
    with pytest.raises(toile.UsageError) as error:
        toile.Body([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 3]])
    assert error.value.message == "`triangles` names vertex 3 in row 0, there are 3"
    with pytest.raises(toile.UsageError) as error:
        toile.Body([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0.5, 1, 2]])
    assert error.value.message == "`triangles` must be whole numbers, found float64"


def test_what_is_given_must_have_a_place() -> None:
    with pytest.raises(toile.InvalidInputError) as error:
        toile.run(PATTERN, photos={"front": np.zeros((4, 4, 3), np.uint8)})
    assert told(error) == (
        "photos are given, and the pipeline reads none",
        "use a pipeline with `photos`, such as pipelines/photo.ron",
    )
    with pytest.raises(toile.InvalidInputError) as error:
        toile.run(PHOTO, photos={"side": np.zeros((4, 4, 3), np.uint8)})
    assert error.value.message == 'Photos: the pipeline has no photo "side"'
    assert error.value.help == "its photos are `back`, `front`"


def test_a_body_that_is_open_is_refused() -> None:
    with pytest.raises(toile.InvalidInputError, match="the body is not closed: 3 edges are open"):
        toile.run(PATTERN, body=([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))


def test_an_error_has_a_class_for_each_exit_code() -> None:
    classes = [toile.UsageError, toile.InvalidInputError, toile.QualityError, toile.StoppedError, toile.InternalError]
    assert [kind.exit_code for kind in classes] == [2, 3, 4, 5, 70]
    assert all(issubclass(kind, toile.Error) for kind in classes)
