"""Whatever is given, the answer is a result or an error of `toile`, and no panic."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import toile
from conftest import PATTERN, PHOTO

CASES = 150


def spoilt(dice: random.Random) -> Any:
    """Something that a caller might give by mistake."""
    things: list[Callable[[], Any]] = [
        lambda: None,
        lambda: dice.choice([0, -1, 2**31, 2**63, -(2**63), 2**80, 1e300, float("nan"), float("inf")]),
        lambda: dice.choice(["", " ", "\0", "a\nb", "(((", '"', "r#", "6 mm", "Otsu()", "\u202e", "ß" * 999]),
        lambda: dice.choice([b"", b"\xff", [], [[]], [[1, 2, 3]], {}, {"a": 1}, set(), object(), ...]),
        lambda: np.zeros(dice.choice([(), (0,), (1,), (0, 3), (3, 3), (1, 1, 3), (0, 0, 3), (5, 5, 4), (2, 2, 2, 2)])),
        lambda: np.full((4, 4, 3), dice.randrange(256), dice.choice(["uint8", "int32", "float32", "complex64", "U3", "O"])),
        lambda: np.array([[0, 0, 0], [1, 0, 0], [0, 1, dice.choice([0, np.nan, np.inf, 1e308])]]),
        lambda: (np.eye(3), np.array([[0, 1, dice.choice([2, 3, -1, 2**40])]])),
        lambda: toile.Mask(np.ones((dice.randrange(1, 5), 2), bool)),
        lambda: toile.Photo(np.zeros((3, 3, 3), "uint8")[::-1]),
    ]
    return dice.choice(things)()


def answered(call: Callable[[], Any]) -> str:
    try:
        call()
    except toile.InternalError as e:
        pytest.fail(f"a bug: {e}\n{e.detail}")
    except (toile.Error, TypeError, ValueError, OverflowError) as e:
        return type(e).__name__
    return "done"


@pytest.mark.parametrize("seed", range(8))
def test_no_argument_is_a_bug(seed: int) -> None:
    dice = random.Random(seed)
    otsu = toile.stage("Otsu")
    canny = toile.stage("Canny")
    calls: list[Callable[[Any, Any], Any]] = [
        lambda a, b: toile.Body(a, b),
        lambda a, b: toile.Photo(a, width=b),
        lambda a, b: toile.Mask(a),
        lambda a, b: otsu(a),
        lambda a, b: canny(a, b),
        lambda a, b: otsu({"front": a, "back": b}),
        lambda a, b: toile.stage(a),
        lambda a, b: toile.stage("GridMesher", edge=a, smooth=b),
        lambda a, b: toile.run(PHOTO, photos={"front": a}, until="Photos", cache=False),
        lambda a, b: toile.run(PHOTO, photos=a, until="Photos", cache=False),
        lambda a, b: toile.run(PATTERN, body=a, until="Mannequin", cache=False),
        lambda a, b: toile.run(PATTERN, set={"body.height": a, "stages.GridMesher.edge": b}, until="Mannequin", cache=False),
        lambda a, b: toile.run(PATTERN, until=a, quality=b, cache=False),
        lambda a, b: toile.run(PATTERN, until="Mannequin", threads=a, cache=False),
        lambda a, b: toile.run(a),
    ]
    outcomes = {answered(lambda: dice.choice(calls)(spoilt(dice), spoilt(dice))) for _ in range(CASES)}
    assert "done" in outcomes and len(outcomes) > 2


def test_texts_of_pipelines_are_spoilt_without_a_bug(tmp_path: Any) -> None:
    dice = random.Random(52)
    text = PATTERN.read_text(encoding="utf-8")
    file = tmp_path / "spoilt.ron"
    for _ in range(CASES):
        start = dice.randrange(len(text))
        end = min(len(text), start + dice.randrange(1, 40))
        file.write_text(text[:start] + dice.choice(["", "(", '"', "]", "\0", "1e999"]) + text[end:], encoding="utf-8")
        answered(lambda: toile.run(file, until="Mannequin", cache=False))
