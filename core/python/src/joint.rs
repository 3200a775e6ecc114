//! How a knee moves.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use fluoropose::Side;
use fluoropose::joint::COLUMNS;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose_laboratory::files::Uncertain;
use fluoropose_laboratory::verbs::report::knee::{Filtering, Knee};
use fluoropose_laboratory::verbs::report::sources::{Body, Sources};
use fluoropose_report::levels::by_flexion;
use fluoropose_report::{JointFilm, figure, write};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::failure::python_error;
use crate::figure::Figure;
use crate::model::Model;
use crate::poses::poses_of;

/// A component: its model, poses (n x 6), what is uncertain of them (n x 48 or nothing: the covariance, and what a step of each of the
/// film's constants does) and stated axes.
type Component<'py> = (
    Py<Model>,
    PyReadonlyArray2<'py, f64>,
    Option<PyReadonlyArray2<'py, f64>>,
    Option<String>,
);

/// A joint in all frames of a film.
struct Joint {
    film: JointFilm,
    axes: [String; 2],
    remarks: Vec<String>,
}

/// The joint of two components: all that is made of it.
#[pyfunction]
#[pyo3(signature = (femur, tibia, *, side, name, fps, cutoff, doubts, judged))]
#[allow(clippy::too_many_arguments, reason = "Python names each of them")]
pub(crate) fn joint<'py>(
    py: Python<'py>,
    femur: Component<'py>,
    tibia: Component<'py>,
    side: &str,
    name: &str,
    fps: Option<f64>,
    cutoff: Option<f64>,
    doubts: BTreeMap<usize, String>,
    judged: bool,
) -> PyResult<Bound<'py, PyDict>> {
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
        has_verdicts: judged,
        accepted: BTreeMap::new(),
        checked: BTreeSet::new(),
        film: Vec::new(),
        changed: Vec::new(),
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
    joint.map_err(python_error)?.answer(py)
}

fn body(py: Python<'_>, name: &str, (model, poses, uncertain, axes): Component<'_>) -> Body {
    let model: Arc<OwnedModel> = model.borrow(py).model.clone();
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
        // Said where the model was read.
        of_file: Vec::new(),
        poses: poses_of(&poses),
        uncertain: known,
    }
}

impl Joint {
    fn answer<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let film = &self.film;
        let answer = PyDict::new(py);
        let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
        let units: Vec<&str> = COLUMNS.iter().map(|column| column.unit).collect();
        answer.set_item("names", names)?;
        answer.set_item("units", units)?;
        answer.set_item("values", self.table(py, |number| film.values(number))?)?;
        answer.set_item("sd", self.table(py, |number| film.deviations(number))?)?;
        answer.set_item("filtered", self.table(py, |number| self.filtered(number))?)?;
        let doubts: Vec<Option<&str>> = film.rows.iter().map(|row| row.doubt.as_deref()).collect();
        answer.set_item("doubt", doubts)?;
        answer.set_item("by_flexion", self.by_flexion(py)?)?;
        let cycles = (0..COLUMNS.len()).flat_map(|number| film.cycle(number));
        let cycles: Vec<f64> = cycles.collect();
        let points = cycles.len() / COLUMNS.len();
        let cycles = cycles.into_pyarray(py).reshape([COLUMNS.len(), points])?;
        answer.set_item("cycles", cycles)?;
        answer.set_item("csv", write::table(film))?;
        // It needs times.
        answer.set_item(
            "mot",
            film.frames_per_s
                .map(|_| write::mot(film))
                .transpose()
                .map_err(python_error)?,
        )?;
        let figure = figure(film);
        answer.set_item("svg", figure.svg())?;
        answer.set_item("pdf", PyBytes::new(py, &figure.pdf()))?;
        answer.set_item("figure", Figure::of(figure))?;
        answer.set_item("axes", &self.axes)?;
        answer.set_item("remarks", &self.remarks)?;
        Ok(answer)
    }

    /// A number of the filtered poses in each frame.
    fn filtered(&self, number: usize) -> Vec<f64> {
        let rows = self.film.rows.iter();
        rows.map(|row| row.filtered.map_or(f64::NAN, |numbers| numbers[number]))
            .collect()
    }

    /// Flexions, and at each of them mean, standard deviation and number of phases of each number.
    fn by_flexion<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let levels = by_flexion(&self.film);
        let shape = [levels.len(), COLUMNS.len()];
        let steps = || levels.iter().flat_map(|level| &level.steps);
        let means: Vec<f64> = steps().map(|step| step.mean).collect();
        let deviations: Vec<f64> = steps().map(|step| step.deviation).collect();
        let counts: Vec<u64> = steps().map(|step| step.n as u64).collect();
        let flexions: Vec<f64> = levels.iter().map(|level| level.flexion_deg).collect();
        let answer = PyDict::new(py);
        answer.set_item("flexion_deg", flexions.into_pyarray(py))?;
        answer.set_item("mean", means.into_pyarray(py).reshape(shape)?)?;
        answer.set_item("sd", deviations.into_pyarray(py).reshape(shape)?)?;
        answer.set_item("n", counts.into_pyarray(py).reshape(shape)?)?;
        Ok(answer)
    }

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
