"""The package is typed: mypy --strict passes on it, and on a program that uses it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from conftest import ROOT

PROGRAM = '''
import numpy as np
import numpy.typing as npt
import toile


@toile.stage(role="Binariser")
def light(photo: npt.NDArray[np.uint8], *, level: int = 128) -> npt.NDArray[np.bool_]:
    return photo[..., 0] > level


run: toile.Run = toile.run("a.ron", set={"body.height": "1.8 m", "stages.Canny.low": 20}, out=None)
positions: npt.NDArray[np.float64] = run.garment.positions
triangles: npt.NDArray[np.uint32] = run.garment.triangles
mask = toile.stage("Otsu", bias=3)(np.zeros((3, 3, 3), np.uint8))
stays: npt.NDArray[np.bool_] = light(np.zeros((3, 3, 3), np.uint8), level=3)
try:
    toile.verify("out")
except toile.Error as e:
    place: str | None = e.place
'''


def mypy(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "mypy", "--strict", *arguments], capture_output=True, text=True)


def test_the_package_is_typed() -> None:
    checked = mypy(str(ROOT / "python/package/toile"))
    assert checked.returncode == 0, checked.stdout


def test_a_program_is_checked_against_the_installed_package(tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(PROGRAM)
    checked = mypy(str(tmp_path / "program.py"))
    assert checked.returncode == 0, checked.stdout
    (tmp_path / "wrong.py").write_text('import toile\ntoile.run("a.ron", threads="two")\n')
    assert 'incompatible type "str"' in mypy(str(tmp_path / "wrong.py")).stdout
