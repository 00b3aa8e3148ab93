//! Arrays that show the memory of a Python object, without a copy.
//!
//! This is the only unsafe code of the package.

use numpy::ndarray::{ArrayViewD, IxDyn};
use numpy::{Element, PyArrayDyn, PyArrayMethods};
use pyo3::PyClass;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;

/// A read-only array of that shape over what `pick` gives of `owner`; it keeps `owner` alive.
///
/// Errors: the shape has another number of elements.
pub(crate) fn view<'py, C, T>(
    owner: &Bound<'py, C>,
    shape: &[usize],
    pick: impl for<'a> Fn(&'a C) -> &'a [T],
) -> PyResult<Bound<'py, PyArrayDyn<T>>>
where
    C: PyClass<Frozen = True> + Sync,
    T: Element,
{
    let flat = pick(owner.get());
    let view =
        ArrayViewD::from_shape(IxDyn(shape), flat).map_err(|e| PyValueError::new_err(e.to_string()))?;
    // SAFETY: `flat` is borrowed from the owner's value. The owner's class is frozen, so nothing
    // takes it as `&mut` and moves the memory, and the array holds a reference to the owner, so it
    // is freed after the array.
    let array = unsafe { PyArrayDyn::borrow_from_array(&view, owner.clone().into_any()) };
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}
