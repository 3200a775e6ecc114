//! The published figure, whose pixels are drawn when somebody asks for them.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyType};

/// A figure, or where it came through a pickle, what it looks like.
#[pyclass(frozen, module = "fluoropose._native")]
pub(crate) struct Figure(Drawn);

enum Drawn {
    Marks(fluoropose_report::Figure),
    Png(Vec<u8>),
}

impl Figure {
    pub(crate) fn of(figure: fluoropose_report::Figure) -> Self {
        Self(Drawn::Marks(figure))
    }
}

#[pymethods]
impl Figure {
    #[new]
    fn new(png: Vec<u8>) -> Self {
        Self(Drawn::Png(png))
    }

    fn png<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        match &self.0 {
            Drawn::Marks(figure) => PyBytes::new(py, &py.detach(|| figure.png())),
            Drawn::Png(png) => PyBytes::new(py, png),
        }
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyType>, (Bound<'py, PyBytes>,)) {
        (py.get_type::<Self>(), (self.png(py),))
    }
}
