//! Poses of masks, and of masks brought onto their frames.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Context, Result};
use fluoropose::finder::Candidate;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose_laboratory::choice::{Beside, Decision, Posed, Posing, report::FrameReport};
use fluoropose_laboratory::files::read;
use fluoropose_laboratory::finding::{EdgeOptions, FrameFound, Method};
use fluoropose_laboratory::noise::DisturbanceOptions;
use fluoropose_laboratory::options::Shown;
use fluoropose_laboratory::progress::Stop;
use fluoropose_laboratory::sequence::{InMemory, Source};
use numpy::{PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::camera::Calibration;
use crate::failure::python_error;
use crate::model::{Model, Opened, Views, role_of};
use crate::pixels::{GreyArray, masks_of};
use crate::poses::{NOTHING, poses_of, six};
use crate::worker::beside;

/// The other component as Python hands it over: which one this is, the other's poses, its model.
type Other<'py> = (String, PyReadonlyArray2<'py, f64>, Option<Py<Model>>);

/// Finds the pose in each mask, all of them chosen together; a dictionary for each. None is good where there is a `doubt` of the model.
#[pyfunction]
#[pyo3(signature = (model, calibration, masks, *, unknown, frames, method, library, nominal, distance_mm, bright, edge_offset, other, doubt))]
#[allow(clippy::too_many_arguments, reason = "Python names each of them")]
pub(crate) fn estimate<'py>(
    py: Python<'py>,
    model: &Model,
    calibration: &Calibration,
    masks: PyReadonlyArray3<'py, u8>,
    unknown: Option<PyReadonlyArray3<'py, u8>>,
    frames: Option<Vec<GreyArray<'py>>>,
    method: &str,
    library: Option<PathBuf>,
    nominal: Option<[f64; 2]>,
    distance_mm: Option<f64>,
    bright: Option<bool>,
    edge_offset: bool,
    other: Option<Other<'py>>,
    doubt: Option<String>,
) -> PyResult<Bound<'py, PyList>> {
    let &[_, height, width] = masks.shape() else {
        return Err(PyValueError::new_err("masks have three dimensions"));
    };
    let camera = calibration
        .read
        .camera(width, height)
        .map_err(python_error)?;
    let views = Views {
        nominal,
        distance_mm: distance_mm.unwrap_or_else(|| calibration.read.expected_distance()),
    };
    let given = in_memory(py, &masks, unknown.as_ref(), frames)?;
    let work = Work {
        model: model.model.clone(),
        method: method_of(method)?,
        edges: EdgeOptions {
            shown: shown(bright),
            edge_offset,
        },
        other: other
            .map(|other| OtherComponent::of(py, other))
            .transpose()?,
        doubt,
        stop: Stop::default(),
    };
    let build = model.library(camera, views);
    let (calibration, stop) = (calibration.read, work.stop.clone());
    let found = beside(py, &stop, move || {
        let opened = match library {
            Some(path) => {
                let opened =
                    read(&path).and_then(|bytes| Opened::of(bytes, work.model.clone(), camera));
                Arc::new(opened.with_context(|| format!("library: {}", path.display()))?)
            }
            None => build()?,
        };
        let (source, dropped) = Source::of(given, &calibration)?;
        Ok((work.run(&opened, &source)?, dropped))
    });
    let (posed, dropped) = found?;
    answers_of(py, &posed, dropped)
}

/// What Python has of a film.
fn in_memory(
    py: Python<'_>,
    masks: &PyReadonlyArray3<'_, u8>,
    unknown: Option<&PyReadonlyArray3<'_, u8>>,
    frames: Option<Vec<GreyArray<'_>>>,
) -> PyResult<InMemory> {
    let frames = frames.map(|frames| {
        let each = frames.iter().map(GreyArray::frame);
        each.collect::<Result<Vec<_>>>()
    });
    Ok(InMemory {
        masks: masks_of(py, masks)?,
        unknown: unknown.map(|unknown| masks_of(py, unknown)).transpose()?,
        frames: frames.transpose().map_err(python_error)?,
    })
}

/// A dictionary for each mask, with how many specks were `dropped` of it.
fn answers_of<'py>(
    py: Python<'py>,
    posed: &Posed,
    dropped: Vec<u64>,
) -> PyResult<Bound<'py, PyList>> {
    let rows = posed.report();
    let answers = PyList::empty(py);
    for (number, (row, dropped)) in rows.iter().zip(dropped).enumerate() {
        let answer = answer(
            py,
            row,
            &posed.found[number],
            posed.decisions[number].as_ref(),
        )?;
        answer.set_item("specks", dropped)?;
        answer.set_item("film", posed.film.as_deref())?;
        answers.append(answer)?;
    }
    Ok(answers)
}

/// What the worker needs.
struct Work {
    model: Arc<OwnedModel>,
    method: Method,
    edges: EdgeOptions,
    other: Option<OtherComponent>,
    doubt: Option<String>,
    stop: Stop,
}

impl Work {
    fn run(&self, opened: &Opened, source: &Source) -> Result<Posed> {
        let posing = Posing {
            finder: opened.finder(),
            method: self.method,
            edges: self.edges,
            beside: self.other.as_ref().map(OtherComponent::beside),
            doubt: self.doubt.clone(),
            stop: self.stop.clone(),
        };
        posing.run(source.disturbed(&DisturbanceOptions::default())?)
    }
}

struct OtherComponent {
    role: fluoropose_laboratory::files::Role,
    poses: Vec<Option<Pose>>,
    model: Option<Arc<OwnedModel>>,
}

impl OtherComponent {
    fn of(py: Python<'_>, (role, poses, model): Other<'_>) -> PyResult<Self> {
        Ok(Self {
            role: role_of(&role)?,
            poses: poses_of(&poses),
            model: model.map(|model| model.borrow(py).model.clone()),
        })
    }

    fn beside(&self) -> Beside<'_> {
        Beside {
            role: self.role,
            poses: self.poses.clone(),
            doubtful: Vec::new(),
            model: self.model.as_ref().map(|model| model.as_model()),
        }
    }
}

fn method_of(word: &str) -> PyResult<Method> {
    let methods = [Method::Library, Method::Refined, Method::Image];
    let found = methods.into_iter().find(|method| method.word() == word);
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "method is 'library', 'refined' or 'image', not '{word}'"
        ))
    })
}

fn shown(bright: Option<bool>) -> Shown {
    Shown {
        bright_implant: bright == Some(true),
        dark_implant: bright == Some(false),
    }
}

/// What is told of a frame.
fn answer<'py>(
    py: Python<'py>,
    row: &FrameReport,
    found: &FrameFound,
    decision: Option<&Decision>,
) -> PyResult<Bound<'py, PyDict>> {
    let answer = PyDict::new(py);
    let posed = decision.filter(|decision| decision.pose().is_some());
    let chosen = posed.map(|decision| &decision.chosen);
    answer.set_item("pose", row.pose.map_or(NOTHING, |pose| pose.all()).to_vec())?;
    answer.set_item("sd", row.sd.map_or(NOTHING, |sd| sd.all()).to_vec())?;
    let covariance = chosen.and_then(|chosen| chosen.covariance);
    let covariance = covariance.map(|covariance| covariance.matrix.as_flattened().to_vec());
    answer.set_item("covariance", covariance)?;
    answer.set_item("misfit", chosen.map(Candidate::misfit))?;
    answer.set_item("residual_px", row.residual_px)?;
    answer.set_item("offset_px", row.offset_px)?;
    answer.set_item("verdict", row.verdict)?;
    answer.set_item("because", &row.because)?;
    answer.set_item("decided_by", &row.decided_by)?;
    let rivals = found
        .candidates
        .iter()
        .filter(|candidate| chosen.is_none_or(|chosen| chosen.pose != candidate.pose));
    let rival = |candidate: &Candidate| {
        (
            six(EulerPose::from(candidate.pose)).to_vec(),
            candidate.misfit(),
        )
    };
    answer.set_item("rivals", rivals.map(rival).collect::<Vec<_>>())?;
    Ok(answer)
}
