//! Photos and masks.

use super::artifact::{PyArtifact, initial};
use super::numbers::{self, Rows, words};
use crate::error::misused;
use crate::view::view;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use std::sync::Arc;
use toile_core::Artifact;
use toile_core::artifact::{GrayImage, Mask, Photo, RgbImage, Shared};

/// An upright sRGB photo with its scale.
#[pyclass(name = "Photo", module = "toile", frozen, extends = PyArtifact)]
pub(crate) struct PyPhoto {
    pub(crate) of: Arc<Photo>,
}

#[pymethods]
impl PyPhoto {
    /// A photo of (h, w, 3) uint8, or grey of (h, w); a fourth channel is its opacity. `width` is
    /// the real width of the garment, metres; `px_per_metre` the scale, where it is known.
    #[new]
    #[pyo3(signature = (pixels, *, width=None, px_per_metre=None))]
    fn new(
        py: Python<'_>,
        pixels: &Bound<'_, PyAny>,
        width: Option<f64>,
        px_per_metre: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let photo = Photo { garment_width: width, px_per_metre, ..photo_of(pixels, "pixels")? };
        photo.check().map_err(|why| misused(py, why, None))?;
        let of = Arc::new(photo);
        Ok(initial(of.clone(), PyPhoto { of }))
    }

    /// Its pixels: (h, w, 3) uint8, a read-only view.
    #[getter]
    pub(crate) fn pixels<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<u8>>> {
        let (w, h) = slf.get().of.pixels.dimensions();
        view(slf, &[h as usize, w as usize, 3], |photo: &Self| photo.of.pixels.as_raw())
    }

    /// Its scale, pixels per metre; `None` until it is known.
    #[getter]
    fn px_per_metre(&self) -> Option<f64> {
        self.of.px_per_metre
    }

    #[pyo3(signature = (dtype=None, copy=None))]
    fn __array__<'py>(
        slf: &Bound<'py, Self>,
        dtype: Option<Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        as_array(Self::pixels(slf)?.into_any(), dtype, copy)
    }

    fn __repr__(&self) -> String {
        let (w, h) = self.of.pixels.dimensions();
        format!("<toile photo: {w} x {h} px>")
    }
}

/// Which pixels of a photo belong to the garment.
#[pyclass(name = "Mask", module = "toile", frozen, extends = PyArtifact)]
pub(crate) struct PyMask {
    pub(crate) of: Arc<Mask>,
}

#[pymethods]
impl PyMask {
    /// A mask of (h, w) bool or uint8: what is not 0 is garment.
    #[new]
    fn new(py: Python<'_>, pixels: &Bound<'_, PyAny>) -> PyResult<PyClassInitializer<Self>> {
        let mask = mask_of(pixels, "pixels")?;
        mask.check().map_err(|why| misused(py, why, None))?;
        let of = Arc::new(mask);
        Ok(initial(of.clone(), PyMask { of }))
    }

    /// Its pixels: (h, w) uint8, 255 on the garment and 0 off it, a read-only view.
    #[getter]
    pub(crate) fn pixels<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArrayDyn<u8>>> {
        let (w, h) = slf.get().of.pixels.dimensions();
        view(slf, &[h as usize, w as usize], |mask: &Self| mask.of.pixels.as_raw())
    }

    #[pyo3(signature = (dtype=None, copy=None))]
    fn __array__<'py>(
        slf: &Bound<'py, Self>,
        dtype: Option<Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        as_array(Self::pixels(slf)?.into_any(), dtype, copy)
    }

    fn __repr__(&self) -> String {
        let (w, h) = self.of.pixels.dimensions();
        format!("<toile mask: {w} x {h} px, {} on the garment>", self.of.area_px())
    }
}

/// What numpy's protocol of arrays asks for.
fn as_array<'py>(
    pixels: Bound<'py, PyAny>,
    dtype: Option<Bound<'py, PyAny>>,
    copy: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let pixels = match dtype {
        Some(dtype) => pixels.call_method1("astype", (dtype,))?,
        None => pixels,
    };
    if copy == Some(true) { pixels.call_method0("copy") } else { Ok(pixels) }
}

/// A photo of an array, without a scale.
pub(crate) fn photo_of(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Photo> {
    let py = value.py();
    let Rows { shape, flat } = numbers::bytes(value, name)?;
    let wrong = || {
        let found = words(&shape);
        misused(
            py,
            format!("`{name}` must have the shape (h, w, 3), (h, w, 4) or (h, w), found {found}"),
            None,
        )
    };
    let (h, w, channels) = match shape[..] {
        [h, w] => (h, w, 1),
        [h, w, c @ (1 | 3 | 4)] => (h, w, c),
        _ => return Err(wrong()),
    };
    let (Ok(width), Ok(height)) = (u32::try_from(w), u32::try_from(h)) else { return Err(wrong()) };
    if w == 0 || h == 0 {
        return Err(wrong());
    }
    let (colours, opacity) = match channels {
        1 => (flat.iter().flat_map(|v| [*v; 3]).collect(), None),
        4 => {
            let pixels = flat.as_chunks::<4>().0;
            let opacity: Vec<u8> = pixels.iter().map(|p| p[3]).collect();
            let colours = pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).collect();
            (colours, Some(opacity).filter(|o| o.iter().any(|v| *v < 255)))
        }
        _ => (flat, None),
    };
    let pixels = RgbImage::from_raw(width, height, colours).ok_or_else(wrong)?;
    let alpha = opacity.and_then(|o| GrayImage::from_raw(width, height, o)).map(Shared::new);
    Ok(Photo {
        pixels: Shared::new(pixels),
        alpha,
        px_per_metre: None,
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: name.to_owned(),
    })
}

/// A mask of an array.
pub(crate) fn mask_of(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Mask> {
    let py = value.py();
    let Rows { shape, flat } = numbers::bytes(value, name)?;
    let wrong = || misused(py, format!("`{name}` must have the shape (h, w), found {}", words(&shape)), None);
    let [h, w] = shape[..] else { return Err(wrong()) };
    let (Ok(width), Ok(height)) = (u32::try_from(w), u32::try_from(h)) else { return Err(wrong()) };
    let flat = flat.into_iter().map(|v| if v == 0 { 0 } else { 255 }).collect();
    let pixels = GrayImage::from_raw(width, height, flat).ok_or_else(wrong)?;
    Ok(Mask { pixels: Shared::new(pixels) })
}
