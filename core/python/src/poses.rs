//! Poses as rows of six numbers: x, y, z in mm, then z, x and y rotation in degrees; NaN where there is none.

use std::path::PathBuf;

use anyhow::Context;
use fluoropose::pose::covariance::Deviations;
use fluoropose::pose::{EulerPose, Pose, jts};
use fluoropose_laboratory::files;
use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::failure::python_error;

/// A row.
pub(crate) type Six = [f64; 6];

/// No pose.
pub(crate) const NOTHING: Six = [f64::NAN; 6];

/// The row of a pose.
pub(crate) fn six(pose: EulerPose) -> Six {
    pose.into()
}

/// The row of standard deviations.
pub(crate) fn six_deviations(sd: Deviations) -> Six {
    [
        sd.x_mm,
        sd.y_mm,
        sd.z_mm,
        sd.z_rot_deg,
        sd.x_rot_deg,
        sd.y_rot_deg,
    ]
}

/// The pose of a row.
pub(crate) fn euler(row: &Six) -> Option<EulerPose> {
    let is_known = row.iter().all(|number| number.is_finite());
    is_known.then(|| EulerPose::from(*row))
}

/// Rows of an n x 6 array.
pub(crate) fn rows_of(rows: &PyReadonlyArray2<'_, f64>) -> Vec<Six> {
    let numbers: Vec<f64> = rows.as_array().iter().copied().collect();
    numbers.as_chunks().0.to_vec()
}

/// The poses of an n x 6 array.
pub(crate) fn poses_of(rows: &PyReadonlyArray2<'_, f64>) -> Vec<Option<Pose>> {
    let pose = |row: &Six| euler(row).map(Pose::from);
    rows_of(rows).iter().map(pose).collect()
}

/// An n x 6 array of rows.
pub(crate) fn array_of(py: Python<'_>, rows: Vec<Six>) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let count = rows.len();
    rows.into_flattened().into_pyarray(py).reshape([count, 6])
}

/// Reads a pose file; the numbers are those of the file, to the last bit.
#[pyfunction]
pub(crate) fn read_poses(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let text = files::read_text(&path).map_err(python_error)?;
    let rows = jts::read(&text).and_then(|rows| {
        rows.map(|row| Ok(row?.map_or(NOTHING, six)))
            .collect::<Result<Vec<Six>, _>>()
    });
    let rows = rows.with_context(|| format!("in {}", path.display()));
    array_of(py, rows.map_err(python_error)?)
}

/// Writes a pose file.
#[pyfunction]
pub(crate) fn write_poses(path: PathBuf, rows: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
    let poses: Vec<Option<EulerPose>> = rows_of(&rows).iter().map(euler).collect();
    files::write_poses(&path, &poses).map_err(python_error)
}

/// `camera_from_model` of each row as a 4 x 4 matrix.
#[pyfunction]
pub(crate) fn matrices<'py>(
    py: Python<'py>,
    rows: PyReadonlyArray2<'_, f64>,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let rows = rows_of(&rows);
    let matrix = |row: &Six| {
        let Some(pose) = euler(row).map(Pose::from) else {
            return [f64::NAN; 16];
        };
        let [a, b, c] = pose.rotation;
        let [x, y, z] = pose.translation;
        [
            a[0], a[1], a[2], x, b[0], b[1], b[2], y, c[0], c[1], c[2], z, 0.0, 0.0, 0.0, 1.0,
        ]
    };
    let numbers: Vec<[f64; 16]> = rows.iter().map(matrix).collect();
    numbers
        .into_flattened()
        .into_pyarray(py)
        .reshape([rows.len(), 4, 4])
}
