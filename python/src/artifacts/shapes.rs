//! Bodies, outlines and panels.

use super::artifact::{PyArtifact, initial};
use super::numbers;
use crate::error::misused;
use crate::view::view;
use bytemuck::cast_slice;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::Artifact;
use toile_core::artifact::{Body, Outline, Panel};

/// A closed mesh that wears the garment: metres, y up, feet at 0, facing +z.
#[pyclass(name = "Body", module = "toile", frozen, extends = PyArtifact)]
pub(crate) struct PyBody {
    pub(crate) of: Arc<Body>,
}

#[pymethods]
impl PyBody {
    /// A body of vertices (n, 3), metres, and triangles (m, 3), counter-clockwise from outside.
    #[new]
    fn new(
        py: Python<'_>,
        positions: &Bound<'_, PyAny>,
        triangles: &Bound<'_, PyAny>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let body = mesh(positions, triangles)?;
        body.check().map_err(|why| misused(py, why, None))?;
        let of = Arc::new(body);
        Ok(initial(of.clone(), PyBody { of }))
    }

    /// Vertices, metres: (n, 3) float64, a read-only view.
    #[getter]
    fn positions<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [slf.get().of.positions.len(), 3];
        view(slf, &shape, |body: &Self| cast_slice(&body.of.positions))
    }

    /// Triangles: (m, 3) uint32, a read-only view.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        let shape = [slf.get().of.triangles.len(), 3];
        view(slf, &shape, |body: &Self| body.of.triangles.as_flattened())
    }

    /// Named lengths, metres: `height`, `bust`, `waist`, `hip`, ...
    #[getter]
    fn measurements(&self) -> BTreeMap<String, f64> {
        self.of.measurements.clone()
    }

    /// Named points, metres: `neck_left`, `armpit_right`, ...
    #[getter]
    fn landmarks(&self) -> BTreeMap<String, [f64; 3]> {
        self.of.landmarks.iter().map(|(name, p)| (name.clone(), [p.x, p.y, p.z])).collect()
    }

    fn __repr__(&self) -> String {
        format!("<toile body: {} vertices, {} triangles>", self.of.positions.len(), self.of.triangles.len())
    }
}

/// A body without landmarks.
pub(crate) fn mesh(positions: &Bound<'_, PyAny>, triangles: &Bound<'_, PyAny>) -> PyResult<Body> {
    let positions = numbers::points(positions, "positions")?;
    let triangles = numbers::triangles(triangles, "triangles", positions.len())?;
    Ok(Body { positions, triangles, landmarks: BTreeMap::new(), measurements: BTreeMap::new() })
}

/// The closed curves that bound a piece of cloth: metres, y up.
#[pyclass(name = "Outline", module = "toile", frozen, extends = PyArtifact)]
pub(crate) struct PyOutline {
    pub(crate) of: Arc<Outline>,
}

#[pymethods]
impl PyOutline {
    /// The outer curve, counter-clockwise, metres: (n, 2) float64, a read-only view.
    #[getter]
    fn outer<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [slf.get().of.outer.points.len(), 2];
        view(slf, &shape, |outline: &Self| cast_slice(&outline.of.outer.points))
    }

    /// Holes, clockwise, metres: an (n, 2) float64 array each.
    #[getter]
    fn holes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArrayDyn<f64>>>> {
        let hole =
            |h: &toile_core::artifact::Loop| numbers::copied(py, cast_slice(&h.points), &[h.points.len(), 2]);
        self.of.holes.iter().map(hole).collect()
    }

    /// Named edges: for each the first and the last point of the outer curve.
    #[getter]
    fn edges(&self) -> Vec<(String, usize, usize)> {
        self.of.edges.iter().map(|e| (e.name.clone(), e.start, e.end)).collect()
    }

    fn __repr__(&self) -> String {
        format!("<toile outline: {} points, {} holes>", self.of.outer.points.len(), self.of.holes.len())
    }
}

/// A flat triangle mesh: metres, warp along y.
#[pyclass(name = "Panel", module = "toile", frozen, extends = PyArtifact)]
pub(crate) struct PyPanel {
    pub(crate) of: Arc<Panel>,
}

#[pymethods]
impl PyPanel {
    /// Vertices, metres: (n, 2) float64, a read-only view.
    #[getter]
    fn positions<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [slf.get().of.positions.len(), 2];
        view(slf, &shape, |panel: &Self| cast_slice(&panel.of.positions))
    }

    /// Triangles, counter-clockwise: (m, 3) uint32, a read-only view.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        let shape = [slf.get().of.triangles.len(), 3];
        view(slf, &shape, |panel: &Self| panel.of.triangles.as_flattened())
    }

    /// The outer boundary, counter-clockwise: (k,) uint32, a read-only view.
    #[getter]
    fn boundary<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        let shape = [slf.get().of.boundary.len()];
        view(slf, &shape, |panel: &Self| &panel.of.boundary)
    }

    fn __repr__(&self) -> String {
        format!("<toile panel: {} vertices, {} triangles>", self.of.positions.len(), self.of.triangles.len())
    }
}
