//! Arrays as masks and frames.

use std::ffi::OsString;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use fluoropose_decode::{FrameFile, Geometry, GreyFrame, Pixels};
use fluoropose_laboratory::files::{MaskBuffer, name_of, read};
use fluoropose_phantom::picture::{write_grey, write_grey_16};
use numpy::{
    IntoPyArray, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::failure::python_error;

/// Masks that are converted between two looks at signals.
const TOGETHER: usize = 64;

/// Masks, one behind the other; what is not 0 is set. By this thread alone: others may still be busy with what Ctrl-C has ended.
pub(crate) fn masks_of(
    py: Python<'_>,
    masks: &PyReadonlyArray3<'_, u8>,
) -> PyResult<Vec<MaskBuffer>> {
    let &[_, height, width] = masks.shape() else {
        return Err(PyTypeError::new_err("masks have three dimensions"));
    };
    let pixels = masks.as_slice()?;
    let one = (width * height).max(1);
    let mut all = Vec::new();
    for some in pixels.chunks(one * TOGETHER) {
        let masks = py.detach(|| -> Result<Vec<MaskBuffer>> {
            let each = some.chunks_exact(one);
            each.map(|pixels| MaskBuffer::of_pixels(pixels, width, height))
                .collect()
        });
        all.extend(masks.map_err(python_error)?);
        py.check_signals()?;
    }
    Ok(all)
}

/// A frame of 8 or 16 bits.
#[derive(FromPyObject)]
pub(crate) enum GreyArray<'py> {
    /// One byte a pixel.
    Eight(PyReadonlyArray2<'py, u8>),
    /// Two bytes a pixel.
    Sixteen(PyReadonlyArray2<'py, u16>),
}

impl GreyArray<'_> {
    fn size(&self) -> (usize, usize) {
        let shape = match self {
            Self::Eight(array) => array.shape(),
            Self::Sixteen(array) => array.shape(),
        };
        match shape {
            &[height, width] => (width, height),
            _ => (0, 0),
        }
    }

    /// As the decoders would give it.
    pub(crate) fn frame(&self) -> Result<GreyFrame> {
        let (width, height) = self.size();
        if width == 0 || height == 0 {
            bail!("a frame has no pixels");
        }
        let (pixels, bits) = match self {
            Self::Eight(array) => (Pixels::U8(array.as_array().iter().copied().collect()), 8),
            Self::Sixteen(array) => (Pixels::U16(array.as_array().iter().copied().collect()), 16),
        };
        Ok(GreyFrame {
            width: u32::try_from(width)?,
            height: u32::try_from(height)?,
            pixels,
            bits,
            window: None,
            geometry: Geometry::default(),
            shutter: None,
            notes: Vec::new(),
        })
    }
}

/// Reads the frames of a file as the command reads them: arrays of 8 or 16 bits.
#[pyfunction]
pub(crate) fn read_frames(py: Python<'_>, path: PathBuf) -> PyResult<Vec<Bound<'_, PyAny>>> {
    let decoded = py.detach(|| -> Result<Vec<GreyFrame>> {
        let file = FrameFile::open(read(&path)?, &name_of(&path))?;
        (0..file.count())
            .map(|frame| Ok(file.frame(frame)?))
            .collect()
    });
    let array = |frame: GreyFrame| -> PyResult<Bound<'_, PyAny>> {
        let shape = [frame.height as usize, frame.width as usize];
        Ok(match frame.pixels {
            Pixels::U8(pixels) => pixels.into_pyarray(py).reshape(shape)?.into_any(),
            Pixels::U16(pixels) => pixels.into_pyarray(py).reshape(shape)?.into_any(),
        })
    };
    decoded
        .map_err(python_error)?
        .into_iter()
        .map(array)
        .collect()
}

/// Columns and rows of the first frame of a file, of which nothing is decoded.
#[pyfunction]
pub(crate) fn frame_size(path: PathBuf) -> PyResult<(u32, u32)> {
    let size = || -> Result<(u32, u32)> {
        let file = FrameFile::open(read(&path)?, &name_of(&path))?;
        file.size(0).context("there is no frame")
    };
    size().map_err(python_error)
}

/// The files of a folder of frames or masks, in the order of the frames.
#[pyfunction]
pub(crate) fn files_in(folder: PathBuf) -> PyResult<Vec<OsString>> {
    let files = fluoropose_laboratory::files::files_in(&folder).map_err(python_error)?;
    Ok(files.into_iter().map(PathBuf::into_os_string).collect())
}

/// Writes a frame of 8 or 16 bits as PNG.
#[pyfunction]
pub(crate) fn write_frame(py: Python<'_>, path: PathBuf, frame: GreyArray<'_>) -> PyResult<()> {
    let size = frame.size();
    let frame = frame.frame().map_err(python_error)?;
    let written = py.detach(|| match &frame.pixels {
        Pixels::U8(pixels) => write_grey(&path, size, pixels),
        Pixels::U16(pixels) => write_grey_16(&path, size, pixels),
    });
    written.map_err(python_error)
}
