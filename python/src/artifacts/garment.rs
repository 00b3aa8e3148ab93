//! Garments: positions, triangles, panels and seams.

use super::artifact::{PyArtifact, initial};
use super::numbers;
use crate::view::view;
use bytemuck::cast_slice;
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PySlice;
use std::sync::Arc;
use toile_core::artifact::{Garment, GarmentPanel, Point3, Vector3};

/// Panels in space with their seams. Each panel has vertices of its own; `weld` says which are
/// joined.
#[pyclass(name = "Garment", module = "toile", frozen, extends = PyArtifact)]
pub(crate) struct PyGarment {
    pub(crate) of: Arc<Garment>,
}

#[pymethods]
impl PyGarment {
    /// Places of the vertices, metres: (n, 3) float64, y up, a read-only view.
    #[getter]
    fn positions<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [slf.get().of.positions.len(), 3];
        view(slf, &shape, |garment: &Self| cast_slice(&garment.of.positions))
    }

    /// Triangles, counter-clockwise from outside: (m, 3) uint32, a read-only view.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        let shape = [slf.get().of.triangles.len(), 3];
        view(slf, &shape, |garment: &Self| garment.of.triangles.as_flattened())
    }

    /// Places of the vertices in the flat pattern, metres: (n, 2) float64, each in its panel's own
    /// plane, warp along the second axis; all zero where the pattern is not known. A read-only
    /// view.
    #[getter]
    fn uv<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [slf.get().of.rest.len(), 2];
        view(slf, &shape, |garment: &Self| cast_slice(&garment.of.rest))
    }

    /// For each vertex the first vertex that it is joined to, or itself: (n,) uint32, a read-only
    /// view.
    #[getter]
    fn weld<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        let shape = [slf.get().of.weld.len()];
        view(slf, &shape, |garment: &Self| &garment.of.weld)
    }

    /// Its panels, in the order of their vertices.
    #[getter]
    fn panels(&self) -> Vec<PyGarmentPanel> {
        self.of.panels.iter().map(|panel| PyGarmentPanel { of: panel.clone() }).collect()
    }

    /// Its seams: for each name pairs of vertices that are sewn together, (k, 2) uint32.
    #[getter]
    fn seams<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyArrayDyn<u32>>)>> {
        let seam = |s: &toile_core::artifact::GarmentSeam| {
            Ok((s.name.clone(), numbers::copied(py, s.pairs.as_flattened(), &[s.pairs.len(), 2])?))
        };
        self.of.seams.iter().map(seam).collect()
    }

    /// The greatest distance between two vertices that are sewn together, metres.
    #[getter]
    fn seam_gap_max(&self) -> f64 {
        self.of.seam_gap_max()
    }

    /// The garment with its vertices at other places: (n, 3) numbers, metres.
    fn with_positions(&self, py: Python<'_>, positions: &Bound<'_, PyAny>) -> PyResult<Py<PyGarment>> {
        let positions = numbers::points(positions, "positions")?;
        let moved = moved(&self.of, positions).map_err(|why| crate::error::misused(py, why, None))?;
        let of = Arc::new(moved);
        Py::new(py, initial(of.clone(), PyGarment { of }))
    }

    /// The garment as a `trimesh.Trimesh`, its places in the pattern as texture coordinates.
    fn to_trimesh<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("toile._trimesh")?.getattr("of")?.call1((slf,))
    }

    fn __repr__(&self) -> String {
        format!(
            "<toile garment: {} vertices, {} triangles, {} panels>",
            self.of.positions.len(),
            self.of.triangles.len(),
            self.of.panels.len()
        )
    }
}

/// A garment with its vertices elsewhere, at rest there.
///
/// Errors: a sentence.
pub(crate) fn moved(garment: &Garment, positions: Vec<Point3>) -> Result<Garment, String> {
    let (given, own) = (positions.len(), garment.positions.len());
    if given != own {
        return Err(format!("there are {given} positions, the garment has {own} vertices"));
    }
    let velocities = vec![Vector3::zeros(); own];
    let moved = Garment { positions, velocities, ..garment.clone() };
    toile_core::Artifact::check(&moved)?;
    Ok(moved)
}

/// A panel's share of a garment.
#[pyclass(name = "GarmentPanel", module = "toile", frozen)]
pub(crate) struct PyGarmentPanel {
    of: GarmentPanel,
}

#[pymethods]
impl PyGarmentPanel {
    /// The panel's name.
    #[getter]
    fn name(&self) -> &str {
        &self.of.name
    }

    /// Its vertices, as a slice of the garment's: `garment.positions[panel.vertices]`.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> Bound<'py, PySlice> {
        slice(py, &self.of.vertices)
    }

    /// Its triangles, as a slice of the garment's.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> Bound<'py, PySlice> {
        slice(py, &self.of.triangles)
    }

    /// Its boundary, counter-clockwise in the pattern, as vertices of the garment: (k,) uint32.
    #[getter]
    fn boundary<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.of.boundary)
    }

    /// Panels of a higher layer are worn outside those of a lower one.
    #[getter]
    fn layer(&self) -> u32 {
        self.of.layer
    }

    fn __repr__(&self) -> String {
        format!("<toile panel \"{}\": {} vertices>", self.of.name, self.of.vertices.len())
    }
}

fn slice<'py>(py: Python<'py>, range: &std::ops::Range<usize>) -> Bound<'py, PySlice> {
    PySlice::new(py, range.start as isize, range.end as isize, 1)
}
