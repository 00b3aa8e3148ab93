"""Arrays show the memory of artifacts: nothing is copied, and nothing can be changed."""

from __future__ import annotations

import gc
import time

import numpy as np
import pytest

import toile


def test_a_view_of_ten_million_vertices_takes_less_than_a_millisecond() -> None:
    n = 10_000_000
    body = toile.Body(np.zeros((n, 3)), np.array([[0, 1, 2]]))
    body.positions
    start = time.perf_counter()
    positions = body.positions
    took = time.perf_counter() - start
    assert positions.shape == (n, 3)
    assert took < 1e-3


def test_two_views_are_one_memory(shirt: toile.Run) -> None:
    assert np.shares_memory(shirt.garment.positions, shirt.garment.positions)
    assert np.shares_memory(shirt.garment.triangles, shirt.garment.triangles)


def test_a_view_outlives_its_garment() -> None:
    body = toile.Body(np.arange(9.0).reshape(3, 3), [[0, 1, 2]])
    positions = body.positions
    del body
    gc.collect()
    # What is freed would be written over here.
    [np.zeros((3, 3)) for _ in range(1000)]
    assert np.array_equal(positions, np.arange(9.0).reshape(3, 3))


def test_views_are_read_only(shirt: toile.Run) -> None:
    positions = shirt.garment.positions
    with pytest.raises(ValueError, match="read-only"):
        positions[0] = 0.0
    with pytest.raises(ValueError, match="cannot set WRITEABLE flag"):
        positions.flags.writeable = True


def test_a_moved_garment_is_another(shirt: toile.Run) -> None:
    moved = shirt.garment.with_positions(shirt.garment.positions + [0.0, 1.0, 0.0])
    assert moved.digest != shirt.garment.digest
    assert np.allclose(moved.positions[:, 1] - shirt.garment.positions[:, 1], 1.0)
