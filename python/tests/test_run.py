"""A run and what it gives."""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import toile
from conftest import PATTERN, PHOTO, QUICK


def test_a_garment_is_arrays(shirt: toile.Run) -> None:
    garment = shirt.garment
    n, m = len(garment.positions), len(garment.triangles)
    assert garment.positions.shape == (n, 3) and garment.positions.dtype == np.float64
    assert garment.triangles.shape == (m, 3) and garment.triangles.dtype == np.uint32
    assert garment.uv.shape == (n, 2) and garment.uv.dtype == np.float64
    assert garment.weld.shape == (n,) and garment.weld.dtype == np.uint32
    assert garment.triangles.max() < n
    # Metres, y up: a shirt on someone of 1.72 m.
    height = np.ptp(garment.positions[:, 1])
    assert 0.5 < height < 1.0
    assert 1.2 < garment.positions[:, 1].max() < 1.72


def test_panels_cover_the_garment_in_their_order(shirt: toile.Run) -> None:
    garment = shirt.garment
    assert "left_ftorso" in [panel.name for panel in garment.panels] or len(garment.panels) > 4
    end = 0
    for panel in garment.panels:
        assert panel.vertices.start == end
        end = panel.vertices.stop
        own = garment.triangles[panel.triangles]
        assert own.min() >= panel.vertices.start and own.max() < panel.vertices.stop
        assert set(panel.boundary) <= set(range(panel.vertices.start, panel.vertices.stop))
    assert end == len(garment.positions)


def test_seams_are_closed(shirt: toile.Run) -> None:
    garment = shirt.garment
    assert garment.seam_gap_max < 1e-3
    for _, pairs in garment.seams:
        ends = garment.positions[pairs]
        assert np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).max() <= garment.seam_gap_max


def test_triangles_are_about_as_large_as_in_the_pattern(shirt: toile.Run) -> None:
    garment = shirt.garment
    a, b, c = np.moveaxis(garment.positions[garment.triangles], 1, 0)
    sewn = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    u, v, w = np.moveaxis(garment.uv[garment.triangles], 1, 0)
    d, e = v - u, w - u
    flat = np.abs(d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]).sum() / 2
    assert sewn == pytest.approx(flat, rel=0.03)


def test_figures_and_remarks_are_those_of_the_command(shirt: toile.Run, tmp_path: Path) -> None:
    assert shirt.metrics["garment"]["triangles"] == len(shirt.garment.triangles)
    assert shirt.metrics["garment"]["converged"]
    assert shirt.shortfalls == []
    assert all(isinstance(text, str) for text in shirt.warnings + shirt.notes)
    assert any(note.startswith("Arrange: ") for note in shirt.notes)
    assert repr(shirt).startswith("<toile run of pattern: ")


def test_files_are_in_memory_until_they_are_saved(shirt: toile.Run, tmp_path: Path) -> None:
    assert {"garment.glb", "report.html", "metrics.json"} <= set(shirt.files)
    assert shirt.files["garment.glb"][:4] == b"glTF"
    paths = shirt.save(tmp_path / "out")
    assert tmp_path / "out/garment.glb" in paths
    assert (tmp_path / "out/garment.glb").read_bytes() == shirt.files["garment.glb"]


def test_out_writes_the_files_as_the_command_does(tmp_path: Path) -> None:
    run = toile.run(PATTERN, set=QUICK, out=tmp_path / "shirt")
    written = {str(p.relative_to(tmp_path / "shirt")) for p in (tmp_path / "shirt").rglob("*") if p.is_file()}
    assert written == set(run.files)


def test_the_bits_are_those_of_the_command(shirt: toile.Run, tmp_path: Path) -> None:
    settings = [f'--set={path}="{value}"' for path, value in QUICK.items()]
    command = [sys.executable, "-m", "toile", "run", str(PATTERN), "--no-cache", "--out", str(tmp_path)]
    subprocess.run([*command, *settings], check=True, capture_output=True)
    assert (tmp_path / "garment.glb").read_bytes() == shirt.files["garment.glb"]


def test_the_result_does_not_depend_on_the_threads(shirt: toile.Run) -> None:
    one = toile.run(PATTERN, set=QUICK, threads=1, cache=False)
    assert one.garment.digest == shirt.garment.digest
    assert np.array_equal(one.garment.positions, shirt.garment.positions)


def test_a_second_run_comes_from_the_cache_with_the_same_garment(shirt: toile.Run) -> None:
    again = toile.run(PATTERN, set=QUICK)
    stages = {stage["id"]: stage["cached"] for stage in again.metrics["stages"]}
    assert stages["StaticEquilibrium"] and stages["Settle"]
    assert again.garment.digest == shirt.garment.digest


def test_garments_are_run_in_a_pool_of_threads() -> None:
    edges = ["34 mm", "36 mm", "38 mm", "40 mm"]

    def digest(edge: str) -> str:
        return toile.run(PATTERN, set={"stages.GridMesher.edge": edge}, threads=1, cache=False).garment.digest

    one_after_the_other = [digest(edge) for edge in edges]
    with ThreadPoolExecutor(2) as pool:
        at_once = list(pool.map(digest, edges))
    assert at_once == one_after_the_other
    assert len(set(at_once)) == len(edges)


def test_until_stops_and_gives_what_the_stage_made() -> None:
    run = toile.run(PATTERN, until="GridMesher")
    panels = run.artifacts["GridMesher"]
    assert all(panel.kind == "panel" for panel in panels.values())
    with pytest.raises(AttributeError, match="the run made no garment"):
        run.garment
    assert run.model is None


def test_a_quality_is_taken_by_its_name() -> None:
    run = toile.run(PHOTO.parent / "vest.ron", quality="Draft", until="Otsu")
    assert run.metrics["quality"].startswith("Draft")


def test_progress_tells_stage_share_and_what_it_does() -> None:
    seen: list[tuple[str, str, float, str]] = []
    toile.run(PATTERN, until="Arrange", cache=False, progress=lambda *step: seen.append(step))
    stages = [stage for stage, _, _, _ in seen]
    assert stages.index("GridMesher") < stages.index("Arrange")
    assert all(0.0 <= share <= 1.0 for _, _, share, _ in seen)


def test_what_progress_raises_ends_the_run() -> None:
    class Enough(Exception):
        pass

    def enough(*_: object) -> None:
        raise Enough

    with pytest.raises(Enough):
        toile.run(PATTERN, cache=False, progress=enough)


def test_a_garment_is_a_mesh_of_trimesh(shirt: toile.Run) -> None:
    mesh = shirt.to_trimesh()
    assert len(mesh.vertices) == len(shirt.garment.positions)
    assert np.array_equal(mesh.faces, shirt.garment.triangles)
    assert mesh.visual.uv.shape == shirt.garment.uv.shape


def test_a_notebook_shows_the_turntable(shirt: toile.Run) -> None:
    html = shirt._repr_html_()
    assert html.startswith("<iframe srcdoc=") and "tt-" in html
    no_garment = toile.run(PATTERN, until="GridMesher")
    assert no_garment._repr_html_().startswith("<pre>&lt;toile run of pattern: no garment")
