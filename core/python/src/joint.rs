//! How a knee moves.

use std::collections::BTreeMap;
use std::sync::Arc;

use fluoropose::Side;
use fluoropose::joint::COLUMNS;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose_laboratory::verbs::report::knee::{Filtering, Knee};
use fluoropose_laboratory::verbs::report::sources::{Body, Sources, Uncertain};
use fluoropose_report::levels::by_flexion;
use fluoropose_report::{JointFilm, figure, write};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::failure::python_error;
use crate::model::Model;
use crate::poses::{Six, euler, rows_of};

/// A component: its model, poses (n x 6), what is uncertain of them (n x 48 or nothing: the covariance, and what a step of each of the
/// film's constants does) and stated axes.
type Component<'py> = (
    Py<Model>,
    PyReadonlyArray2<'py, f64>,
    Option<PyReadonlyArray2<'py, f64>>,
    Option<String>,
);

/// A joint in all frames of a film.
#[pyclass(frozen, module = "fluoropose._native")]
pub(crate) struct Joint {
    film: JointFilm,
    axes: [String; 2],
    remarks: Vec<String>,
}

/// The joint of two components.
#[pyfunction]
#[pyo3(signature = (femur, tibia, *, side, name, fps, cutoff, doubts))]
#[allow(clippy::too_many_arguments, reason = "Python names each of them")]
pub(crate) fn joint(
    py: Python<'_>,
    femur: Component<'_>,
    tibia: Component<'_>,
    side: &str,
    name: &str,
    fps: Option<f64>,
    cutoff: Option<f64>,
    doubts: BTreeMap<usize, String>,
) -> PyResult<Joint> {
    let side = match side {
        "left" => Side::Left,
        "right" => Side::Right,
        other => {
            return Err(PyValueError::new_err(format!(
                "side is 'left' or 'right', not '{other}'"
            )));
        }
    };
    let sources = Sources {
        femur: body(py, "femur", femur),
        tibia: body(py, "tibia", tibia),
        doubts,
        whose: "those of a Python program".to_owned(),
        inputs: Vec::new(),
    };
    let joint = py.detach(|| -> anyhow::Result<Joint> {
        let knee = Knee::new(name, side, &sources)?;
        let film = knee.film(&sources, &Filtering::new(fps, cutoff)?)?;
        let told = knee.remarks.iter().cloned();
        Ok(Joint {
            remarks: told.chain(film.impossibilities()).collect(),
            film,
            axes: [knee.femur_axes.to_string(), knee.tibia_axes.to_string()],
        })
    });
    joint.map_err(python_error)
}

fn body(py: Python<'_>, name: &str, (model, poses, uncertain, axes): Component<'_>) -> Body {
    let model: Arc<OwnedModel> = model.borrow(py).model.clone();
    let pose = |row: &Six| euler(row).map(Pose::from);
    let mut known = BTreeMap::new();
    if let Some(uncertain) = uncertain {
        let numbers: Vec<f64> = uncertain.as_array().iter().copied().collect();
        for (frame, numbers) in numbers.as_chunks::<48>().0.iter().enumerate() {
            let rows: [[f64; 6]; 8] =
                std::array::from_fn(|row| std::array::from_fn(|k| numbers[6 * row + k]));
            let [matrix @ .., brighter, blurred] = rows;
            let is_known = |rows: &[[f64; 6]]| rows.as_flattened().iter().all(|n| n.is_finite());
            if is_known(&matrix) {
                let steps = [brighter, blurred];
                let uncertain = Uncertain {
                    covariance: PoseCovariance { matrix },
                    film_steps: is_known(&steps).then_some(steps),
                };
                known.insert(frame, uncertain);
            }
        }
    }
    Body {
        name: name.to_owned(),
        stated_axes: axes,
        model: (*model).clone(),
        poses: rows_of(&poses).iter().map(pose).collect(),
        uncertain: known,
    }
}

#[pymethods]
impl Joint {
    /// Names of the numbers.
    #[staticmethod]
    fn names() -> Vec<&'static str> {
        COLUMNS.iter().map(|column| column.name).collect()
    }

    /// Their units.
    #[staticmethod]
    fn units() -> Vec<&'static str> {
        COLUMNS.iter().map(|column| column.unit).collect()
    }

    /// All numbers, a row a frame.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.table(py, |number| self.film.values(number))
    }

    /// One standard deviation of each.
    fn deviations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.table(py, |number| self.film.deviations(number))
    }

    /// The numbers of the filtered poses.
    fn filtered<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let of = |number: usize| {
            let rows = self.film.rows.iter();
            rows.map(|row| row.filtered.map_or(f64::NAN, |numbers| numbers[number]))
                .collect()
        };
        self.table(py, of)
    }

    /// Why each frame is doubtful.
    fn doubts(&self) -> Vec<Option<String>> {
        self.film.rows.iter().map(|row| row.doubt.clone()).collect()
    }

    /// Flexions, and at each of them mean, standard deviation and number of phases of each number.
    #[allow(clippy::type_complexity, reason = "four arrays")]
    fn by_flexion<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray2<f64>>,
        Bound<'py, PyArray2<f64>>,
        Bound<'py, PyArray2<u64>>,
    )> {
        let levels = by_flexion(&self.film);
        let shape = [levels.len(), COLUMNS.len()];
        let steps = || levels.iter().flat_map(|level| &level.steps);
        let means: Vec<f64> = steps().map(|step| step.mean).collect();
        let deviations: Vec<f64> = steps().map(|step| step.deviation).collect();
        let counts: Vec<u64> = steps().map(|step| step.n as u64).collect();
        let flexions: Vec<f64> = levels.iter().map(|level| level.flexion_deg).collect();
        Ok((
            flexions.into_pyarray(py),
            means.into_pyarray(py).reshape(shape)?,
            deviations.into_pyarray(py).reshape(shape)?,
            counts.into_pyarray(py).reshape(shape)?,
        ))
    }

    /// One number over the film at 0 to 100 percent.
    fn cycle<'py>(&self, py: Python<'py>, number: usize) -> Bound<'py, PyArray1<f64>> {
        self.film.cycle(number).into_pyarray(py)
    }

    /// joint.csv.
    fn csv(&self) -> String {
        write::table(&self.film)
    }

    /// joint.mot.
    fn mot(&self) -> PyResult<String> {
        write::mot(&self.film).map_err(python_error)
    }

    /// The published figure.
    fn svg(&self) -> String {
        figure(&self.film)
    }

    /// Which of the femoral and of the tibial file's axes is which.
    fn axes(&self) -> Vec<String> {
        self.axes.to_vec()
    }

    /// What a reader has to know of these data.
    fn remarks(&self) -> Vec<String> {
        self.remarks.clone()
    }
}

impl Joint {
    /// A column for each number.
    fn table<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(usize) -> Vec<f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let columns: Vec<Vec<f64>> = (0..COLUMNS.len()).map(of).collect();
        let rows = 0..self.film.rows.len();
        let numbers: Vec<f64> = rows
            .flat_map(|row| columns.iter().map(move |column| column[row]))
            .collect();
        numbers
            .into_pyarray(py)
            .reshape([self.film.rows.len(), COLUMNS.len()])
    }
}
