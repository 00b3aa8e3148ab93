//! Arrays of Python as lists of Rust, checked, and lists as arrays of their own.

use crate::error::misused;
use numpy::ndarray::{ArrayViewD, IxDyn};
use numpy::{Element, PyArrayDyn, PyReadonlyArrayDyn, PyUntypedArrayMethods, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use toile_core::artifact::{Point2, Point3};

/// An array of its own with the numbers of a list.
pub(crate) fn copied<'py, T: Element>(
    py: Python<'py>,
    flat: &[T],
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let view =
        ArrayViewD::from_shape(IxDyn(shape), flat).map_err(|e| PyValueError::new_err(e.to_string()))?;
    Ok(view.to_pyarray(py))
}

/// An array of Python with its shape, row after row.
pub(crate) struct Rows<T> {
    pub(crate) shape: Vec<usize>,
    pub(crate) flat: Vec<T>,
}

/// The numbers of an array, or of what numpy makes one of. `kinds` are the letters of numpy's kinds
/// of numbers that are taken, in words `wanted`; `dtype` is what they are brought to.
fn rows<T: Element + Clone>(
    value: &Bound<'_, PyAny>,
    name: &str,
    dtype: &str,
    (kinds, wanted): (&str, &str),
) -> PyResult<Rows<T>> {
    let py = value.py();
    let numpy = py.import("numpy")?;
    let array = numpy
        .getattr("asarray")?
        .call1((value,))
        .map_err(|e| misused(py, format!("`{name}` is no array of numbers: {}", e.value(py)), None))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if !kinds.contains(kind.as_str()) {
        let found = array.getattr("dtype")?.to_string();
        return Err(misused(py, format!("`{name}` must be {wanted}, found {found}"), None));
    }
    let asked = PyDict::new(py);
    asked.set_item("dtype", dtype)?;
    let array = numpy.getattr("ascontiguousarray")?.call((array,), Some(&asked))?;
    let array: PyReadonlyArrayDyn<'_, T> = array.extract()?;
    let shape = array.shape().to_vec();
    let flat = array.as_slice().map_err(|e| PyValueError::new_err(e.to_string()))?.to_vec();
    Ok(Rows { shape, flat })
}

fn of_width(py: Python<'_>, name: &str, shape: &[usize], width: usize) -> PyResult<()> {
    match shape {
        [_, w] if *w == width => Ok(()),
        _ => Err(misused(
            py,
            format!("`{name}` must have the shape (n, {width}), found {}", words(shape)),
            None,
        )),
    }
}

/// A shape as numpy writes it.
pub(crate) fn words(shape: &[usize]) -> String {
    match shape {
        [n] => format!("({n},)"),
        _ => format!("({})", shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Points in space, finite.
pub(crate) fn points(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<Point3>> {
    let Rows { shape, flat } = rows::<f64>(value, name, "float64", ("fiu", "numbers"))?;
    of_width(value.py(), name, &shape, 3)?;
    all_finite(value.py(), name, &flat, 3)?;
    Ok(flat.as_chunks::<3>().0.iter().map(|p| Point3::from(*p)).collect())
}

/// Points in the plane, finite.
pub(crate) fn points_2d(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<Point2>> {
    let Rows { shape, flat } = rows::<f64>(value, name, "float64", ("fiu", "numbers"))?;
    of_width(value.py(), name, &shape, 2)?;
    all_finite(value.py(), name, &flat, 2)?;
    Ok(flat.as_chunks::<2>().0.iter().map(|p| Point2::from(*p)).collect())
}

fn all_finite(py: Python<'_>, name: &str, flat: &[f64], width: usize) -> PyResult<()> {
    match flat.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(at) => {
            Err(misused(py, format!("`{name}` has a number in row {} that is not finite", at / width), None))
        }
    }
}

/// Triangles of vertices below `count`.
pub(crate) fn triangles(value: &Bound<'_, PyAny>, name: &str, count: usize) -> PyResult<Vec<[u32; 3]>> {
    let py = value.py();
    let Rows { shape, flat } = rows::<i64>(value, name, "int64", ("iu", "whole numbers"))?;
    of_width(py, name, &shape, 3)?;
    let index = |(at, i): (usize, &i64)| match usize::try_from(*i) {
        Ok(known) if known < count => Ok(known as u32),
        _ => {
            Err(misused(py, format!("`{name}` names vertex {i} in row {}, there are {count}", at / 3), None))
        }
    };
    let flat: Vec<u32> = flat.iter().enumerate().map(index).collect::<PyResult<_>>()?;
    Ok(flat.as_chunks::<3>().0.to_vec())
}

/// Bytes of a picture.
pub(crate) fn bytes(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Rows<u8>> {
    let py = value.py();
    let numpy = py.import("numpy")?;
    let array = numpy
        .getattr("asarray")?
        .call1((value,))
        .map_err(|e| misused(py, format!("`{name}` is no array of numbers: {}", e.value(py)), None))?;
    let dtype = array.getattr("dtype")?.to_string();
    if dtype != "uint8" && dtype != "bool" {
        let help = "scale the values to 0 to 255 and convert them: array.astype(\"uint8\")".to_owned();
        return Err(misused(py, format!("`{name}` must be uint8, found {dtype}"), Some(help)));
    }
    rows::<u8>(&array, name, "uint8", ("ub", "uint8"))
}
