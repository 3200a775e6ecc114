//! The extension behind the Python package `fluoropose`: arrays in, plain values out. It finds nothing by itself: each function is a
//! verb of the laboratory on what Python has in memory, so that both give the same numbers.
//!
//! What Python sees of it, with names, checks and types, is in `python/fluoropose`.
#![forbid(unsafe_code)]

mod camera;
mod command;
mod estimate;
mod failure;
mod figure;
mod joint;
mod model;
mod pixels;
mod poses;
mod track;
mod worker;

use pyo3::prelude::*;

/// Adds all there is to the module.
#[pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::camera::Calibration;
    #[pymodule_export]
    use crate::command::command;
    #[pymodule_export]
    use crate::estimate::estimate;
    #[pymodule_export]
    use crate::figure::Figure;
    #[pymodule_export]
    use crate::joint::joint;
    #[pymodule_export]
    use crate::model::Model;
    #[pymodule_export]
    use crate::pixels::{files_in, frame_size, read_frames, write_frame};
    #[pymodule_export]
    use crate::poses::{matrices, read_poses, write_poses};
    #[pymodule_export]
    use crate::track::track;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("VERSION", env!("CARGO_PKG_VERSION"))
    }
}
