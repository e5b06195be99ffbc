//! Read-only arrays over the observation buffers of a batch.
#![expect(unsafe_code, reason = "arrays are views on the buffers of the batch that keeps them")]

use driftworld_env::Outputs;
use driftworld_spec::Modality;
use numpy::ndarray::{ArrayView, Ix4};
use numpy::{Element, PyArray4, PyArrayMethods};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::batch::PyBatch;
use crate::errors::Result;

/// Read-only arrays over the observation buffers of a batch; only the batch writes to them.
pub(crate) fn views<'py>(batch: &Bound<'py, PyBatch>, outputs: &Outputs) -> Result<Bound<'py, PyDict>> {
    let images = &outputs.images;
    let num_envs = outputs.rewards.len();
    let (height, width) = (images.layout.height as usize, images.layout.width as usize);
    let views = PyDict::new(batch.py());
    for modality in &images.layout.modalities {
        let shape = [num_envs, height, width, if *modality == Modality::Rgb { 3 } else { 1 }];
        match modality {
            Modality::Rgb => views.set_item("rgb", view(batch, &images.rgb, shape)?)?,
            Modality::Segmentation => views.set_item("segmentation", view(batch, &images.category, shape)?)?,
            Modality::Class => views.set_item("class", view(batch, &images.class, shape)?)?,
            Modality::Instance => views.set_item("instance", view(batch, &images.instance, shape)?)?,
            Modality::Depth if !images.depth_gray.is_empty() => {
                views.set_item("depth", view(batch, &images.depth_gray, shape)?)?;
            }
            Modality::Depth if !images.depth_millimetres.is_empty() => {
                views.set_item("depth", view(batch, &images.depth_millimetres, shape)?)?;
            }
            Modality::Depth => views.set_item("depth", view(batch, &images.depth, shape)?)?,
        }
    }
    let shape = [num_envs, 1, 1, outputs.state_len];
    views.set_item("state", view(batch, &outputs.states, shape)?)?;
    Ok(views)
}

fn view<'py, T: Element>(
    batch: &Bound<'py, PyBatch>,
    buffer: &[T],
    shape: [usize; 4],
) -> Result<Bound<'py, PyArray4<T>>> {
    let array: ArrayView<'_, T, Ix4> = ArrayView::from_shape(shape, buffer)
        .map_err(|error| PyRuntimeError::new_err(format!("a buffer is not as its layout says: {error}")))?;
    // SAFETY: the buffer belongs to the batch, which the array keeps alive as its base, and is created once: a batch writes
    // into its buffers and never replaces them.
    let view = unsafe { PyArray4::borrow_from_array(&array, batch.clone().into_any()) };
    // This is permanent: NumPy cannot make an array writable again if its base is neither an array nor a buffer.
    Ok(view
        .readwrite()
        .make_nonwriteable()
        .as_any()
        .cast::<PyArray4<T>>()
        .map_err(PyErr::from)?
        .clone())
}
